// SPDX-License-Identifier: GPL-3.0-or-later
// Sides and places of a body.
#include "operators/simulate/body.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "operators/simulate/records.hpp"

namespace msml::simulation {

Body make_body(std::shared_ptr<const Mesh> mesh, CellKind kind) {
  Body body{.mesh = std::move(mesh), .kind = kind};
  body.solid.assign(static_cast<std::size_t>(body.mesh->point_count()), false);
  for (int c = 0; c < body.mesh->cell_count(); ++c) {
    if (body.mesh->kinds[static_cast<std::size_t>(c)] != kind) continue;
    body.elements.push_back(c);
    for (int i = 0; i < node_count(kind); ++i) body.solid[static_cast<std::size_t>(body.mesh->cell(c)[i])] = true;
  }
  return body;
}

std::string bounds(const Body& body) {
  Eigen::AlignedBox3d box;
  for (int i = 0; i < body.mesh->point_count(); ++i)
    if (body.elements.empty() || body.solid[static_cast<std::size_t>(i)])
      box.extend(Vec3(body.mesh->points.row(i).transpose()));
  return box.isEmpty() ? "nothing" : place(box.min()) + " to " + place(box.max());
}

double diagonal(const Mesh& mesh) {
  if (mesh.point_count() == 0) return 0;
  return (mesh.points.colwise().maxCoeff() - mesh.points.colwise().minCoeff()).norm();
}

Vec3 centroid(const Mesh& mesh, int cell) {
  const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(cell)]);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < corners; ++i) sum += mesh.points.row(mesh.cell(cell)[i]).transpose();
  return sum / corners;
}

bool same_mesh(const Mesh& a, const Mesh& b) {
  return &a == &b ||
         (a.kinds == b.kinds && a.nodes == b.nodes && a.points.rows() == b.points.rows() && a.points == b.points);
}

FaceTable::FaceTable(const Body& body) {
  if (dimension(body.kind) == 0) return;  // particles have no faces
  std::vector<Entry> all;
  const int sides = side_count(body.kind), count = corner_count(side_kind(body.kind));
  all.reserve(static_cast<std::size_t>(sides) * body.elements.size());
  for (const int element : body.elements)
    for (int local = 0; local < sides; ++local) {
      const auto side = side_nodes(body.kind, local);
      const int* nodes = body.mesh->cell(element);
      SideCorners corners{-1, -1, -1};
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) corners[i] = nodes[side[i]];
      std::sort(corners.begin(), corners.end());
      all.push_back({corners, {element, local}});
    }
  std::stable_sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) { return a.corners < b.corners; });
  for (Entry& entry : all) {
    if (!entries_.empty() && entries_.back().corners == entry.corners)
      entries_.back().shared = true;
    else
      entries_.push_back(entry);
  }
  for (const Entry& entry : entries_)
    if (!entry.shared) boundary_.push_back(entry.face);
  std::sort(boundary_.begin(), boundary_.end(), [](const fe::Face& a, const fe::Face& b) {
    return a.element != b.element ? a.element < b.element : a.local < b.local;
  });
}

const FaceTable::Entry* FaceTable::find(SideCorners corners) const {
  std::sort(corners.begin(), corners.end());
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), corners,
                                   [](const Entry& entry, const auto& wanted) { return entry.corners < wanted; });
  return at != entries_.end() && at->corners == corners ? &*at : nullptr;
}

fe::Face FaceTable::boundary(SideCorners corners) const {
  const Entry* entry = find(corners);
  return entry != nullptr && !entry->shared ? entry->face : fe::Face{};
}

bool FaceTable::inside(SideCorners corners) const {
  const Entry* entry = find(corners);
  return entry != nullptr && entry->shared;
}

std::vector<int> face_nodes(const Mesh& mesh, const fe::Face& face) {
  std::vector<int> nodes;
  for (const int local : side_nodes(mesh.kinds[static_cast<std::size_t>(face.element)], face.local))
    nodes.push_back(mesh.cell(face.element)[local]);
  return nodes;
}

PlaceTable::PlaceTable(const Body& body) : mesh_(*body.mesh) {
  const double length = diagonal(mesh_);
  size_ = length > 0 ? 1e-6 * length : 1;
  if (mesh_.point_count() > 0) origin_ = mesh_.points.colwise().minCoeff().transpose();
  for (int i = 0; i < mesh_.point_count(); ++i)
    if (body.solid[static_cast<std::size_t>(i)]) boxes_[box_of(mesh_.points.row(i).transpose())].push_back(i);
}

PlaceTable::Box PlaceTable::box_of(const Vec3& x) const {
  Box box{};
  for (int k = 0; k < 3; ++k) {
    // A place far outside the mesh matches nothing; the bound keeps the conversion defined.
    const double scaled = std::clamp(std::floor((x[k] - origin_[k]) / size_), -1e12, 1e12);
    box[static_cast<std::size_t>(k)] = static_cast<long long>(scaled);
  }
  return box;
}

std::vector<int> PlaceTable::at(const Vec3& x) const {
  std::vector<int> found;
  const Box centre = box_of(x);
  for (int n = 0; n < 27; ++n) {
    const auto box = boxes_.find({centre[0] + n % 3 - 1, centre[1] + n / 3 % 3 - 1, centre[2] + n / 9 - 1});
    if (box == boxes_.end()) continue;
    for (const int id : box->second)
      if ((mesh_.points.row(id).transpose() - x).norm() <= size_) found.push_back(id);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace msml::simulation
