// SPDX-License-Identifier: GPL-3.0-or-later
// ExtractSurfaceMesh against counts, volumes and orientation known by construction.
#include <gmock/gmock.h>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

Value box_mesh(bool quadratic) {
  return run(
      "GenerateBoxMesh",
      {{"size", std::vector<double>{2, 1, 1}}, {"divisions", std::vector<Integer>{2, 3, 4}}, {"quadratic", quadratic}});
}

const Field* find(const std::vector<Field>& fields, const std::string& name) {
  for (const Field& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

TEST(ExtractSurface, FacesOutwardsAndEnclosesTheVolume) {
  const auto surface = output<Surface>(run("ExtractSurfaceMesh", {{"mesh", box_mesh(false)}}));
  EXPECT_EQ(surface->triangle_count(), 2 * 2 * (2 * 3 + 3 * 4 + 2 * 4));
  EXPECT_EQ(surface->point_count(), 2 + surface->triangle_count() / 2);  // Euler's formula for a sphere
  EXPECT_NEAR(volume(*surface), 2, 1e-12);                               // round-off; negative if it faced inwards
}

TEST(ExtractSurface, QuadraticFacesBecomeFourTrianglesThroughMidNodes) {
  const auto surface = output<Surface>(run("ExtractSurfaceMesh", {{"mesh", box_mesh(true)}}));
  EXPECT_EQ(surface->triangle_count(), 4 * 104);
  EXPECT_EQ(surface->point_count(), 2 + surface->triangle_count() / 2);
  EXPECT_NEAR(volume(*surface), 2, 1e-12);
}

TEST(ExtractSurface, KnowsWhereItsPointsAndTrianglesComeFrom) {
  Mesh mesh = five_tets();
  mesh.regions = {1, 2, 3, 4, 5};
  mesh.point_fields.push_back({"x", 1, {0, 1, 0, 1, 0, 1, 0, 1}});
  const auto surface = output<Surface>(run("ExtractSurfaceMesh", {{"mesh", std::make_shared<const Mesh>(mesh)}}));
  EXPECT_EQ(surface->triangle_count(), 12);
  const Field* points = find(surface->point_fields, "originalPoint");
  const Field* cells = find(surface->cell_fields, "originalCell");
  const Field* regions = find(surface->cell_fields, "region");
  const Field* x = find(surface->point_fields, "x");
  ASSERT_TRUE(points && cells && regions && x);
  for (int i = 0; i < surface->point_count(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    EXPECT_EQ(surface->points.row(i), mesh.points.row(static_cast<int>(points->values[n])));
    EXPECT_EQ(x->values[n], surface->points(i, 0));
  }
  for (std::size_t t = 0; t < 12; ++t) {
    EXPECT_EQ(regions->values[t], cells->values[t] + 1);
    EXPECT_NE(cells->values[t], 4);  // the inner tetrahedron has no outer face
  }
  EXPECT_NO_THROW(surface->check());
}

TEST(ExtractSurface, RefusesWhatHasNoOuterSide) {
  Mesh triangles = to_mesh(box(Vec3::Zero(), Vec3::Ones()));
  EXPECT_EQ(error_of("ExtractSurfaceMesh", {{"mesh", std::make_shared<const Mesh>(triangles)}}),
            "ExtractSurfaceMesh needs tetrahedra, but the mesh has 8 points, 12 tri3");
  Mesh tripled = five_tets();
  for (int i = 0; i < 2; ++i) tripled.add_cell(CellKind::tet4, std::array<int, 4>{0, 1, 2, 4}.data());
  EXPECT_THAT(error_of("ExtractSurfaceMesh", {{"mesh", std::make_shared<const Mesh>(tripled)}}),
              ::testing::HasSubstr("is shared by 3 tetrahedra, cells 0, 5 and 6 among them"));
}

}  // namespace
}  // namespace msml::test
