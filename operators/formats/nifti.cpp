// SPDX-License-Identifier: GPL-3.0-or-later
// NIfTI-1, plain or gzipped. VTK writes it; its reader does not survive damaged files, so reading is done here.
#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageWriter.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "operators/formats/formats.hpp"
#include "operators/formats/raw_voxels.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

/// The fixed part of a NIfTI-1 file (nifti1.h): 348 bytes, in the byte order of the machine that wrote it.
class Header {
 public:
  explicit Header(std::string_view bytes) : bytes_(bytes) {
    constexpr int size = 348;
    if (bytes.size() < size) throw Error(fmt::format("is cut off: {} bytes are no header", bytes.size()));
    big_endian_ = at<std::int32_t>(0) != size;
    if (at<std::int32_t>(0) != size || bytes.substr(344, 3) != "n+1")
      throw Error("is no NIfTI-1 file with header and voxels in one");
  }
  template <class T>
  T at(std::size_t offset) const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  double real(std::size_t offset) const {
    const double value = at<float>(offset);
    if (!std::isfinite(value)) throw Error(fmt::format("its header holds {} at byte {}", value, offset));
    return value;
  }
  bool big_endian() const { return big_endian_; }

 private:
  std::string_view bytes_;
  bool big_endian_ = false;
};

Stored stored_of(int datatype) {
  const std::map<int, Stored> types{
      {2, Stored::uint8},  {4, Stored::int16},    {8, Stored::int32},    {16, Stored::float32}, {64, Stored::float64},
      {256, Stored::int8}, {512, Stored::uint16}, {768, Stored::uint32}, {1024, Stored::int64}, {1280, Stored::uint64}};
  const auto found = types.find(datatype);
  if (found == types.end()) throw Error(fmt::format("has datatype {}, which cannot be read", datatype));
  return found->second;
}

/// Sizes and components: dim[0] counts dim[1] x, [2] y, [3] z, [4] time, [5] components.
void measure(const Header& header, Image& image) {
  std::array<int, 8> dim{};
  for (std::size_t i = 0; i < dim.size(); ++i) dim[i] = header.at<std::int16_t>(40 + 2 * i);
  if (dim[0] < 1 || dim[0] > 7) throw Error(fmt::format("has {} dimensions", dim[0]));
  for (int i = dim[0] + 1; i < 8; ++i) dim[static_cast<std::size_t>(i)] = 1;
  if (dim[4] > 1 || dim[6] > 1 || dim[7] > 1)
    throw Error(fmt::format("holds {} points in time; an Image is one", dim[4]));
  image.size = {dim[1], dim[2], dim[3]};
  image.components = dim[5];
}

/// Voxel axes in the patient's coordinates: from the rows of the sform, else from the quaternion, else from pixdim.
Mat3 axes_of(const Header& header, Vec3& origin) {
  const Vec3 pixel(header.real(80), header.real(84), header.real(88));
  Mat3 axes = pixel.cwiseAbs().asDiagonal();
  if (header.at<std::int16_t>(254) > 0) {
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(280 + 16 * i);
      for (int j = 0; j < 3; ++j) axes(i, j) = header.real(row + 4 * static_cast<std::size_t>(j));
      origin[i] = header.real(row + 12);
    }
  } else if (header.at<std::int16_t>(252) > 0) {
    const double b = header.real(256), c = header.real(260), d = header.real(264);
    const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
    axes = Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix() * axes;
    if (header.real(76) < 0) axes.col(2) *= -1;
    origin = {header.real(268), header.real(272), header.real(276)};
  }
  return axes;
}

void place(const Header& header, Image& image) {
  const Mat3 axes = axes_of(header, image.origin);
  image.spacing = axes.colwise().norm();
  if (!(image.spacing.minCoeff() > 0)) throw Error("one of its voxel axes has no length");
  image.direction = axes * image.spacing.cwiseInverse().asDiagonal();
  constexpr double tolerance = 1e-4;  // the header holds single precision
  if (!(image.direction.transpose() * image.direction).isIdentity(tolerance))
    throw Error("its axes are sheared, not at right angles; resample it first");
}

/// Components are the slowest index in the file and the fastest in an Image.
void interleave(Image& image) {
  const std::size_t voxels = image.voxel_count(), components = static_cast<std::size_t>(image.components);
  if (components == 1) return;
  std::visit(
      [&](auto& values) {
        auto sorted = values;
        for (std::size_t v = 0; v < voxels; ++v)
          for (std::size_t c = 0; c < components; ++c) sorted[v * components + c] = values[c * voxels + v];
        values = std::move(sorted);
      },
      image.voxels);
}

void rescale(double slope, double intercept, Image& image) {
  if (slope == 0 || (slope == 1 && intercept == 0)) return;  // slope 0 means: not scaled
  std::vector<double> values;
  std::visit([&](const auto& voxels) { values.assign(voxels.begin(), voxels.end()); }, image.voxels);
  for (double& value : values) value = slope * value + intercept;
  image.voxels = std::move(values);
}

Image parse(std::string bytes) {
  constexpr std::size_t most = std::size_t{1} << 36;
  if (bytes.starts_with("\x1f\x8b")) bytes = inflated_up_to(bytes, most);
  const Header header(bytes);
  Image image;
  measure(header, image);
  place(header, image);
  const Stored stored = stored_of(header.at<std::int16_t>(70));
  const std::size_t count = value_count(image.size, image.components);
  const double start = header.real(108);
  if (start < 348 || start > static_cast<double>(bytes.size()))
    throw Error(fmt::format("says that its voxels begin at byte {} of {}", start, bytes.size()));
  const std::string_view rest = std::string_view(bytes).substr(static_cast<std::size_t>(start));
  image.voxels = decode(rest.substr(0, count * size_of(stored)), stored, header.big_endian(), count);
  interleave(image);
  rescale(header.real(112), header.real(116), image);
  image.check();
  return image;
}

void write(const Image& image, const std::filesystem::path& path, const std::string& extension) {
  if (image.direction.determinant() < 0)
    throw Error("the direction matrix mirrors the image, which is not written to NIfTI; .mha and .nrrd can hold it");
  Image plain = image;
  plain.origin.setZero();
  plain.direction.setIdentity();
  const vtkNew<vtkMatrix4x4> matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix->SetElement(i, j, image.direction(i, j));
    matrix->SetElement(i, 3, image.origin[i]);
  }
  write_with_extension(path, extension, [&](const std::string& name) {
    const vtkNew<vtkNIFTIImageWriter> writer;
    writer->SetInputData(to_vtk(plain));
    writer->SetQFormMatrix(matrix);
    writer->SetSFormMatrix(matrix);
    writer->SetFileName(name.c_str());
    guarded("cannot be written", [&] { writer->Write(); });
  });
}

}  // namespace

Format nifti() {
  return {
      .extensions = {".nii", ".nii.gz"},
      .doc =
          "NIfTI-1, plain or gzipped; placed by sform, else qform, in the file's own right-anterior-superior "
          "coordinates; rescaled values become doubles.",
      .reads = {Type::image},
      .writes = {Type::image},
      .read = [](const auto& path,
                 Type) { return reading(path, [&] { return std::make_shared<const Image>(parse(text_of(path))); }); },
      .write =
          [](const Value& value, const auto& path, const std::string& extension) {
            writing(path, [&] { write(*std::get<ImagePtr>(value), path, extension); });
          }};
}

}  // namespace msml::operators
