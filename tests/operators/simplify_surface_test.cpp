// SPDX-License-Identifier: GPL-3.0-or-later
// CGALSimplificateSurface: targets reached, closedness kept, bad targets refused.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

const std::string tag = "CGALSimplificateSurface";

/// A sphere of radius 1 with 6 * 16^2 * 2 = 3072 triangles, 4608 edges, 1538 points.
Value sphere() {
  return run("ExtractSurfaceMesh",
             {{"mesh", run("GenerateSphereMesh", {{"radius", 1.0}, {"around", Integer{8}}, {"across", Integer{1}}})}});
}

/// A closed surface of the sphere's kind has 2 points more than half its triangles.
bool like_a_sphere(const Surface& s) { return s.point_count() == 2 + s.triangle_count() / 2; }

TEST(SimplifySurface, StopsBelowTheNumberOfEdges) {
  const auto surface = output<Surface>(run(tag, {{"inputMeshFile", sphere()}, {"stopnr", Integer{900}}}));
  const int edges = 3 * surface->triangle_count() / 2;
  EXPECT_LT(edges, 900);
  EXPECT_GE(edges, 900 - 3);  // one collapse takes three edges
  EXPECT_TRUE(like_a_sphere(*surface));
}

TEST(SimplifySurface, StopsAtTheNumberOfVertices) {
  const auto surface = output<Surface>(run(tag, {{"inputMeshFile", sphere()}, {"vertices", Integer{300}}}));
  EXPECT_EQ(surface->point_count(), 300);
  EXPECT_TRUE(like_a_sphere(*surface));
  EXPECT_NEAR(volume(*surface), 4 * std::numbers::pi / 3,
              0.04);  // the placement keeps the volume of the input, 1 % below
}

TEST(SimplifySurface, KeepsEdgesInsideTheBox) {
  const Value before = sphere();
  const std::vector<double> lower_half{-2, -2, -2, 2, 2, 0};
  const auto surface =
      output<Surface>(run(tag, {{"inputMeshFile", before}, {"vertices", Integer{900}}, {"box", lower_half}}));
  const auto below = [](const Surface& s) { return (s.points.col(2).array() <= 0).count(); };
  EXPECT_EQ(below(*surface), below(*output<Surface>(before)));
}

TEST(SimplifySurface, RefusesTargetsWithoutSense) {
  EXPECT_EQ(error_of(tag, {{"inputMeshFile", sphere()}, {"vertices", Integer{99999}}}),
            "vertices = 99999 is more than the surface has: 1,538");
  EXPECT_EQ(error_of(tag, {{"inputMeshFile", sphere()}, {"stopnr", Integer{99999}}}),
            "stopnr = 99999 edges is more than the surface has: 4,608");
  EXPECT_EQ(error_of(tag, {{"inputMeshFile", sphere()}}), "give either stopnr (edges) or vertices, and not both");
  EXPECT_EQ(error_of(tag, {{"inputMeshFile", sphere()},
                           {"vertices", Integer{300}},
                           {"box", std::vector<double>{1, 0, 0, 0, 1, 1}}}),
            "box: xmin = 1 is above xmax = 0; the order is xmin ymin zmin xmax ymax zmax");
}

TEST(SimplifySurface, RefusesWhatIsNoManifold) {
  Surface fins = box(Vec3::Zero(), Vec3::Ones());
  fins.triangles.push_back({0, 1, 6});
  EXPECT_THAT(error_of(tag, {{"inputMeshFile", std::make_shared<const Surface>(fins)}, {"vertices", Integer{5}}}),
              ::testing::StartsWith("edges of this surface cannot be collapsed: "));
}

}  // namespace
}  // namespace msml::test
