// SPDX-License-Identifier: GPL-3.0-or-later
// CGALMeshVolumeFromVoxels on synthetic labels whose volumes are counts of voxels, and on the sample liver.
#include <gmock/gmock.h>

#include <filesystem>
#include <random>

#include "operators/mesh_labels.hpp"
#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"

namespace msml::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Key;
const std::string tag = "CGALMeshVolumeFromVoxels";

/// Fills the box [low, high) of voxels with a label.
template <class T>
void fill(Image& image, std::array<int, 3> low, std::array<int, 3> high, T label) {
  auto& voxels = std::get<std::vector<T>>(image.voxels);
  for (int k = low[2]; k < high[2]; ++k)
    for (int j = low[1]; j < high[1]; ++j)
      for (int i = low[0]; i < high[0]; ++i) voxels[image.index(i, j, k)] = label;
}

Value stored(const Image& image) { return std::make_shared<const Image>(image); }

/// Two blocks side by side, labels -3 and 70000, of 20 x 10 x 10 and 10 x 10 x 10 voxels of 0.5 x 1 x 2.
Image two_blocks() {
  Image image = make_image<std::int32_t>({34, 14, 14}, Vec3(100, 200, 300), Vec3(0.5, 1, 2));
  fill<std::int32_t>(image, {2, 2, 2}, {22, 12, 12}, -3);
  fill<std::int32_t>(image, {22, 2, 2}, {32, 12, 12}, 70000);
  return image;
}

const Arguments fine{{"facetSize", 2.0}, {"facetDistance", 0.2}, {"cellSize", 2.0}};

Arguments with(Arguments arguments, const std::string& name, Value value) {
  arguments[name] = std::move(value);
  return arguments;
}

TEST(MeshVolumeFromVoxels, RegionsAreLabelsWithTheVolumeOfTheirVoxels) {
  QuietReporter listener;
  const auto mesh = output<Mesh>(run(tag, with(fine, "image", stored(two_blocks())), &listener));
  const auto volumes = region_volumes(*mesh);
  ASSERT_THAT(volumes, ElementsAre(Key(-3), Key(70000)));
  // Edges and corners are rounded by less than facetDistance + a voxel's diagonal at each: a few per cent of so small a
  // body.
  EXPECT_NEAR(volumes.at(-3), 2000, 0.06 * 2000);
  EXPECT_NEAR(volumes.at(70000), 1000, 0.06 * 1000);
  EXPECT_GT(smallest_volume(*mesh), 0);
  EXPECT_EQ(euler_characteristic(*mesh), 1);
  EXPECT_TRUE(listener.warnings.empty());
}

TEST(MeshVolumeFromVoxels, LiesWhereOriginSpacingAndDirectionPutIt) {
  // Blocks end half a voxel beyond their outermost centres: x from 100 + 0.5 * 1.5 to 100 + 0.5 * 31.5.
  Image image = two_blocks();
  const auto straight = output<Mesh>(run(tag, with(fine, "image", stored(image))));
  const Vec3 low(100.75, 201.5, 303), high(115.75, 211.5, 323);
  const double rounding = 0.3;  // facetDistance and rounded corners
  EXPECT_LT((Vec3(straight->points.colwise().minCoeff()) - low).cwiseAbs().maxCoeff(), rounding);
  EXPECT_LT((Vec3(straight->points.colwise().maxCoeff()) - high).cwiseAbs().maxCoeff(), rounding);
  // A direction that mirrors (determinant -1): x = -j, y = -i, z = k.
  image.direction << 0, -1, 0, -1, 0, 0, 0, 0, 1;
  const auto mirrored = output<Mesh>(run(tag, with(fine, "image", stored(image))));
  EXPECT_GT(smallest_volume(*mirrored), 0);
  EXPECT_LT(std::abs(mirrored->points.col(0).minCoeff() - (100 - 11.5)), rounding);
  EXPECT_LT(std::abs(mirrored->points.col(1).maxCoeff() - (200 - 0.75)), rounding);
}

TEST(MeshVolumeFromVoxels, BodiesAtTheRimAreClosedHalfAVoxelOutside) {
  Image image = make_image<std::uint8_t>({8, 8, 8});
  fill<std::uint8_t>(image, {0, 0, 0}, {8, 8, 8}, 1);
  const auto mesh = output<Mesh>(
      run(tag, {{"image", stored(image)}, {"facetSize", 1.0}, {"facetDistance", 0.05}, {"cellSize", 1.0}}));
  EXPECT_NEAR(total_volume(*mesh), 512, 0.05 * 512);  // 512 voxels; edges rounded
  EXPECT_NEAR(mesh->points.minCoeff(), -0.5, 0.05);
  EXPECT_NEAR(mesh->points.maxCoeff(), 7.5, 0.05);
}

