// SPDX-License-Identifier: GPL-3.0-or-later
// CGALMeshVolumeFromSurface: volumes, topology, sharp edges, reproducibility, and what it refuses.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "operators/cgal_meshing.hpp"
#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

const std::string tag = "CGALMeshVolumeFromSurface";

Value stored(Surface surface) { return std::make_shared<const Surface>(std::move(surface)); }

Value unit_cube() { return stored(box(Vec3::Zero(), Vec3::Ones())); }

Value sphere(double radius) {
  return run(
      "ExtractSurfaceMesh",
      {{"mesh", run("GenerateSphereMesh", {{"radius", radius}, {"around", Integer{8}}, {"across", Integer{1}}})}});
}

Surface joined(const Surface& a, const Surface& b) {
  Surface sum = a;
  sum.points.conservativeResize(a.point_count() + b.point_count(), 3);
  sum.points.bottomRows(b.point_count()) = b.points;
  for (auto [i, j, k] : b.triangles)
    sum.triangles.push_back({i + a.point_count(), j + a.point_count(), k + a.point_count()});
  return sum;
}

TEST(MeshVolumeFromSurface, FillsASphere) {
  QuietReporter listener;
  const auto mesh = output<Mesh>(run(
      tag, {{"surfaceMesh", sphere(1)}, {"facetSize", 0.2}, {"facetDistance", 0.01}, {"cellSize", 0.2}}, &listener));
  EXPECT_GT(smallest_volume(*mesh), 0);
  EXPECT_EQ(euler_characteristic(*mesh), 1);
  // Facets cut off caps: chords of facetSize 0.2 lose at most 3 * 0.01 of the volume, and the input itself 1 %.
  EXPECT_NEAR(total_volume(*mesh), 4 * std::numbers::pi / 3, 0.04 * 4.19);
  EXPECT_TRUE(listener.warnings.empty());
}

TEST(MeshVolumeFromSurface, IsTheSameToTheLastBitEveryTime) {
  const Arguments arguments{{"surfaceMesh", sphere(1)}, {"facetSize", 0.3}, {"cellSize", 0.3}, {"odt", true},
                            {"pertube", true},          {"exude", true}};
  EXPECT_TRUE(same(*output<Mesh>(run(tag, arguments)), *output<Mesh>(run(tag, arguments))));
}

/// Counts how often each pass was told, and ends the meshing when one was told for the last time that it may.
class Teller : public QuietReporter {
 public:
  explicit Teller(std::string last) : last_(std::move(last)) {}
  void progress(double, const std::string& words) override {
    if (++told[words] == 2 && words == last_) throw Error("ended inside " + words);
  }
  std::map<std::string, int> told;

 private:
  std::string last_;
};

// A time limit ends a pass from inside: the first telling is that of its beginning, the second comes from its midst.
TEST(MeshVolumeFromSurface, PassesCanBeEndedInTheirMidst) {
  for (const char* pass : {"odt", "lloyd", "perturbing", "exuding"}) {
    const bool perturb = pass == std::string("perturbing");
    const Arguments arguments{{"surfaceMesh", sphere(1)},
                              {"facetSize", 0.15},
                              {"cellSize", 0.15},
                              {perturb                          ? "pertube"
                               : pass == std::string("exuding") ? "exude"
                                                                : pass,
                               true}};
    Teller teller(pass);
    EXPECT_THROW(run(tag, arguments, &teller), Error) << pass;
    EXPECT_EQ(teller.told[pass], 2) << pass;
  }
}

TEST(MeshVolumeFromSurface, LeavesCavitiesEmptyAndFindsEveryPart) {
  // A cube with a cubic cavity, and a small cube far away: 8 - 1 + 0.001.
  Surface cavity = box(Vec3(0.5, 0.5, 0.5), Vec3(1.5, 1.5, 1.5));
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  const Surface all = joined(joined(box(Vec3::Zero(), Vec3(2, 2, 2)), cavity), box(Vec3(5, 5, 5), Vec3(5.1, 5.1, 5.1)));
  const auto mesh = output<Mesh>(
      run(tag, {{"surfaceMesh", stored(all)}, {"preserveFeatures", true}, {"facetSize", 0.25}, {"cellSize", 0.25}}));
  EXPECT_NEAR(total_volume(*mesh), 7.001, 1e-9);  // plane faces and kept edges: exact but for the places of crossings
  EXPECT_GT(mesh->points.col(0).maxCoeff(), 5.05);
  EXPECT_EQ(euler_characteristic(*mesh), 2 + 1);
}

