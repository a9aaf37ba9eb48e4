// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles (lines, vertices) and nodes turned into the sides of a body that loads act on.
#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "operators/simulate/records.hpp"
#include "operators/simulate/selection.hpp"

namespace msml::simulation {
namespace {

/// True for cells that can be a side of the body's elements: triangles, lines of a plane body, vertices of a line.
bool is_side(CellKind kind, const Body& body) { return dimension(kind) == dimension(body.kind) - 1; }

/// "triangle", "line" or "vertex".
const char* side_noun(const Body& body) {
  constexpr const char* nouns[] = {"", "vertex", "line", "triangle"};
  return nouns[dimension(body.kind)];
}

/// The four triangles through the mid nodes of each boundary face of quadratic tetrahedra, by their nodes.
class Quarters {
 public:
  Quarters(const Body& body, const FaceTable& table) {
    for (const fe::Face& face : table.boundary_faces()) {
      const auto nodes = face_nodes(*body.mesh, face);
      if (nodes.size() != 6) continue;
      for (std::size_t i = 0; i < 3; ++i) add({nodes[i], nodes[3 + i], nodes[3 + (i + 2) % 3]}, face);
      add({nodes[3], nodes[4], nodes[5]}, face);
    }
  }
  /// Element -1 if there is none.
  fe::Face find(SideCorners nodes) const {
    std::sort(nodes.begin(), nodes.end());
    const auto found = faces_.find(nodes);
    return found == faces_.end() ? fe::Face{} : found->second;
  }

 private:
  void add(SideCorners nodes, const fe::Face& face) {
    std::sort(nodes.begin(), nodes.end());
    faces_[nodes] = face;
  }
  std::map<SideCorners, fe::Face> faces_;
};

/// Matches triangles with faces of a body, by node ids first where they index the body's points, then by place. Four
/// triangles through the mid nodes make a face.
class Matcher {
 public:
  Matcher(const Record& record, const Body& body, const Mesh& triangles, bool shares_points)
      : record_(record), body_(body), triangles_(triangles), shares_points_(shares_points), table_(body) {}

  /// `chosen`: by their nodes, so that parts of faces were not meant.
  std::vector<fe::Face> match(const std::vector<int>& cells, bool chosen = false) {
    std::vector<fe::Face> faces;
    for (const int cell : cells) {
      bool quarter = false;
      const fe::Face face = match(cell, quarter);
      if (face.element < 0) continue;
      if (quarter) {
        parts_[{face.element, face.local}].insert(cell);
        if (parts_[{face.element, face.local}].size() < 4) continue;
      }
      const auto [earlier, fresh] = taken_.try_emplace({face.element, face.local}, cell);
      if (!fresh)
        refuse(record_, fmt::format("cells {} and {} in indices are the same face of the body, at {}", earlier->second,
                                    cell, place(centroid(triangles_, cell))));
      faces.push_back(face);
    }
    for (const auto& [face, quarters] : parts_)
      if (quarters.size() < 4 && !chosen) partial_.insert(partial_.end(), quarters.begin(), quarters.end());
    report(partial_, static_cast<int>(cells.size()),
           "are parts of faces with mid nodes of which not all four are named");
    report(inside_, static_cast<int>(cells.size()), "lie between two elements, not on the boundary");
    report(unmatched_, static_cast<int>(cells.size()), "match no face of an element");
    return faces;
  }

 private:
  fe::Face match(int cell, bool& quarter) {
    const int* nodes = triangles_.cell(cell);
    const auto count = static_cast<std::size_t>(dimension(body_.kind));
    SideCorners corners{-1, -1, -1};
    std::copy_n(nodes, count, corners.begin());
    if (shares_points_) {
      if (const fe::Face face = table_.boundary(corners); face.element >= 0) return face;
      if (table_.inside(corners)) return inside_.push_back(cell), fe::Face{};
    }
    if (!places_) places_.emplace(body_);
    std::array<std::vector<int>, 3> candidates{{{-1}, {-1}, {-1}}};
    for (std::size_t i = 0; i < count; ++i) candidates[i] = places_->at(triangles_.points.row(corners[i]).transpose());
    bool between = false;
    for (const int a : candidates[0])
      for (const int b : candidates[1])
        for (const int c : candidates[2]) {
          if (const fe::Face face = table_.boundary({a, b, c}); face.element >= 0) return face;
          between = between || table_.inside({a, b, c});
        }
    if (!quarters_) quarters_.emplace(body_, table_);
    quarter = true;
    for (const int a : candidates[0])
      for (const int b : candidates[1])
        for (const int c : candidates[2])
          if (const fe::Face face = quarters_->find({a, b, c}); face.element >= 0) return face;
    (between ? inside_ : unmatched_).push_back(cell);
    return {};
  }

