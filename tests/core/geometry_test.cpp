// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes, surfaces and images, and what their checks refuse.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <limits>

#include "msml/core/error.hpp"
#include "msml/core/image.hpp"
#include "msml/core/mesh.hpp"

namespace msml {
namespace {

Mesh tet() {
  Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const int ids[4] = {0, 1, 2, 3};
  mesh.add_cell(CellKind::tet4, ids);
  return mesh;
}

template <class T>
std::string refused(const T& thing) {
  try {
    thing.check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Mesh, FacesOfATetrahedronPointOutward) {
  const Mesh mesh = tet();
  const Vec3 middle = mesh.points.colwise().mean();
  for (const auto& face : tet_faces) {
    const Vec3 a = mesh.points.row(face[0]), b = mesh.points.row(face[1]), c = mesh.points.row(face[2]);
    EXPECT_GT((b - a).cross(c - a).dot(a - middle), 0);
  }
}

TEST(Mesh, MidNodesOfFacesLieOnTheEdgesBetweenTheirCorners) {
  const int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};  // VTK: nodes 4 to 9 of a tet10
  for (const auto& face : tet_faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& edge = edges[face[3 + k] - 4];
      const int a = face[k], b = face[(k + 1) % 3];
      EXPECT_TRUE((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a));
    }
}

TEST(Mesh, RegionsAppearWithTheFirstThatIsNotZero) {
  Mesh mesh = tet();
  EXPECT_TRUE(mesh.regions.empty());
  mesh.add_cell(CellKind::tri3, mesh.cell(0), 7);
  EXPECT_EQ(mesh.regions, (std::vector<int>{0, 7}));
  EXPECT_EQ(mesh.region(1), 7);
  EXPECT_EQ(mesh.summary(), "4 points, 1 tet4, 1 tri3");
  EXPECT_EQ(refused(mesh), "");
}

TEST(Mesh, CheckNamesWhatIsWrong) {
  Mesh wrong_id = tet();
  wrong_id.nodes[2] = 4;
  EXPECT_EQ(refused(wrong_id), "cell 0 names point 4, but the mesh has points 0 to 3");
  Mesh not_finite = tet();
  not_finite.points(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused(not_finite), "point 1 is not finite: (1 0 inf)");
  Mesh field = tet();
  field.cell_fields.push_back({"stress", 6, {1, 2}});
  EXPECT_EQ(refused(field), "cell field 'stress' has 2 values for 1 cells of 6 components");
  Mesh regions = tet();
  regions.regions = {1, 2};
  EXPECT_EQ(refused(regions), "2 region ids for 1 cells");
  Mesh offsets = tet();
  offsets.offsets = {0, 3};
  EXPECT_EQ(refused(offsets), "cell offsets do not fit the cells");
}

TEST(Surface, BecomesAMeshOfTriangles) {
  Surface surface;
  surface.points.resize(3, 3);
  surface.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  surface.triangles = {{0, 1, 2}, {0, 2, 1}};
  surface.cell_fields.push_back({"side", 1, {1, 2}});
  const Mesh mesh = to_mesh(surface);
  EXPECT_EQ(mesh.count(CellKind::tri3), 2);
  EXPECT_EQ(mesh.cell(1)[1], 2);
  EXPECT_EQ(mesh.cell_fields.at(0).values, (std::vector<double>{1, 2}));
  surface.triangles[0][0] = -1;
  EXPECT_EQ(refused(surface), "cell 0 names point -1, but the mesh has points 0 to 2");
}

TEST(Image, VoxelsRunAlongXFirst) {
  const Image image = make_image<std::int16_t>({2, 3, 4});
  EXPECT_EQ(image.voxel_count(), 24u);
  EXPECT_EQ(image.index(1, 0, 0), 1u);
  EXPECT_EQ(image.index(0, 1, 0), 2u);
  EXPECT_EQ(image.index(0, 0, 1), 6u);
}

TEST(Image, CheckNamesWhatIsWrong) {
  Image image = make_image<float>({2, 1, 1});
  EXPECT_EQ(refused(image), "");
  std::get<std::vector<float>>(image.voxels)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refused(image), "image value 1 is not finite");
  image = make_image<float>({2, 1, 1});
  image.components = 3;
  EXPECT_EQ(refused(image), "image has 2 values for 2 voxels of 3 components");
  image = make_image<float>({2, 1, 1}, Vec3::Zero(), Vec3(1, 0, 1));
  EXPECT_EQ(refused(image), "image spacing (1 0 1) is not > 0 or its origin is not finite");
  EXPECT_EQ(refused(Image{}), "image of 0 x 0 x 0 voxels is empty");
}

}  // namespace
}  // namespace msml
