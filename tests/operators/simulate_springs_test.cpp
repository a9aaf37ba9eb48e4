// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and particles from records.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::build_model;
using testing::HasSubstr;
using Numbers = std::vector<double>;

fe::Model build(const Language& language, const Scene& scene) {
  Listener listener;
  return build_model(scene.record(language), listener, 1).model;
}

fe::Model build(const std::string& tag, const Attributes& attributes) {
  static const Language language;
  Scene scene = cube(language);
  scene.constraints = {condition(language, tag, attributes)};
  return build(language, scene);
}

std::string refusal(const std::string& tag, const Attributes& attributes) {
  try {
    build(tag, attributes);
  } catch (const Error& error) {
    return error.str();
  }
  return "";
}

// Nodes 0 and 2 of the cube are its corners (0 0 0) and (1 0 0).
TEST(Spring, RestsAtItsReferenceLengthUnlessItSaysOtherwise) {
  Attributes attributes{{"first", Integer{0}}, {"second", Integer{2}}, {"stiffness", 5.0}};
  const fe::Spring free = build("spring", attributes).steps[0].springs.at(0);
  EXPECT_EQ(free.first, 0);
  EXPECT_EQ(free.second, 2);
  EXPECT_EQ(free.stiffness, 5);
  EXPECT_EQ(free.rest, 1);
  attributes["restLength"] = 0.25;
  attributes["damping"] = 3.0;
  const fe::Spring tight = build("spring", attributes).steps[0].springs.at(0);
  EXPECT_EQ(tight.rest, 0.25);
  EXPECT_EQ(tight.damping, 3);
}

TEST(Spring, NeedsTwoNodesOfTheBody) {
  EXPECT_EQ(refusal("spring", {{"first", Integer{0}}, {"second", Integer{27}}, {"stiffness", 5.0}}),
            "scene.xml:7: spring: second = 27 is no node; the mesh has nodes 0 to 26");
  EXPECT_EQ(refusal("spring", {{"first", Integer{3}}, {"second", Integer{3}}, {"stiffness", 5.0}}),
            "scene.xml:7: spring: first and second are the same node, 3");
}

TEST(SpringToPoint, PutsOneSpringAtEachNode) {
  const auto springs =
      build("springToPoint",
            {{"indices", index_set(nullptr, Indexed::nodes, {0, 2})}, {"point", Numbers{0, 0, 3}}, {"stiffness", 5.0}})
          .steps[0]
          .springs;
  ASSERT_EQ(springs.size(), 2u);
  EXPECT_EQ(springs[0].rest, 3);
  EXPECT_DOUBLE_EQ(springs[1].rest, std::sqrt(10.0));
  EXPECT_EQ(springs[1].second, -1);
}

TEST(SpringToPoint, TakesExpressionsInThePlaceOfTheNode) {
  Attributes attributes{{"indices", index_set(nullptr, Indexed::nodes, {0, 2})},
                        {"point", Numbers{0, 0, 3}},
                        {"stiffness", Formula("5+X")},
                        {"damping", Formula("2*X")},
                        {"restLength", Formula("1+X/2")}};
  const auto springs = build("springToPoint", attributes).steps[0].springs;
  EXPECT_EQ(springs[0].stiffness, 5);
  EXPECT_EQ(springs[1].stiffness, 6);
  EXPECT_EQ(springs[1].damping, 2);
  EXPECT_EQ(springs[1].rest, 1.5);
}

TEST(SpringToPoint, ChangesWithTimeByExpressionsAndATable) {
  Attributes attributes{{"indices", index_set(nullptr, Indexed::nodes, {0, 2})},
                        {"point", Numbers{0, 0, 3}},
                        {"stiffness", Formula("5+X+t")},
                        {"damping", 2.0},
                        {"restLength", Formula("1-t/4")}};
  const fe::Spring plain = build("springToPoint", attributes).steps[0].springs[1];
  EXPECT_EQ(plain.stiffness_at(2), 8);
  EXPECT_FALSE(plain.damping_at);
  EXPECT_EQ(plain.rest_at(2), 0.5);
  attributes["table"] = Numbers{0, 0, 4, 1};
  const fe::Spring factor = build("springToPoint", attributes).steps[0].springs[1];
  EXPECT_EQ(factor.stiffness_at(2), 4);
  EXPECT_EQ(factor.damping_at(1), 0.5);
  EXPECT_EQ(factor.rest_at(2), 0.5);
  EXPECT_EQ(factor.stiffness_at.kinks, (Numbers{0, 4}));
  const auto fixed = build("springMeshToFixed", {{"stiffness", Formula("5+t")},
                                                 {"rayleighStiffnes", 0.1},
                                                 {"movingPoints", Numbers{0, 0, 0}},
                                                 {"fixedPoints", Numbers{0, 0, 2}},
                                                 {"table", Numbers{0, 0, 4, 1}}})
                         .steps[0]
                         .springs[0];
  EXPECT_EQ(fixed.stiffness_at(2), 3.5);
  EXPECT_DOUBLE_EQ(fixed.damping_at(2), 0.35);
}

