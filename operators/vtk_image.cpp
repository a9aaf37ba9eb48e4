// SPDX-License-Identifier: GPL-3.0-or-later
// Images to and from VTK.
#include <fmt/format.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <algorithm>
#include <limits>
#include <type_traits>

#include "msml/core/error.hpp"
#include "operators/vtk_convert.hpp"

namespace msml::operators {
namespace {

template <class T>
std::vector<T> values_of(vtkDataArray& array) {
  const int components = array.GetNumberOfComponents();
  std::vector<T> values(static_cast<std::size_t>(array.GetNumberOfTuples() * components));
  for (vtkIdType i = 0, at = 0; i < array.GetNumberOfTuples(); ++i)
    for (int c = 0; c < components; ++c)
      values[static_cast<std::size_t>(at++)] = static_cast<T>(array.GetComponent(i, c));
  return values;
}

/// Integers wider than 32 bits, or unsigned, as int32 where all fit, else as double.
Voxels narrowed(vtkDataArray& array) {
  double low = 0, high = 0;
  for (int c = 0; c < array.GetNumberOfComponents(); ++c) {
    const double* const range = array.GetRange(c);
    low = std::min(low, range[0]);
    high = std::max(high, range[1]);
  }
  if (low >= std::numeric_limits<std::int32_t>::min() && high <= std::numeric_limits<std::int32_t>::max())
    return values_of<std::int32_t>(array);
  return values_of<double>(array);
}

Voxels voxels_of(vtkDataArray& array) {
  switch (array.GetDataType()) {
    case VTK_BIT:
    case VTK_UNSIGNED_CHAR:
      return values_of<std::uint8_t>(array);
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
    case VTK_SHORT:
      return values_of<std::int16_t>(array);
    case VTK_UNSIGNED_SHORT:
      return values_of<std::uint16_t>(array);
    case VTK_INT:
      return values_of<std::int32_t>(array);
    case VTK_FLOAT:
      return values_of<float>(array);
    case VTK_DOUBLE:
      return values_of<double>(array);
    default:
      return narrowed(array);
  }
}

vtkDataArray& scalars_of(vtkImageData& data, const std::string& name) {
  vtkPointData& all = *data.GetPointData();
  vtkDataArray* array = name.empty() ? all.GetScalars() : all.GetArray(name.c_str());
  for (int i = 0; name.empty() && array == nullptr && i < all.GetNumberOfArrays(); ++i) array = all.GetArray(i);
  if (array == nullptr) throw Error("the image has no voxel values" + (name.empty() ? "" : " named " + name));
  return *array;
}

template <class T>
constexpr int scalar_type() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return VTK_UNSIGNED_CHAR;
  if constexpr (std::is_same_v<T, std::int16_t>) return VTK_SHORT;
  if constexpr (std::is_same_v<T, std::uint16_t>) return VTK_UNSIGNED_SHORT;
  if constexpr (std::is_same_v<T, std::int32_t>) return VTK_INT;
  if constexpr (std::is_same_v<T, float>) return VTK_FLOAT;
  return VTK_DOUBLE;
}

}  // namespace

vtkSmartPointer<vtkImageData> to_vtk(const Image& image) {
  image.check();
  auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(image.size.data());
  data->SetOrigin(image.origin.data());
  data->SetSpacing(image.spacing.data());
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> direction = image.direction;
  data->SetDirectionMatrix(direction.data());
  std::visit(
      [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        data->AllocateScalars(scalar_type<T>(), image.components);
        std::copy(values.begin(), values.end(), static_cast<T*>(data->GetScalarPointer()));
      },
      image.voxels);
  data->GetPointData()->GetScalars()->SetName("values");
  return data;
}

Image to_image(vtkImageData& data, const std::string& array) {
  vtkDataArray& scalars = scalars_of(data, array);
  Image image;
  data.GetDimensions(image.size.data());
  if (scalars.GetNumberOfTuples() != static_cast<vtkIdType>(image.voxel_count()))
    throw Error(fmt::format("the image has {} values for {} voxels", scalars.GetNumberOfTuples(), image.voxel_count()));
  const int* const extent = data.GetExtent();
  data.TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], image.origin.data());
  data.GetSpacing(image.spacing.data());
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) image.direction(i, j) = data.GetDirectionMatrix()->GetElement(i, j);
  image.components = scalars.GetNumberOfComponents();
  image.voxels = voxels_of(scalars);
  image.check();
  return image;
}

}  // namespace msml::operators
