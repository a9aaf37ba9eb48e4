// SPDX-License-Identifier: GPL-3.0-or-later
// Models that are refused, and the words they are refused with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msml/core/error.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

Model good() {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {});
  model.steps[0].prescribed = {fix({0, 1, 2, 3})};
  return model;
}

std::string refusal(const Model& model) {
  try {
    model.check();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// With gravity, which pushes everything that is not held.
std::string refusal_to_run(Model model) {
  model.steps[0].gravity = Vec3(1, 2, 3);
  try {
    solve(model, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Model, IsAcceptedWhenSound) { EXPECT_EQ(refusal(good()), "accepted"); }

TEST(Model, NamesInvertedElementsWithCountAndPlace) {
  Model model = good();
  Mesh mesh = *model.mesh;
  std::swap(mesh.nodes[0], mesh.nodes[1]);
  mesh.points(7, 0) = 0.0;  // squashes others flat or inverts them
  model.mesh = std::make_shared<const Mesh>(mesh);
  EXPECT_THAT(refusal(model), HasSubstr("elements are inverted or flat in the reference mesh; the worst is element "));
}

TEST(Model, NamesElementsOfNoRegion) {
  Model model = good();
  model.regions[0].elements.resize(4);
  EXPECT_THAT(refusal(model), HasSubstr("2 tetrahedra are in no material region, the first is element 4 at ("));
}

TEST(Model, NamesElementsOfTwoRegions) {
  Model model = good();
  model.regions.push_back(model.regions[0]);
  model.regions[1].name = "other";
  EXPECT_THAT(refusal(model), HasSubstr("is in region 'body' and in region 'other'"));
}

TEST(Model, NeedsAPositiveDensityInDynamics) {
  Model model = good();
  model.regions[0].density = 0;
  EXPECT_EQ(refusal(model), "accepted");
  model.settings.integrator = Integrator::newmark;
  EXPECT_THAT(refusal(model), HasSubstr("region 'body': massDensity = 0 is not > 0, as a dynamic simulation needs"));
  model.regions[0].density = NAN;
  EXPECT_THAT(refusal(model), HasSubstr("massDensity = nan"));
}

TEST(Model, CountsTheFreeRigidMotionsOfAStaticBody) {
  Model model = good();
  model.steps[0].prescribed.clear();
  EXPECT_THAT(refusal_to_run(model),
              HasSubstr("step 'load' is static, but 6 of the 6 rigid motions of the part of 8 nodes "
                        "around (0.5 0.5 0.5) are free"));
  model.steps[0].prescribed = {fix({0})};
  EXPECT_THAT(refusal_to_run(model), HasSubstr("3 of the 6"));
  model.steps[0].prescribed = {fix({0, 1})};
  EXPECT_THAT(refusal_to_run(model), HasSubstr("1 of the 6"));
  model.settings.integrator = Integrator::implicit_euler;
  EXPECT_EQ(refusal_to_run(model), "accepted");
}

TEST(Model, FindsTheLoosePartOfTwo) {
  Mesh one = box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), two = one;
  two.points.rowwise() += Eigen::RowVector3d(5, 0, 0);
  Model model = make_model(merge({one, two}), {});
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 0.5; }))};
  EXPECT_THAT(refusal_to_run(model), HasSubstr("around (5.5 0.5 0.5)"));
}

TEST(Model, ChecksNumbersAndIndices) {
  const auto with = [](const auto& change) {
    Model model = good();
    change(model);
    return refusal(model);
  };
  EXPECT_THAT(with([](Model& m) { m.mesh = nullptr; }), HasSubstr("no mesh"));
  EXPECT_THAT(with([](Model& m) { m.regions.clear(); }), HasSubstr("nothing to simulate"));
  EXPECT_THAT(with([](Model& m) { m.regions[0].law = nullptr; }), HasSubstr("no material law"));
  EXPECT_THAT(with([](Model& m) { m.regions[0].elements[0] = 6; }), HasSubstr("names element 6"));
  EXPECT_THAT(with([](Model& m) { m.steps.clear(); }), HasSubstr("no step"));
  EXPECT_THAT(with([](Model& m) { m.steps[0].dt = 0; }), HasSubstr("dt of step 'load' = 0 is not > 0"));
  EXPECT_THAT(with([](Model& m) { m.steps[0].count = 0; }), HasSubstr("iterations of step 'load'"));
  EXPECT_THAT(with([](Model& m) { m.steps[0].gravity[1] = NAN; }), HasSubstr("gravity"));
  EXPECT_THAT(with([](Model& m) { m.steps[0].prescribed[0].nodes[0] = 8; }), HasSubstr("names node 8"));
  EXPECT_THAT(with([](Model& m) { m.steps[0].prescribed[0].values.resize(2); }), HasSubstr("has 2 values for 4 nodes"));
  EXPECT_THAT(with([](Model& m) {
                m.steps[0].forces = {{"f", {1}, {Vec3(0, INFINITY, 0)}}};
              }),
              HasSubstr("not finite"));
  EXPECT_THAT(with([](Model& m) {
                m.steps[0].face_loads = {{.name = "p", .faces = {{0, 4}}, .pressures = {1}}};
              }),
              HasSubstr("names face 4 of cell 0"));
  EXPECT_THAT(with([](Model& m) {
                m.steps[0].face_loads = {{.name = "p", .faces = {{0, 1}}, .pressures = {1, 2}}};
              }),
              HasSubstr("has 2 values for 1 faces"));
  EXPECT_THAT(with([](Model& m) { m.settings.tolerance = 0; }), HasSubstr("tolerance = 0"));
  EXPECT_THAT(with([](Model& m) { m.settings.threads = 0; }), HasSubstr("threads = 0"));
  EXPECT_THAT(with([](Model& m) { m.settings.damping_stiffness = -1; }), HasSubstr("= -1 is not >= 0"));
}

}  // namespace
}  // namespace msml::fe
