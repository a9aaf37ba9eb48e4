// SPDX-License-Identifier: GPL-3.0-or-later
// NIfTI-1 and -2, plain or gzipped, through VTK.
#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNIFTIImageWriter.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <Eigen/LU>

#include "operators/formats/formats.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

/// The matrix takes VTK's coordinates, spacing included, to the patient's; its columns are unit vectors up to shear.
void place(vtkMatrix4x4& matrix, Image& image) {
  Vec3 shift;
  Mat3 turn;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) turn(i, j) = matrix.GetElement(i, j);
    shift[i] = matrix.GetElement(i, 3);
  }
  image.origin = shift + turn * image.origin;
  const Vec3 lengths = turn.colwise().norm();
  if (!(lengths.minCoeff() > 0)) throw Error("its placement matrix is singular");
  image.spacing = image.spacing.cwiseProduct(lengths);
  image.direction = turn * lengths.cwiseInverse().asDiagonal();
  constexpr double tolerance = 1e-4;  // the header holds single precision
  if (!(image.direction.transpose() * image.direction).isIdentity(tolerance))
    throw Error("its axes are sheared, not at right angles; resample it first");
}

void rescale(double slope, double intercept, Image& image) {
  if (slope == 0 || (slope == 1 && intercept == 0)) return;  // slope 0 means: not scaled
  std::vector<double> values;
  std::visit([&](const auto& voxels) { values.assign(voxels.begin(), voxels.end()); }, image.voxels);
  for (double& value : values) value = slope * value + intercept;
  image.voxels = std::move(values);
}

Image read(const std::filesystem::path& path) {
  const vtkNew<vtkNIFTIImageReader> reader;
  if (reader->CanReadFile(path.c_str()) == 0) throw Error("is no NIfTI file, or is cut off");
  reader->SetFileName(path.c_str());
  update(*reader, "cannot be read");
  if (reader->GetTimeDimension() > 1)
    throw Error(fmt::format("holds {} points in time; an Image is one", reader->GetTimeDimension()));
  Image image = to_image(*reader->GetOutput());
  if (vtkMatrix4x4* const sform = reader->GetSFormMatrix())
    place(*sform, image);
  else if (vtkMatrix4x4* const qform = reader->GetQFormMatrix())
    place(*qform, image);
  rescale(reader->GetRescaleSlope(), reader->GetRescaleIntercept(), image);
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
  return {.extensions = {".nii", ".nii.gz"},
          .doc =
              "NIfTI, plain or gzipped; placed by sform, else qform, in the file's own right-anterior-superior "
              "coordinates; rescaled values become doubles.",
          .reads = {Type::image},
          .writes = {Type::image},
          .read = [](const auto& path,
                     Type) { return reading(path, [&] { return std::make_shared<const Image>(read(path)); }); },
          .write =
              [](const Value& value, const auto& path, const std::string& extension) {
                writing(path, [&] { write(*std::get<ImagePtr>(value), path, extension); });
              }};
}

}  // namespace msml::operators
