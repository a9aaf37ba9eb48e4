// SPDX-License-Identifier: GPL-3.0-or-later
// The header names each array and its place behind it; the arrays follow as they lie in memory.
#include "operators/formats/vtu_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "msml/core/error.hpp"
#include "operators/vtk_fields.hpp"

namespace msml::operators {
namespace {

/// Bytes of one array; each stands in the file behind its length as 8 bytes.
struct Block {
  const void* data;
  std::uint64_t bytes;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

class Header {
 public:
  void open(std::string_view element) { text += fmt::format("<{}>\n", element); }
  template <class T>
  void array(std::string_view type, const std::string& name, int components, const T* data, std::size_t count) {
    text += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
        escaped(name), components, end_);
    blocks.push_back({data, count * sizeof(T)});
    end_ += sizeof(std::uint64_t) + blocks.back().bytes;
  }
  /// All fields but those that a later one of the same name replaces, or that are called `taken`.
  void fields(const std::vector<Field>& all, std::size_t count, const char* what, std::string_view taken) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      check_field(all[k], count, what);
      bool replaced = all[k].name == taken;
      for (std::size_t later = k + 1; later < all.size(); ++later)
        replaced = replaced || all[later].name == all[k].name;
      if (!replaced) array("Float64", all[k].name, all[k].components, all[k].values.data(), all[k].values.size());
    }
  }

  std::string text;
  std::vector<Block> blocks;

 private:
  std::uint64_t end_ = 0;
};

void put(const Header& header, const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  out << header.text;
  for (const Block& block : header.blocks) {
    out.write(reinterpret_cast<const char*>(&block.bytes), sizeof block.bytes);
    out.write(static_cast<const char*>(block.data), static_cast<std::streamsize>(block.bytes));
  }
  out << "\n</AppendedData>\n</VTKFile>\n";
  out.close();
  if (!out) throw Error(std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace

void write_vtu(const Mesh& mesh, const std::filesystem::path& path) {
  mesh.check();
  const auto points = static_cast<std::size_t>(mesh.point_count()), cells = mesh.kinds.size();
  std::vector<std::uint8_t> types;
  for (const CellKind kind : mesh.kinds) types.push_back(static_cast<std::uint8_t>(vtk_type(kind)));
  constexpr const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  const bool regions = !mesh.regions.empty();
  Header header;
  header.text = "<?xml version=\"1.0\"?>\n";
  header.open(
      fmt::format("VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\"", order));
  header.open("UnstructuredGrid");
  header.open(fmt::format("Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", points, cells));
  header.open("PointData");
  header.fields(mesh.point_fields, points, "point", "");
  header.open("/PointData");
  header.open(regions ? "CellData Scalars=\"region\"" : "CellData");
  header.fields(mesh.cell_fields, cells, "cell", regions ? "region" : "");
  if (regions) header.array("Int32", "region", 1, mesh.regions.data(), cells);
  header.open("/CellData");
  header.open("Points");
  header.array("Float64", "Points", 3, mesh.points.data(), 3 * points);
  header.open("/Points");
  header.open("Cells");
  header.array("Int32", "connectivity", 1, mesh.nodes.data(), mesh.nodes.size());
  header.array("Int32", "offsets", 1, mesh.offsets.data() + 1, cells);
  header.array("UInt8", "types", 1, types.data(), cells);
  for (const char* const element : {"/Cells", "/Piece", "/UnstructuredGrid"}) header.open(element);
  header.text += "<AppendedData encoding=\"raw\">\n_";
  put(header, path);
}

}  // namespace msml::operators