TEST(MeshVolumeFromVoxels, IsTheSameToTheLastBitEveryTime) {
  const Arguments arguments = with(with(fine, "image", stored(two_blocks())), "lloyd", true);
  EXPECT_TRUE(same(*output<Mesh>(run(tag, arguments)), *output<Mesh>(run(tag, arguments))));
}

TEST(MeshVolumeFromVoxels, SmallLabelsAreMergedIntoTheirSurroundings) {
  Image image = make_image<std::uint8_t>({30, 14, 14});
  fill<std::uint8_t>(image, {2, 2, 2}, {22, 12, 12}, 5);
  fill<std::uint8_t>(image, {8, 6, 6}, {9, 7, 8}, 84);    // two voxels inside label 5
  fill<std::uint8_t>(image, {26, 6, 6}, {27, 7, 9}, 90);  // three voxels outside
  QuietReporter listener;
  const auto mesh = output<Mesh>(run(tag, with(fine, "image", stored(image)), &listener));
  EXPECT_THAT(region_volumes(*mesh), ElementsAre(Key(5)));
  EXPECT_THAT(listener.notes, ElementsAre("label 84 has only 2 voxels and was merged into 5",
                                          "label 90 has only 3 voxels and was merged into 0"));
}

TEST(MeshVolumeFromVoxels, SmallSeparatePartsAreNotMissed) {
  // A large block and seven cubes of 4^3 voxels far from it and from each other; facets may be larger than the cubes.
  Image image = make_image<std::uint8_t>({60, 60, 60});
  fill<std::uint8_t>(image, {20, 20, 20}, {40, 40, 40}, 1);
  for (std::uint8_t n = 0; n < 7; ++n) {
    const std::array<int, 3> low{n & 1 ? 50 : 5, n & 2 ? 50 : 5, n & 4 ? 50 : 5};
    fill<std::uint8_t>(image, low, {low[0] + 4, low[1] + 4, low[2] + 4},
                       n < 3 ? std::uint8_t(1) : std::uint8_t(10 + n));
  }
  QuietReporter listener;
  const auto mesh = output<Mesh>(
      run(tag, {{"image", stored(image)}, {"facetSize", 10.0}, {"facetDistance", 2.0}, {"cellSize", 10.0}}, &listener));
  EXPECT_THAT(region_volumes(*mesh), ElementsAre(Key(1), Key(13), Key(14), Key(15), Key(16)));
  EXPECT_EQ(euler_characteristic(*mesh), 8);  // eight balls
  EXPECT_TRUE(listener.warnings.empty());
}

TEST(MeshVolumeFromVoxels, AThinPlateKeepsItsLabel) {
  // One voxel thick, and facets may lie ten voxels off.
  Image image = make_image<std::uint8_t>({60, 60, 60});
  fill<std::uint8_t>(image, {20, 20, 20}, {40, 40, 40}, 1);
  fill<std::uint8_t>(image, {5, 5, 50}, {55, 55, 51}, 2);
  QuietReporter listener;
  const auto mesh = output<Mesh>(run(
      tag, {{"image", stored(image)}, {"facetSize", 30.0}, {"facetDistance", 10.0}, {"cellSize", 30.0}}, &listener));
  EXPECT_THAT(region_volumes(*mesh), ElementsAre(Key(1), Key(2)));
  EXPECT_TRUE(listener.warnings.empty());
}