TEST(SpringMeshToFixed, PullsTheNearestNodesWithoutARestLength) {
  const Attributes good{{"stiffness", 5.0},
                        {"rayleighStiffnes", 0.1},
                        {"movingPoints", Numbers{0, 0, 0, 1, 0, 0.001}},
                        {"fixedPoints", Numbers{0, 0, 2, 1, 0, 2}}};
  const auto springs = build("springMeshToFixed", good).steps[0].springs;
  ASSERT_EQ(springs.size(), 2u);
  EXPECT_EQ(springs[1].first, 2);
  EXPECT_EQ(springs[1].point, Vec3(1, 0, 2));
  EXPECT_EQ(springs[1].rest, 0);
  EXPECT_DOUBLE_EQ(springs[1].damping, 0.5);
  Attributes bad = good;
  bad["fixedPoints"] = Numbers{0, 0, 2};
  EXPECT_EQ(
      refusal("springMeshToFixed", bad),
      "scene.xml:7: springMeshToFixed: movingPoints has 2 points, but fixedPoints 1; each spring needs one of both");
  bad = good;
  bad["movingPoints"] = Numbers{0, 0, 0, 1, 0, -0.5};
  EXPECT_EQ(refusal("springMeshToFixed", bad),
            "scene.xml:7: springMeshToFixed: no node lies near the moving point (1, 0, -0.5); the nearest is 0.5 away, "
            "and the body spans (0, 0, 0) to (1, 1, 1)");
}

/// Two particles of one region, without a mesh.
Scene particles(const Language& language) {
  Scene scene = cube(language);
  scene.mesh_tag = language.tag("particles", "mesh", {{"points", Numbers{0, 0, 0, 1, 0, 0}}});
  scene.regions = {language.tag("region", "region", {{"indices", index_set(nullptr, Indexed::elements, {0, 1})}},
                                {language.tag("pointMass", "material", {{"mass", 3.0}})})};
  return scene;
}

TEST(Particles, HaveTheMassOfTheirRegion) {
  const Language language;
  const fe::Model model = build(language, particles(language));
  EXPECT_EQ(model.mesh->point_count(), 2);
  EXPECT_TRUE(model.regions.empty());
  ASSERT_EQ(model.point_masses.size(), 2u);
  EXPECT_EQ(model.point_masses[1].node, 1);
  EXPECT_EQ(model.point_masses[1].mass, 3);
}

TEST(Particles, AreNamedByTheNodesOfTheMeshTheyStandAt) {
  const Language language;
  Scene scene = cube(language);
  const auto mesh = std::make_shared<const Mesh>(scene.mesh ? *scene.mesh : Mesh());
  scene.mesh_tag = language.tag("particles", "mesh", {{"mesh", MeshPtr(mesh)}});
  scene.regions = {language.tag("region", "region", {{"indices", index_set(mesh, Indexed::nodes, {0, 5})}},
                                {language.tag("pointMass", "material", {{"mass", 3.0}})})};
  EXPECT_EQ(build(language, scene).point_masses.size(), static_cast<std::size_t>(mesh->point_count()));  // extended
}

TEST(Particles, HaveNoLawAndElementsNoPointMass) {
  const Language language;
  Scene scene = particles(language);
  scene.regions = {region(language, "a", index_set(nullptr, Indexed::elements, {0, 1}))};
  scene.regions[0].children.pop_back();
  const auto message = [&](const Scene& each) {
    try {
      build(language, each);
    } catch (const Error& error) {
      return error.str();
    }
    return std::string();
  };
  EXPECT_EQ(message(scene), "scene.xml:7: linearElasticMaterial: is no law for particles: they have a pointMass");
  Scene solid = cube(language);
  solid.regions = particles(language).regions;
  EXPECT_EQ(message(solid).substr(0, 100),
            "scene.xml:7: pointMass: is for a body of particles; elements need a material law");
}

}  // namespace
}  // namespace msml::test
