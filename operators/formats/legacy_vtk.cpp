// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's legacy files.
#include <fmt/format.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkPolyDataWriter.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredPoints.h>
#include <vtkStructuredPointsReader.h>
#include <vtkStructuredPointsWriter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkUnstructuredGridWriter.h>

#include "operators/formats/formats.hpp"
#include "operators/formats/legacy_check.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

template <class Reader>
vtkSmartPointer<Reader> read_all(const std::filesystem::path& path) {
  auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllFieldsOn();
  update(*reader, "cannot be read");
  return reader;
}

Value read_poly(const std::filesystem::path& path, Type wanted) {
  const auto reader = read_all<vtkPolyDataReader>(path);
  if (wanted == Type::surface) return std::make_shared<const Surface>(to_surface(*reader->GetOutput()));
  return std::make_shared<const Mesh>(to_mesh(*reader->GetOutput()));
}

Value read(const std::filesystem::path& path, Type wanted) {
  check_legacy_cells(text_of(path));
  const vtkNew<vtkGenericDataObjectReader> probe;
  probe->SetFileName(path.c_str());
  const int kind = probe->ReadOutputType();
  const bool image = wanted == Type::image || wanted == Type::images;
  if (kind == VTK_STRUCTURED_POINTS && image)
    return std::make_shared<const Image>(to_image(*read_all<vtkStructuredPointsReader>(path)->GetOutput()));
  if (kind == VTK_POLY_DATA && !image) return read_poly(path, wanted);
  if (kind == VTK_UNSTRUCTURED_GRID && !image)
    return as_wanted(to_mesh(*read_all<vtkUnstructuredGridReader>(path)->GetOutput()), wanted);
  if (kind == VTK_STRUCTURED_POINTS || kind == VTK_POLY_DATA || kind == VTK_UNSTRUCTURED_GRID)
    throw Error(fmt::format("holds {}, which is no {}",
                            kind == VTK_STRUCTURED_POINTS ? "an image"
                            : kind == VTK_POLY_DATA       ? "polygons"
                                                          : "a grid",
                            name(wanted)));
  throw Error("is no VTK file that holds an unstructured grid, polygonal data or structured points");
}

template <class Writer>
void write_as(vtkDataObject* data, const std::filesystem::path& path) {
  const vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->SetFileName(path.c_str());
  writer->SetFileTypeToBinary();
  writer->SetFileVersion(vtkDataWriter::VTK_LEGACY_READER_VERSION_4_2);  // MSML's tools and old ParaViews stop there
  if (writer->Write() == 0) throw Error("cannot be written");
}

void write(const Value& value, const std::filesystem::path& path) {
  if (const auto* mesh = std::get_if<MeshPtr>(&value)) return write_as<vtkUnstructuredGridWriter>(to_vtk(**mesh), path);
  if (const auto* surface = std::get_if<SurfacePtr>(&value))
    return write_as<vtkPolyDataWriter>(to_vtk(**surface), path);
  const Image& image = *std::get<ImagePtr>(value);
  require_upright(image);
  const vtkNew<vtkStructuredPoints> points;
  points->ShallowCopy(to_vtk(image));
  write_as<vtkStructuredPointsWriter>(points, path);
}

}  // namespace

Format legacy_vtk() {
  return {.extensions = {".vtk"},
          .doc = "VTK legacy file: unstructured grid, polygonal data or structured points; written in binary, 4.2.",
          .reads = {Type::mesh, Type::surface, Type::image},
          .writes = {Type::mesh, Type::surface, Type::image},
          .read = [](const auto& path, Type wanted) { return reading(path, [&] { return read(path, wanted); }); },
          .write = [](const Value& value, const auto& path,
                      const std::string&) { writing(path, [&] { write(value, path); }); }};
}

}  // namespace msml::operators
