// SPDX-License-Identifier: GPL-3.0-or-later
// What the formats share.
#include <vtkSmartPointer.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "operators/formats/formats.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_fields.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {

Value reading(const std::filesystem::path& path, const std::function<Value()>& read) {
  Value value;
  try {
    guarded("cannot be read", [&] { value = read(); });
  } catch (const Error& e) {
    throw Error(path.string() + ": " + e.what());
  }
  return value;
}

void writing(const std::filesystem::path& path, const std::function<void()>& write) {
  try {
    guarded("cannot be written", write);
  } catch (const Error& e) {
    throw Error(path.string() + ": " + e.what());
  }
}

Value as_wanted(Mesh mesh, Type wanted) {
  if (wanted == Type::surface) return std::make_shared<const Surface>(to_surface(mesh));
  return std::make_shared<const Mesh>(std::move(mesh));
}

Value as_wanted(Surface surface, Type wanted) {
  if (wanted == Type::surface) return std::make_shared<const Surface>(std::move(surface));
  Mesh mesh = to_mesh(surface);
  mesh.regions = take_regions(mesh.cell_fields);
  return std::make_shared<const Mesh>(std::move(mesh));
}

MeshPtr mesh_in(const Value& value) {
  if (const auto* mesh = std::get_if<MeshPtr>(&value)) return *mesh;
  Mesh mesh = to_mesh(*std::get<SurfacePtr>(value));
  mesh.regions = take_regions(mesh.cell_fields);
  return std::make_shared<const Mesh>(std::move(mesh));
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error(std::string("cannot be read: ") + (errno ? std::strerror(errno) : "it is empty"));
  return std::move(text).str();
}

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out << bytes;
  out.close();
  if (!out) throw Error(std::string("cannot be written: ") + std::strerror(errno));
}

void write_with_extension(const std::filesystem::path& path, const std::string& extension,
                          const std::function<void(const std::string& name)>& write) {
  const std::filesystem::path named = path.string() + extension;
  std::error_code code;
  try {
    write(named.string());
    std::filesystem::rename(named, path, code);
    if (code) throw Error("cannot be written: " + code.message());
  } catch (...) {
    std::filesystem::remove(named, code);
    throw;
  }
}

void require_upright(const Image& image) {
  if (!image.direction.isIdentity(1e-12))
    throw Error(
        "the image is turned (its direction matrix is not the identity), which this format cannot hold; "
        ".vti, .mha and .nrrd can");
}

Format mesh_text_format(std::string extension, std::string doc, Mesh (*parse)(const std::string&),
                        std::string (*written)(const Mesh&)) {
  return {
      .extensions = {std::move(extension)},
      .doc = std::move(doc),
      .reads = {Type::mesh, Type::surface},
      .writes = {Type::mesh, Type::surface},
      .read = [parse](const auto& path,
                      Type wanted) { return reading(path, [&] { return as_wanted(parse(text_of(path)), wanted); }); },
      .write = [written](const Value& value, const auto& path,
                         const std::string&) { writing(path, [&] { put(path, written(*mesh_in(value))); }); }};
}

Format image_text_format(std::string extension, std::string doc, Image (*parse)(const std::string&),
                         std::string (*written)(const Image&)) {
  return {.extensions = {std::move(extension)},
          .doc = std::move(doc),
          .reads = {Type::image},
          .writes = {Type::image},
          .read =
              [parse](const auto& path, Type) {
                return reading(path, [&] { return std::make_shared<const Image>(parse(text_of(path))); });
              },
          .write = [written](
                       const Value& value, const auto& path,
                       const std::string&) { writing(path, [&] { put(path, written(*std::get<ImagePtr>(value))); }); }};
}

}  // namespace msml::operators
