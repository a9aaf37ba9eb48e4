// SPDX-License-Identifier: GPL-3.0-or-later
// supportingMesh in a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using testing::HasSubstr;

/// The pulled cube (E = 1000, nu = 0.3, strain 0.01) with a mesh embedded in it, and the displacement at a place.
Scene supported(const Language& language, const Mesh& inner, double young, const std::string& step = "") {
  Scene scene =
      pulled(language, language.tag("probe", "output", {{"id", std::string("p")}, {"point", Numbers{0.3, 0.6, 0.7}}}));
  scene.constraints.push_back(condition(
      language, "supportingMesh",
      {{"youngModulus", young}, {"poissonRatio", 0.3}, {"filename", std::make_shared<const Mesh>(inner)}}, step));
  return scene;
}

std::string message(const Scene& scene, const Language& language) {
  try {
    written(language, scene, "p.csv");
  } catch (const Error& error) {
    return error.str();
  }
  return "no error";
}

// E = 1000 + 3000 under the same load: a quarter of the strain. The inner mesh is the same, or one cut twice as fine,
// so that its surface forces reach the corners of the body as those of a constant stress do.
TEST(SupportingMesh, AddsItsStiffness) {
  const Language language;
  for (const Mesh& inner : {box(2, 2, 2, 0.5), box(4, 4, 4, 0.25)}) {
    const Numbers last = csv_rows(written(language, supported(language, inner, 3000), "p.csv")).back();
    EXPECT_NEAR(last[1], -0.003 * 0.3 / 4, 1e-9);
    EXPECT_NEAR(last[2], -0.003 * 0.6 / 4, 1e-9);
    EXPECT_NEAR(last[3], 0.01 * 0.7 / 4, 1e-9);
  }
}

// All that is pulled along z passes through any section, whatever part of it goes through the inner mesh; across, the
// rollers push, since the stress is no longer constant.
TEST(SupportingMesh, CarriesItsPartOfTheForceOnASection) {
  const Language language;
  Mesh inner = box(3, 3, 3, 0.2);
  inner.points.array() += 0.15;
  Scene scene = supported(language, inner, 3000);
  scene.outputs = {
      language.tag("section", "output",
                   {{"id", std::string("s")}, {"point", Numbers{0.5, 0.5, 0.4}}, {"normal", Numbers{0.1, 0.2, 1}}})};
  const Numbers last = csv_rows(written(language, scene, "s.csv")).back();
  EXPECT_NEAR(last[4], 10, 1e-7);  // Newton stops at 1e-8 of the loads
}

// Above z = 0.4 the body weighs 2 * 10 * 0.6, and of the inner mesh 0.35 * 0.6^2 of its volume 3 * 10 times that.
TEST(SupportingMesh, WeighsOnASection) {
  const Language language;
  Mesh inner = box(3, 3, 3, 0.2);
  inner.points.array() += 0.15;
  Scene scene = supported(language, inner, 3000);
  scene.constraints.pop_back();
  scene.constraints.push_back(condition(language, "supportingMesh",
                                        {{"youngModulus", 3000.0},
                                         {"poissonRatio", 0.3},
                                         {"massDensity", 3.0},
                                         {"filename", std::make_shared<const Mesh>(inner)}}));
  scene.steps = {language.tag("step", "step", {{"gravity", Numbers{0, 0, -10}}})};
  scene.outputs = {
      language.tag("section", "output",
                   {{"id", std::string("s")}, {"point", Numbers{0.5, 0.5, 0.4}}, {"normal", Numbers{0, 0, 1}}})};
  const Numbers last = csv_rows(written(language, scene, "s.csv")).back();
  EXPECT_NEAR(last[4], 10 - 12 - 30 * 0.35 * 0.36, 1e-6);
}

TEST(SupportingMesh, LiesInsideTheBody) {
  const Language language;
  EXPECT_THAT(message(supported(language, box(3, 1, 1, 0.5), 3000), language),
              HasSubstr("scene.xml:7: supportingMesh: its node 3 at (1.5, 0, 0) lies 0.5 outside the body"));
  Mesh triangles = box(1, 1, 1, 0.5);
  triangles.kinds.clear();
  triangles.nodes.clear();
  triangles.offsets = {0};
  EXPECT_THAT(message(supported(language, triangles, 3000), language), HasSubstr("the mesh has no tetrahedra"));
}

TEST(SupportingMesh, ActsInAllSteps) {
  const Language language;
  Scene scene = supported(language, box(1, 1, 1, 0.5), 3000, "initial");
  EXPECT_EQ(message(scene, language), "no error");
  scene.steps.push_back(language.tag("step", "step", {{"name", std::string("second")}, {"gravity", Numbers{0, 0, 0}}}));
  EXPECT_THAT(message(scene, language), HasSubstr("forStep = 'initial': it acts in all steps"));
}

}  // namespace
}  // namespace msml::test