TEST(MeshVolumeFromVoxels, APartWithoutATetrahedronIsFoundMissingAndSeededAllOver) {
  Image image = make_image<std::uint8_t>({20, 8, 8});
  fill<std::uint8_t>(image, {1, 1, 1}, {6, 6, 6}, 9);
  fill<std::uint8_t>(image, {12, 1, 1}, {17, 6, 6}, 9);
  const operators::LabelParts parts = operators::label_parts(image, 50);
  ASSERT_EQ(parts.parts.size(), 2u);
  EXPECT_EQ(parts.parts[1].voxels, 125);
  EXPECT_EQ(parts.parts[1].depth, 2);  // the middle voxel of five
  Mesh mesh;  // one tetrahedron in the first part; the grid has one voxel of rim, so voxel 3 has its centre at 4
  mesh.points.resize(4, 3);
  mesh.points << 4, 4, 4, 5, 4, 4, 4, 5, 4, 4, 4, 5;
  mesh.add_cell(CellKind::tet4, std::array<int, 4>{0, 1, 2, 3}.data(), 1);
  EXPECT_EQ(operators::parts_present(parts, mesh), (std::vector<bool>{true, false}));
  const auto seeds = operators::dense_seeds_of(parts, 1);
  EXPECT_EQ(seeds.size(), 125u * 6);
  for (const auto& seed : seeds) {
    EXPECT_EQ(parts.grid.at(seed.from), 1);
    EXPECT_EQ(parts.grid.at(seed.to), 0);
  }
}

TEST(MeshVolumeFromVoxels, MeetsTheCriteriaItIsGiven) {
  const Value mesh = run(tag, with(with(fine, "image", stored(two_blocks())), "cellRadiusEdgeRatio", 2.0));
  const auto measured = output<Mesh>(run("MeasureMeshQuality", {{"mesh", mesh}}));
  const auto ratio = std::find_if(measured->cell_fields.begin(), measured->cell_fields.end(),
                                  [](const Field& field) { return field.name == "radiusEdgeRatio"; });
  ASSERT_NE(ratio, measured->cell_fields.end());
  EXPECT_LE(*std::max_element(ratio->values.begin(), ratio->values.end()), 2.0 + 1e-9);
}

TEST(MeshVolumeFromVoxels, RefusesWhatIsNoLabelImage) {
  Image grey = make_image<double>({4, 4, 4});
  std::get<std::vector<double>>(grey.voxels)[5] = 0.37;
  EXPECT_EQ(error_of(tag, {{"image", stored(grey)}}),
            "voxel 5 of the image holds 0.37; a label image holds whole numbers");
  EXPECT_EQ(error_of(tag, {{"image", stored(make_image<std::uint8_t>({4, 4, 4}))}}),
            "the image holds nothing but 0, the outside");
  Image specks = make_image<std::uint8_t>({9, 9, 9});
  fill<std::uint8_t>(specks, {4, 4, 4}, {6, 6, 6}, 7);
  EXPECT_EQ(error_of(tag, {{"image", stored(specks)}}), "no label of the image has minVoxels = 50 voxels or more");
  Image crowd = make_image<std::int16_t>({400, 1, 1});
  for (std::int16_t i = 0; i < 400; ++i)
    std::get<std::vector<std::int16_t>>(crowd.voxels)[static_cast<std::size_t>(i)] = i;
  EXPECT_EQ(error_of(tag, {{"image", stored(crowd)}, {"minVoxels", Integer{1}}}),
            "the image has 399 labels; at most 254 can be meshed");
}

TEST(MeshVolumeFromVoxels, MeshesEveryLabelOfTheSampleLiver) {
  const std::filesystem::path file = MSML_SOURCE_DIR "/data/images/liver.inr.gz";
  Registry registry;
  add_operators(registry);
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no sample data: " << file;
  if (registry.format(file) == nullptr) GTEST_SKIP() << "no reader for " << file;
  const Value image = registry.read(file, Type::image);
  QuietReporter listener;
  const auto mesh = output<Mesh>(run(tag,
                                     {{"image", image},
                                      {"facetAngle", 30.0},
                                      {"facetSize", 6.0},
                                      {"facetDistance", 2.0},
                                      {"cellRadiusEdgeRatio", 3.0},
                                      {"cellSize", 8.0}},
                                     &listener));
  const auto volumes = region_volumes(*mesh);
  ASSERT_THAT(volumes, ElementsAre(Key(85), Key(127), Key(255)));
  const double voxel = 0.617188 * 0.617188 * 1.33333;                     // from the file's header
  EXPECT_NEAR(volumes.at(255), 3160496 * voxel, 0.02 * 3160496 * voxel);  // facetDistance against 100 mm of liver
  EXPECT_NEAR(volumes.at(127), 314086 * voxel, 0.05 * 314086 * voxel);
  EXPECT_NEAR(volumes.at(85), 17704 * voxel, 0.25 * 17704 * voxel);  // a body as thin as the facets
  EXPECT_THAT(listener.notes, ::testing::Contains("label 84 has only 2 voxels and was merged into 85"));
}

}  // namespace
}  // namespace msml::test