TEST(MeshVolumeFromSurface, KeepsSharpEdgesOnlyWhenAsked) {
  const Arguments rough{{"surfaceMesh", unit_cube()}, {"facetSize", 0.3}, {"facetDistance", 0.05}, {"cellSize", 0.3}};
  Arguments sharp = rough;
  sharp["preserveFeatures"] = true;
  EXPECT_LT(total_volume(*output<Mesh>(run(tag, rough))), 0.999);
  const auto mesh = output<Mesh>(run(tag, sharp));
  EXPECT_NEAR(total_volume(*mesh), 1, 1e-9);
  long corners = 0;
  for (int i = 0; i < mesh->point_count(); ++i)
    corners += (mesh->points.row(i).array() * (1 - mesh->points.row(i).array())).isZero(0);
  EXPECT_EQ(corners, 8);
  sharp["featureAngle"] = 95.0;  // the cube's edges turn by 90 degrees
  EXPECT_LT(total_volume(*output<Mesh>(run(tag, sharp))), 0.999);
}

TEST(MeshVolumeFromSurface, EveryPassChangesTheMesh) {
  const Arguments plain{{"surfaceMesh", sphere(1)}, {"facetSize", 0.3}, {"cellSize", 0.3}};
  const auto before = output<Mesh>(run(tag, plain));
  for (const char* pass : {"odt", "lloyd", "pertube", "exude"}) {
    Arguments arguments = plain;
    arguments[pass] = true;
    const auto after = output<Mesh>(run(tag, arguments));
    EXPECT_FALSE(same(*before, *after)) << pass;
    EXPECT_GT(smallest_volume(*after), 0) << pass;
  }
}

TEST(MeshVolumeFromSurface, DefaultsFollowFromTheSizeOfTheBody) {
  const auto small = output<Mesh>(run(tag, {{"surfaceMesh", sphere(0.001)}}));
  const auto large = output<Mesh>(run(tag, {{"surfaceMesh", sphere(1000)}}));
  EXPECT_GT(small->cell_count(), 1000);
  EXPECT_NEAR(small->cell_count(), large->cell_count(), 0.1 * large->cell_count());  // the same body but for round-off
}

TEST(MeshVolumeFromSurface, RepairsWhatLosesNothing) {
  // Every triangle with its own three points, and one turned.
  Surface soup;
  const Surface cube = box(Vec3::Zero(), Vec3::Ones());
  soup.points.resize(36, 3);
  for (int t = 0; t < 12; ++t) {
    for (int i = 0; i < 3; ++i)
      soup.points.row(3 * t + i) =
          cube.points.row(cube.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)]);
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  std::swap(soup.triangles[4][0], soup.triangles[4][1]);
  QuietReporter listener;
  const auto mesh = output<Mesh>(
      run(tag, {{"surfaceMesh", stored(soup)}, {"preserveFeatures", true}, {"cellSize", 0.5}, {"facetSize", 0.5}},
          &listener));
  EXPECT_NEAR(total_volume(*mesh), 1, 1e-9);
  EXPECT_THAT(listener.notes, ::testing::ElementsAre("surface: 28 points with the coordinates of others were merged",
                                                     "surface: 1 triangle was turned to agree with its neighbours"));
}

TEST(MeshVolumeFromSurface, RefusesAnOpenSurfaceWithCounts) {
  Surface open = box(Vec3::Zero(), Vec3::Ones());
  open.triangles.pop_back();
  EXPECT_EQ(error_of(tag, {{"surfaceMesh", stored(open)}}), "the surface does not bound a volume: 3 border edges");
}

