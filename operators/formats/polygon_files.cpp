// SPDX-License-Identifier: GPL-3.0-or-later
// Files that hold polygons and nothing else: .stl, .off, .obj, .ply. CGAL reads all but the last, in double precision.
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>
#include <vtkSmartPointer.h>

#include <bit>
#include <cstring>
#include <iterator>
#include <sstream>

#include "operators/formats/formats.hpp"
#include "operators/formats/ply_reader.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {
namespace {

struct Polygons {
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
};

/// Polygons of more than three corners are cut into triangles.
Surface surface_of(const Polygons& soup) {
  const vtkNew<vtkPolyData> data;
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& p : soup.points) points->InsertNextPoint(p.x(), p.y(), p.z());
  const vtkNew<vtkCellArray> cells;
  for (const auto& face : soup.faces) {
    const std::vector<vtkIdType> ids(face.begin(), face.end());
    cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  data->SetPoints(points);
  data->SetPolys(cells);
  Surface surface = to_surface(*data);
  if (surface.triangles.empty()) throw Error("holds no triangles");
  return surface;
}

/// An ASCII file says "solid"; a binary one has 80 bytes, the number of triangles, and 50 bytes for each.
void require_whole_stl(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const bool binary = bytes.size() >= 84 && bytes.size() == 84 + 50 * std::size_t{count};
  const bool ascii = bytes.starts_with("solid") && bytes.find("endsolid") != std::string::npos;
  if (!binary && !ascii)
    throw Error(fmt::format("is cut off or no STL file: {} bytes, where {} triangles would take {}", bytes.size(),
                            count, 84 + 50 * std::size_t{count}));
}

bool parse(const std::string& extension, const std::string& bytes, Polygons& soup) {
  std::istringstream in(bytes, std::ios::binary);
  const auto quiet = CGAL::parameters::verbose(false);
  if (extension == ".stl") {
    require_whole_stl(bytes);
    return CGAL::IO::read_STL(in, soup.points, soup.faces, quiet);
  }
  if (extension == ".off") return CGAL::IO::read_OFF(in, soup.points, soup.faces, quiet);
  if (extension == ".obj") return CGAL::IO::read_OBJ(in, soup.points, soup.faces, quiet);
  const PlyPolygons read = read_ply(bytes);
  for (const Vec3& p : read.points) soup.points.emplace_back(p[0], p[1], p[2]);
  for (const auto& face : read.faces) soup.faces.emplace_back(face.begin(), face.end());
  return true;
}

Surface read(const std::string& extension, const std::filesystem::path& path) {
  Polygons soup;
  if (!parse(extension, text_of(path), soup)) throw Error("is cut off or no " + extension.substr(1) + " file");
  return surface_of(soup);
}

std::string off_text(const Surface& surface) {
  std::string text = fmt::format("OFF\n{} {} 0\n", surface.point_count(), surface.triangle_count());
  for (int i = 0; i < surface.point_count(); ++i)
    text += fmt::format("{} {} {}\n", surface.points(i, 0), surface.points(i, 1), surface.points(i, 2));
  for (const auto& t : surface.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

std::string obj_text(const Surface& surface) {
  std::string text;
  for (int i = 0; i < surface.point_count(); ++i)
    text += fmt::format("v {} {} {}\n", surface.points(i, 0), surface.points(i, 1), surface.points(i, 2));
  for (const auto& t : surface.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string ply_bytes(const Surface& surface) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      surface.point_count(), surface.triangle_count());
  const auto add = [&](const void* data, std::size_t n) { bytes.append(static_cast<const char*>(data), n); };
  add(surface.points.data(), static_cast<std::size_t>(surface.points.size()) * sizeof(double));
  for (const auto& t : surface.triangles) {
    bytes.push_back(3);
    add(t.data(), sizeof t);
  }
  return bytes;
}

void write_stl(const Surface& surface, const std::filesystem::path& path) {
  const vtkNew<vtkSTLWriter> writer;
  writer->SetInputData(to_vtk(surface));
  writer->SetFileName(path.c_str());
  writer->SetFileTypeToBinary();
  if (writer->Write() == 0) throw Error("cannot be written");
}

Format polygons(const std::string& extension, std::string doc, std::string (*bytes_of)(const Surface&)) {
  return {.extensions = {extension},
          .doc = std::move(doc),
          .reads = {Type::mesh, Type::surface},
          .writes = {Type::surface},
          .read = [extension](
                      const auto& path,
                      Type wanted) { return reading(path, [&] { return as_wanted(read(extension, path), wanted); }); },
          .write =
              [bytes_of](const Value& value, const auto& path, const std::string&) {
                const Surface& surface = *std::get<SurfacePtr>(value);
                writing(path, [&] {
                  surface.check();
                  if (bytes_of)
                    put(path, bytes_of(surface));
                  else
                    write_stl(surface, path);
                });
              }};
}

}  // namespace

Format stl() {
  return polygons(".stl",
                  "STL triangles, ASCII or binary; equal corners become one point. Written in binary, in single "
                  "precision; fields are not kept.",
                  nullptr);
}
Format off() { return polygons(".off", "OFF polygons; fields are not kept.", off_text); }
Format obj() { return polygons(".obj", "Wavefront OBJ; positions and faces only.", obj_text); }
Format ply() {
  return polygons(".ply", "PLY polygons, ASCII or binary; written in binary doubles; fields are not kept.", ply_bytes);
}

}  // namespace msml::operators
