// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's XML files: appended raw binary, not compressed, so that they are read and written at the speed of the disk.
#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "operators/formats/formats.hpp"
#include "operators/formats/vtu_writer.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

/// VTK reads zeros behind the end of raw data without a word.
void require_end(const std::filesystem::path& path) {
  constexpr std::string_view end = "</VTKFile>";
  constexpr std::streamoff tail = 64;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - tail));
  std::string text(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, tail)), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (text.find(end) == std::string::npos) throw Error("is cut off or no VTK file: </VTKFile> is not at its end");
}

/// The value of the attribute Name, in quotes of either kind; empty if there is none.
std::string name_in(const std::string& tag) {
  const std::size_t at = tag.find(" Name=");
  if (at == std::string::npos || at + 7 >= tag.size()) return {};
  return tag.substr(at + 7, tag.find(tag[at + 6], at + 7) - at - 7);
}

/// VTK's readers crash where two arrays of the points, or of the cells, have one name.
void require_distinct_names(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::set<std::string> names;
  for (std::string tag; std::getline(in, tag, '<') && !tag.starts_with("AppendedData");) {
    if (tag.starts_with("/DataArray") || tag.starts_with("/Array") || tag.starts_with("InformationKey")) continue;
    if (!tag.starts_with("DataArray") && !tag.starts_with("Array")) {
      names.clear();  // another group begins or ends
      continue;
    }
    const std::string name = name_in(tag.substr(0, tag.find('>')));
    if (!name.empty() && !names.insert(name).second)
      throw Error(fmt::format("holds two arrays named '{}', of which no reader can tell the right one", name));
  }
}

template <class Reader>
vtkSmartPointer<Reader> opened(const std::filesystem::path& path) {
  require_end(path);
  require_distinct_names(path);
  auto reader = vtkSmartPointer<Reader>::New();
  if (reader->CanReadFile(path.c_str()) == 0) throw Error("is not a VTK file of the kind that its name says");
  reader->SetFileName(path.c_str());
  update(*reader, "cannot be read");
  return reader;
}

template <class Writer, class Data>
void write(const vtkSmartPointer<Data>& data, const std::filesystem::path& path) {
  const vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->SetFileName(path.c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  writer->SetIdTypeToInt32();
  if (writer->Write() == 0) throw Error("cannot be written");
}

Value read_grid(const std::filesystem::path& path, Type wanted) {
  return as_wanted(to_mesh(*opened<vtkXMLUnstructuredGridReader>(path)->GetOutput()), wanted);
}

Value read_poly(const std::filesystem::path& path, Type wanted) {
  const auto reader = opened<vtkXMLPolyDataReader>(path);
  if (wanted == Type::surface) return std::make_shared<const Surface>(to_surface(*reader->GetOutput()));
  return std::make_shared<const Mesh>(to_mesh(*reader->GetOutput()));
}

Value read_image(const std::filesystem::path& path, Type) {
  return std::make_shared<const Image>(to_image(*opened<vtkXMLImageDataReader>(path)->GetOutput()));
}

template <class Read, class Write>
Format format(std::string extension, std::string doc, std::vector<Type> reads, std::vector<Type> writes, Read read,
              Write write) {
  return {.extensions = {std::move(extension)},
          .doc = std::move(doc),
          .reads = std::move(reads),
          .writes = std::move(writes),
          .read = [read](const auto& path, Type wanted) { return reading(path, [&] { return read(path, wanted); }); },
          .write = [write](const Value& value, const auto& path,
                           const std::string&) { writing(path, [&] { write(value, path); }); }};
}

}  // namespace

Format vtk_xml_grid() {
  return format(".vtu", "VTK XML unstructured grid; raw binary, doubles, region ids as cell array 'region'.",
                {Type::mesh, Type::surface}, {Type::mesh, Type::surface}, read_grid,
                [](const Value& value, const std::filesystem::path& path) { write_vtu(*mesh_in(value), path); });
}

Format vtk_xml_poly() {
  return format(".vtp", "VTK XML polygonal data; raw binary, doubles.", {Type::mesh, Type::surface}, {Type::surface},
                read_poly, [](const Value& value, const std::filesystem::path& path) {
                  write<vtkXMLPolyDataWriter>(to_vtk(*std::get<SurfacePtr>(value)), path);
                });
}

Format vtk_xml_image() {
  return format(".vti", "VTK XML image; raw binary, origin, spacing and direction.", {Type::image}, {Type::image},
                read_image, [](const Value& value, const std::filesystem::path& path) {
                  write<vtkXMLImageDataWriter>(to_vtk(*std::get<ImagePtr>(value)), path);
                });
}

}  // namespace msml::operators