  void report(const std::vector<int>& cells, int all, const char* what) const {
    if (cells.empty()) return;
    refuse(record_, fmt::format("{} of the {} in indices {}; the first is cell {} at {}",
                                with_commas(static_cast<int>(cells.size())), counted(all, "face"), what, cells.front(),
                                place(centroid(triangles_, cells.front()))));
  }

  const Record& record_;
  const Body& body_;
  const Mesh& triangles_;
  bool shares_points_;
  FaceTable table_;
  std::optional<PlaceTable> places_;
  std::optional<Quarters> quarters_;
  std::vector<int> inside_, unmatched_, partial_;
  std::map<std::pair<int, int>, std::set<int>> parts_;  ///< face -> the cells that are quarters of it
  std::map<std::pair<int, int>, int> taken_;            ///< face -> the cell that named it
};

void check_sides(const Record& record, const IndexSet& set, const Mesh& mesh, const Body& body) {
  for (const int id : set.ids) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(id)];
    if (!is_side(kind, body))
      refuse(record, fmt::format("indices names cell {}, which is a {}; {} cells are wanted, for example from "
                                 "ComputeIndicesFromBoxROI with select=\"surfaceElements\"",
                                 id, name(kind), side_noun(body)));
  }
}

void refuse_empty(const Record& record, const Body& body) {
  refuse(record, fmt::format("indices is empty; the body spans {}", bounds(body)));
}

std::vector<fe::Face> faces_between(const IndexSet& set, const Body& body) {
  std::vector<bool> in(body.solid.size(), false);
  for (const int id : set.ids) in[static_cast<std::size_t>(id)] = true;
  const FaceTable table(body);
  std::vector<fe::Face> faces;
  for (const fe::Face& face : table.boundary_faces()) {
    const auto nodes = face_nodes(*body.mesh, face);
    if (std::all_of(nodes.begin(), nodes.begin() + dimension(body.kind),
                    [&](int node) { return in[static_cast<std::size_t>(node)]; }))
      faces.push_back(face);
  }
  return faces;
}

}  // namespace

FaceSelection select_faces(const Record& record, const Body& body) {
  const IndexSet& set = indices_of(record);
  check_indices(record, set, *body.mesh);
  if (set.ids.empty()) refuse_empty(record, body);
  if (set.kind == Indexed::nodes) {
    FaceSelection selection{faces_between(set, body), false};
    if (selection.faces.empty())
      refuse(record, fmt::format("no boundary face has all its corners among the {} in indices; the body spans {}",
                                 counted(static_cast<int>(set.ids.size()), "node"), bounds(body)));
    return selection;
  }
  check_sides(record, set, *body.mesh, body);
  return {Matcher(record, body, *body.mesh, true).match(set.ids), true};
}

FaceSelection select_faces_on(const Record& record, const Body& body, const Mesh& surface) {
  const IndexSet& set = indices_of(record);
  check_indices(record, set, surface);
  if (set.ids.empty()) refuse_empty(record, body);
  std::vector<int> cells = set.ids;
  if (set.kind == Indexed::nodes) {
    std::vector<bool> in(static_cast<std::size_t>(surface.point_count()), false);
    for (const int id : set.ids) in[static_cast<std::size_t>(id)] = true;
    cells.clear();
    for (int c = 0; c < surface.cell_count(); ++c) {
      const int* nodes = surface.cell(c);
      if (is_side(surface.kinds[static_cast<std::size_t>(c)], body) &&
          std::all_of(nodes, nodes + dimension(body.kind),
                      [&](int node) { return in[static_cast<std::size_t>(node)]; }))
        cells.push_back(c);
    }
    FaceSelection selection{Matcher(record, body, surface, false).match(cells, true), false};
    if (selection.faces.empty())
      refuse(record, fmt::format("no {} of mesh has all its corners among the nodes in indices", side_noun(body)));
    return selection;
  }
  check_sides(record, set, surface, body);
  return {Matcher(record, body, surface, false).match(cells), true};
}

}  // namespace msml::simulation