TEST(MeshVolumeFromSurface, RefusesANonManifoldSurfaceWithCounts) {
  // Two cubes that share one edge, and two that share one corner.
  const Surface cube = box(Vec3::Zero(), Vec3::Ones());
  EXPECT_EQ(error_of(tag, {{"surfaceMesh", stored(joined(cube, box(Vec3(1, 1, 0), Vec3(2, 2, 1))))}}),
            "the surface does not bound a volume: 1 non-manifold edge");
  EXPECT_EQ(error_of(tag, {{"surfaceMesh", stored(joined(cube, box(Vec3(1, 1, 1), Vec3(2, 2, 2))))}}),
            "the surface does not bound a volume: 1 non-manifold vertex");
}

TEST(MeshVolumeFromSurface, RefusesASurfaceThatIntersectsItself) {
  const Surface crossed = joined(box(Vec3::Zero(), Vec3::Ones()), box(Vec3(0.5, 0.4, 0.3), Vec3(1.5, 1.4, 1.3)));
  EXPECT_THAT(
      error_of(tag, {{"surfaceMesh", stored(crossed)}}),
      ::testing::MatchesRegex(
          "the surface does not bound a volume: [0-9]+ self-intersecting triangle pairs, the first near \\(.*\\)"));
  // One tetrahedron's tip through another's base: the tip's three sides cross it.
  Surface first, second;
  first.points.resize(4, 3);
  first.points << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -4;
  second.points.resize(4, 3);
  second.points << 0.8, 0.8, 1, 1.2, 0.8, 1, 1, 1.2, 1, 1, 1, -1;
  first.triangles = second.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  EXPECT_THAT(
      error_of(tag, {{"surfaceMesh", stored(joined(first, second))}}),
      ::testing::StartsWith("the surface does not bound a volume: 3 self-intersecting triangle pairs, the first near"));
}

TEST(MeshVolumeFromSurface, WarnsWhereRefinementIsNotKnownToEnd) {
  QuietReporter listener;
  run(tag, {{"surfaceMesh", sphere(1)}, {"cellSize", 0.5}, {"facetSize", 0.5}, {"cellRadiusEdgeRatio", 1.9}},
      &listener);
  EXPECT_THAT(listener.warnings, ::testing::ElementsAre(::testing::StartsWith("cellRadiusEdgeRatio = 1.9 is below 2")));
}

TEST(MeshVolumeFromSurface, RefinementThatRunsAwayIsStopped) {
  QuietReporter listener;
  operators::MeshingSettings settings{.radius_edge = 1.001, .cell_size = 1};
  const auto small_body = operators::progress_in_points(listener, 1, settings);
  EXPECT_NO_THROW(small_body(100000));
  EXPECT_THROW(small_body(100001), Error);
  settings.radius_edge = 2;  // always ends, so nothing is in the way of a large mesh
  EXPECT_NO_THROW(operators::progress_in_points(listener, 1, settings)(100000000));
}

TEST(MeshVolumeFromSurface, LeavesNoTetrahedronWithoutHeightBesideSharpEdges) {
  const std::filesystem::path file = MSML_SOURCE_DIR "/data/meshes/anchor.off";
  Registry registry;
  add_operators(registry);
  if (!std::filesystem::exists(file) || registry.format(file) == nullptr) GTEST_SKIP() << "no sample data: " << file;
  QuietReporter listener;
  const auto mesh = output<Mesh>(
      run(tag, {{"surfaceMesh", registry.read(file, Type::surface)}, {"preserveFeatures", true}}, &listener));
  // Volumes of tetrahedra whose edges are near 1/30 of a body of size 1 are near 1e-5; four points of a plane give
  // 1e-20.
  EXPECT_GT(smallest_volume(*mesh), 1e-9);
  // Every edge of the boundary has two faces still: triangles are two thirds of edges.
  const auto surface = output<Surface>(run("ExtractSurfaceMesh", {{"mesh", std::make_shared<const Mesh>(*mesh)}}));
  EXPECT_EQ(
      error_of(tag,
               {{"surfaceMesh", std::make_shared<const Surface>(*surface)}, {"cellSize", 0.2}, {"facetSize", 0.2}}),
      "no error");
}

}  // namespace
}  // namespace msml::test
