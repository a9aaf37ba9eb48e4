// SPDX-License-Identifier: GPL-3.0-or-later
// The traps of the original beam and liver scenes, on their own meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "operators/formats/formats.hpp"
#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::operators {
Operator simulate();
}

namespace msml::test {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

fs::path scenes() { return fs::path(MSML_SOURCE_DIR) / ".." / "shared" / "scenes"; }

MeshPtr read(const std::string& file) {
  return std::get<MeshPtr>(operators::legacy_vtk().read(scenes() / file, Type::mesh));
}

/// Ids of points in a box, as the box operator of the scene selects them.
IndexSetPtr points_in(const MeshPtr& mesh, const Vec3& low, const Vec3& high) {
  std::vector<int> ids;
  for (int i = 0; i < mesh->point_count(); ++i) {
    const Vec3 x = mesh->points.row(i).transpose();
    if ((x.array() >= low.array()).all() && (x.array() <= high.array()).all()) ids.push_back(i);
  }
  return index_set(mesh, Indexed::nodes, std::move(ids));
}

/// Ids of triangles whose corners all lie in the box.
IndexSetPtr triangles_in(const MeshPtr& mesh, const Vec3& low, const Vec3& high) {
  const auto points = points_in(mesh, low, high);
  std::vector<bool> in(static_cast<std::size_t>(mesh->point_count()), false);
  for (const int id : points->ids) in[static_cast<std::size_t>(id)] = true;
  std::vector<int> ids;
  for (int c = 0; c < mesh->cell_count(); ++c) {
    const int* nodes = mesh->cell(c);
    if (mesh->kinds[static_cast<std::size_t>(c)] == CellKind::tri3 && in[static_cast<std::size_t>(nodes[0])] &&
        in[static_cast<std::size_t>(nodes[1])] && in[static_cast<std::size_t>(nodes[2])])
      ids.push_back(c);
  }
  return index_set(mesh, Indexed::faces, std::move(ids));
}

const Vec3 left_low(-0.001, -0.001, -1e-9), left_high(0.031, 0.061, 1e-8);
const Vec3 right_low(-0.001, -0.001, 0.19999), right_high(0.031, 0.061, 0.21);

/// beamLinearSurfacePressure with a hundredth of its load: the region by nodes, the load on triangles with points of
/// their own.
Scene pressed_beam(const Language& language) {
  Scene scene = cube(language);
  scene.mesh = read("beam/Beam_Tet4WithSurface_NElement=1810.vtk");
  scene.regions = {
      region(language, "liverMaterial", points_in(scene.mesh, {-0.1, -0.1, -0.1}, {0.04, 0.07, 0.21}), 3000, 0.49)};
  scene.constraints = {
      condition(language, "fixedConstraint", {{"indices", points_in(scene.mesh, left_low, left_high)}}),
      condition(language, "surfacePressure",
                {{"indices", triangles_in(scene.mesh, right_low, right_high)},
                 {"pressure", std::vector<double>{-50}},
                 {"follower", false}})};
  return scene;
}

TEST(Beam, TrianglesWithTheirOwnPointsFindTheEndFace) {
  if (!fs::exists(scenes())) GTEST_SKIP() << "no " << scenes();
  const Language language;
  Listener listener;
  const Scene scene = pressed_beam(language);
  const auto simulation = simulation::build_model(scene.record(language), listener, 1);
  EXPECT_THAT(listener.warnings, IsEmpty());  // every element has all its corners in the node region
  EXPECT_EQ(simulation.model.regions.at(0).elements.size(), 1810U);
  double area = 0;
  for (const auto& face : simulation.model.steps[0].face_loads.at(0).faces) {
    const auto nodes = simulation::face_nodes(*scene.mesh, face);
    const auto x = [&](int i) -> Vec3 {
      return scene.mesh->points.row(nodes[static_cast<std::size_t>(i)]).transpose();
    };
    area += 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  }
  EXPECT_NEAR(area, 0.03 * 0.06, 1e-8);  // the mesh is stored in single precision
}

TEST(Beam, PointsOfTheSeparateSurfaceCarryNoUnknownsAndStay) {
  if (!fs::exists(scenes())) GTEST_SKIP() << "no " << scenes();
  const Language language;
  const Folder folder;
  Listener listener;
  Scene scene = pressed_beam(language);
  scene.solver = {{"linearSolver", std::string("direct")}};
  scene.steps = {language.tag("step", "step",
                              {{"dt", 0.5}, {"iterations", Integer{1}}, {"gravity", std::vector<double>{0, 0, 0}}})};
  scene.outputs = {language.tag("displacement", "output", {{"id", std::string("beam")}})};
  const Record record = scene.record(language);
  Context context(record, listener, folder.path(), 1);
  operators::simulate()(context);
  const auto series = std::get<SeriesPtr>(context.outputs.at(0));
  EXPECT_EQ(series->last->cell_count(), scene.mesh->cell_count());
  EXPECT_EQ(series->last->kinds, scene.mesh->kinds);
  EXPECT_EQ(series->last->points.bottomRows(817 - 487), scene.mesh->points.bottomRows(817 - 487));
  EXPECT_GT(series->last->points.topRows(487).col(2).maxCoeff(),
            0.2 + 0.002);  // p L/E = 0.0033: negative pressure pulls
  EXPECT_NE(listener.facts.at("check").find("\"unknowns\": "), std::string::npos);
}

TEST(Liver, OldBoxesCutOffElementsAndTheRegionExtends) {
  if (!fs::exists(scenes())) GTEST_SKIP() << "no " << scenes();
  const Language language;
  Listener listener;
  Scene scene = cube(language);
  scene.mesh = read("liver/LiverXSTet4.vtk");
  // Elements with all corners inside x <= 0: a box that is too small.
  const auto inside = points_in(scene.mesh, {-1e9, -1e9, -1e9}, {0, 1e9, 1e9});
  scene.regions = {region(language, "liverMaterial", inside)};
  const auto simulation = simulation::build_model(scene.record(language), listener, 1);
  EXPECT_EQ(static_cast<int>(simulation.model.regions.at(0).elements.size()), scene.mesh->count(CellKind::tet4));
  ASSERT_EQ(listener.warnings.size(), 1U);
  EXPECT_THAT(listener.warnings[0], testing::HasSubstr("as the only region it is extended"));
}

}  // namespace
}  // namespace msml::test
