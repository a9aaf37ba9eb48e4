// SPDX-License-Identifier: GPL-3.0-or-later
// Images through files and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/operators/shared/files.hpp"

namespace msml {
namespace {

using testing::HasSubstr;
using Round = std::tuple<std::string, int>;

/// 4 x 3 x 2 voxels of the type in position `kind` of Voxels, all different.
Image sample(int kind) {
  Image image{.size = {4, 3, 2}, .origin = {-1.5, 2.25, 10}, .spacing = {0.5, 0.75, 1.25}};
  const auto fill = [&](auto list) {
    for (int i = 0; i < 24; ++i) list.push_back(static_cast<typename decltype(list)::value_type>(7 * i + 1));
    image.voxels = std::move(list);
  };
  if (kind == 0) fill(std::vector<std::uint8_t>());
  if (kind == 1) fill(std::vector<std::int16_t>());
  if (kind == 2) fill(std::vector<std::uint16_t>());
  if (kind == 3) fill(std::vector<std::int32_t>());
  if (kind == 4) fill(std::vector<float>());
  if (kind == 5) fill(std::vector<double>());
  return image;
}

ImagePtr through(const Image& image, const std::filesystem::path& path) {
  const Registry registry = test::all();
  registry.write(std::make_shared<const Image>(image), path);
  return std::get<ImagePtr>(registry.read(path, Type::image));
}

class ImageFile : public testing::TestWithParam<Round> {};

TEST_P(ImageFile, KeepsVoxelsTheirTypeAndTheirPlace) {
  const test::Folder folder("msml_image");
  const Image image = sample(std::get<1>(GetParam()));
  const ImagePtr back = through(image, folder / ("i" + std::get<0>(GetParam())));
  EXPECT_EQ(back->size, image.size);
  EXPECT_TRUE(back->voxels == image.voxels);
  EXPECT_LT((back->origin - image.origin).norm(), 1e-12);  // all are short binary fractions, exact in single precision
  EXPECT_LT((back->spacing - image.spacing).norm(), 1e-12);
  EXPECT_TRUE(back->direction.isIdentity(1e-12));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}
INSTANTIATE_TEST_SUITE_P(All, ImageFile,
                         testing::Combine(testing::Values(".vti", ".vtk", ".inr", ".inr.gz", ".nii", ".nii.gz", ".mha",
                                                          ".nrrd"),
                                          testing::Range(0, 6)));

class TurnedImageFile : public testing::TestWithParam<std::string> {};

TEST_P(TurnedImageFile, KeepsTheDirection) {
  const test::Folder folder("msml_turned");
  Image image = sample(0);
  image.direction = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const ImagePtr back = through(image, folder / ("i" + GetParam()));
  const double tolerance = GetParam().starts_with(".nii") ? 2e-6 : 1e-12;  // NIfTI stores single precision
  EXPECT_LT((back->direction - image.direction).norm(), tolerance);
  EXPECT_LT((back->origin - image.origin).norm(), tolerance);
  EXPECT_LT((back->spacing - image.spacing).norm(), tolerance);
  EXPECT_TRUE(back->voxels == image.voxels);
}
INSTANTIATE_TEST_SUITE_P(All, TurnedImageFile, testing::Values(".vti", ".mha", ".nrrd", ".nii", ".nii.gz"));

TEST(ImageFiles, FormatsWithoutDirectionRefuseATurnedImage) {
  const test::Folder folder("msml_upright");
  Image image = sample(0);
  image.direction = Eigen::AngleAxisd(1, Vec3::UnitZ()).toRotationMatrix();
  EXPECT_THROW(through(image, folder / "i.inr"), Error);
  EXPECT_THROW(through(image, folder / "i.vtk"), Error);
}

TEST(ImageFiles, AnInrimageByHandIsRead) {
  const test::Folder folder("msml_inr");
  std::string header =
      "#INRIMAGE-4#{\nXDIM=2\nYDIM=1\nZDIM=1\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=16 bits\nSCALE=2**0\n"
      "CPU=sun\nVX=0.5\nVY=1\nVZ=2\n";
  header.append(256 - 4 - header.size(), '\n');
  test::put_bytes(folder / "i.inr", header + "##}\n" + std::string("\x01\x02\x00\x03", 4));
  const ImagePtr image = std::get<ImagePtr>(test::all().read(folder / "i.inr", Type::image));
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(image->voxels), (std::vector<std::uint16_t>{258, 3}));  // big endian
  EXPECT_EQ(image->spacing, Vec3(0.5, 1, 2));
}

TEST(ImageFiles, ANaNIsNeverWritten) {
  const test::Folder folder("msml_image_nan");
  Image image = sample(5);
  std::get<std::vector<double>>(image.voxels)[3] = std::nan("");
  for (const char* const name : {"i.vti", "i.vtk", "i.inr", "i.nii", "i.mha", "i.nrrd"}) {
    EXPECT_THROW(through(image, folder / name), Error) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  }
}

TEST(ImageFiles, AMeshFileIsNoImage) {
  const test::Folder folder("msml_no_image");
  test::put_bytes(folder / "p.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n");
  EXPECT_EQ(test::read_error(folder / "p.vtk", Type::image), "p.vtk: holds polygons, which is no Image");
}

class DamagedImageFile : public testing::TestWithParam<std::string> {};

TEST_P(DamagedImageFile, IsAnErrorOrAValidImageAndPrintsNothing) {
  const test::Folder folder("msml_damaged_image");
  const auto good = folder / ("g" + GetParam()), bad = folder / ("b" + GetParam());
  through(sample(0), good);
  const std::string bytes = test::bytes_of(good);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  int unnoticed = 0;
  for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 60) {
    test::put_bytes(bad, bytes.substr(0, n));
    unnoticed += test::read_error(bad, Type::image) == "no error";
  }
  for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 300) {
    std::string damaged = bytes;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x15);
    test::put_bytes(bad, damaged);
    test::read_error(bad, Type::image);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(unnoticed, 0);
}
INSTANTIATE_TEST_SUITE_P(All, DamagedImageFile,
                         testing::Values(".vti", ".vtk", ".inr", ".inr.gz", ".nii", ".nii.gz", ".mha", ".nrrd"));

}  // namespace
}  // namespace msml
