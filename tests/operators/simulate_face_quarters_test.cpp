// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of quadratic elements, named by triangles through their mid nodes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using Numbers = std::vector<double>;

// ExtractSurfaceMesh makes four triangles of a face with mid nodes.
TEST(SurfacePressureOnMesh, TakesFourTrianglesForAFaceOfAQuadraticElement) {
  const Language language;
  auto mesh = std::make_shared<Mesh>();
  mesh->points.resize(10, 3);
  mesh->points.topRows(4) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  constexpr int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  for (int k = 0; k < 6; ++k)
    mesh->points.row(4 + k) = (mesh->points.row(edges[k][0]) + mesh->points.row(edges[k][1])) / 2;
  const int solid[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  mesh->add_cell(CellKind::tet10, solid);
  auto surface = std::make_shared<Mesh>();
  surface->points = mesh->points;
  for (const auto& quarter : {std::array{0, 4, 6}, {4, 1, 5}, {6, 5, 2}, {4, 5, 6}})
    surface->add_cell(CellKind::tri3, quarter.data());
  const auto load_of = [&](Indexed kind, std::vector<int> ids) {
    Scene scene = cube(language);
    scene.mesh_kind = "quadraticTet";
    scene.mesh = mesh;
    scene.regions = {region(language, "a", index_set(mesh, Indexed::elements, {0}))};
    scene.constraints = {condition(
        language, "surfacePressureOnMesh",
        {{"mesh", MeshPtr(surface)}, {"indices", index_set(surface, kind, std::move(ids))}, {"pressure", Numbers{3}}})};
    Listener listener;
    return simulation::build_model(scene.record(language), listener, 1).model.steps.at(0).face_loads.at(0);
  };
  const fe::FaceLoad load = load_of(Indexed::faces, {0, 1, 2, 3});
  ASSERT_EQ(load.faces.size(), 1U);
  EXPECT_THAT(simulation::face_nodes(*mesh, load.faces[0]), testing::UnorderedElementsAre(0, 1, 2, 4, 5, 6));
  EXPECT_EQ(load_of(Indexed::nodes, {0, 1, 2, 4, 5, 6}).faces.size(), 1U);
  const auto refusal = [&](Indexed kind, const std::vector<int>& ids) {
    try {
      load_of(kind, ids);
      return std::string("not refused");
    } catch (const Error& error) {
      return error.str();
    }
  };
  EXPECT_THAT(
      refusal(Indexed::faces, {0, 2, 3}),
      testing::HasSubstr("3 of the 3 faces in indices are parts of faces with mid nodes of which not all four"));
  EXPECT_THAT(refusal(Indexed::nodes, {0, 1, 4, 5, 6}),
              testing::HasSubstr("no triangle of mesh has all its corners among the nodes in indices"));
}

}  // namespace
}  // namespace msml::test
