// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts elements where their shapes meet a plane, curved ones in parts.
#include "operators/simulate/plane_cut.hpp"

#include <algorithm>
#include <cmath>

#include "operators/simulate/spots.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::simulation {
namespace {

constexpr double flat = 0.01;  // of the length of a chord
constexpr int most_halvings = 4;

Barycentric middle(const Barycentric& a, const Barycentric& b) {
  Barycentric m;
  for (std::size_t k = 0; k < 4; ++k) m[k] = 0.5 * (a[k] + b[k]);
  return m;
}

/// Where a simplex with quadratic edges lies: its shape stays in the hull of its corners and of a third point per edge,
/// 2 m - (a + b)/2 (the control points of Bezier's form).
PlaneSide side_of_simplex(std::span<const Vec3> corners, std::span<const Vec3> mids, const CuttingPlane& plane) {
  bool below = false, above = false;
  const auto look = [&](const Vec3& x) { (plane.distance(x) < 0 ? below : above) = true; };
  for (const Vec3& x : corners) look(x);
  for (std::size_t k = 0; k < mids.size(); ++k) {
    const auto& edge = fe::Simplex<3, 10>::edges[k];
    look(2 * mids[k] - 0.5 * (corners[static_cast<std::size_t>(edge[0])] + corners[static_cast<std::size_t>(edge[1])]));
  }
  return below && above ? PlaneSide::both : above ? PlaneSide::above : PlaneSide::below;
}

class Cutter {
 public:
  Cutter(const Mesh& mesh, int element, const CuttingPlane& plane, ElementCut& out)
      : mesh_(mesh), element_(element), plane_(plane), out_(out) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(element)];
    corners_ = static_cast<std::size_t>(corner_count(kind));
    if (node_count(kind) > corner_count(kind)) edges_ = static_cast<std::size_t>(node_count(kind)) - corners_;
  }

  void cut(const Part& part, int halvings) {
    std::array<Vec3, 4> x;
    std::array<Vec3, 6> mids;
    std::array<Barycentric, 6> between;
    for (std::size_t a = 0; a < corners_; ++a) x[a] = position(mesh_, element_, part[a]);
    bool curved = false;
    for (std::size_t k = 0; k < edges_; ++k) {
      const auto [i, j] = ends(k);
      between[k] = middle(part[i], part[j]);
      mids[k] = position(mesh_, element_, between[k]);
      curved = curved || (mids[k] - 0.5 * (x[i] + x[j])).norm() > flat * (x[j] - x[i]).norm();
    }
    const PlaneSide side = side_of_simplex({x.data(), corners_}, {mids.data(), edges_}, plane_);
    if (side == PlaneSide::above) out_.above.push_back(part);
    if (side != PlaneSide::both) return;
    if (curved && halvings > 0) return halve(part, between, halvings - 1);
    clip(part, x);
  }

 private:
  static std::array<std::size_t, 2> ends(std::size_t edge) {
    const auto& corners = fe::Simplex<3, 10>::edges[edge];
    return {static_cast<std::size_t>(corners[0]), static_cast<std::size_t>(corners[1])};
  }

  /// Cuts the parts at the corners, and of triangles and tetrahedra what is between them.
  void halve(const Part& part, const std::array<Barycentric, 6>& mid, int halvings) {
    for (std::size_t a = 0; a < corners_; ++a) {
      Part small = part;
      for (std::size_t k = 0; k < edges_; ++k) {
        const auto [i, j] = ends(k);
        if (i == a) small[j] = mid[k];
        if (j == a) small[i] = mid[k];
      }
      cut(small, halvings);
    }
    if (corners_ == 3) cut({mid[0], mid[1], mid[2], {}}, halvings);
    if (corners_ < 4) return;
    // The octahedron around the diagonal from the middle of 02 to that of 13.
    constexpr std::array<std::array<std::size_t, 2>, 4> around{{{0, 1}, {1, 5}, {5, 3}, {3, 0}}};
    for (const auto& [a, b] : around) cut({mid[2], mid[4], mid[a], mid[b]}, halvings);
  }

  void clip(const Part& part, const std::array<Vec3, 4>& x) {
    std::array<double, 4> d{};
    std::vector<std::size_t> below, above;
    for (std::size_t a = 0; a < corners_; ++a) {
      d[a] = plane_.distance(x[a]);
      (d[a] < 0 ? below : above).push_back(a);
    }
    if (below.empty()) out_.above.push_back(part);
    if (below.empty() || above.empty()) return;
    const auto crossing = [&](std::size_t m, std::size_t p) {
      const double t = d[m] / (d[m] - d[p]);
      Barycentric at;
      for (std::size_t k = 0; k < 4; ++k) at[k] = (1 - t) * part[m][k] + t * part[p][k];
      return at;
    };
    if (below.size() == 2 && above.size() == 2) return clip_wedge(part, below, above, crossing);
    // One corner is alone on its side: the simplex between it and the section.
    const bool up = above.size() == 1;
    const std::size_t alone = up ? above[0] : below[0];
    Part tip{part[alone]};
    Facet section;
    for (const std::size_t other : up ? below : above) {
      section.push_back(up ? crossing(other, alone) : crossing(alone, other));
      tip[section.size()] = section.back();
    }
    out_.section.push_back(section);
    if (!up) out_.above.push_back(part);
    (up ? out_.above : out_.missing).push_back(tip);
  }

  template <class Crossing>
  void clip_wedge(const Part& part, const std::vector<std::size_t>& m, const std::vector<std::size_t>& p,
                  const Crossing& crossing) {
    const Barycentric a = crossing(m[0], p[0]), b = crossing(m[1], p[0]), c = crossing(m[1], p[1]),
                      e = crossing(m[0], p[1]);
    out_.section.push_back({a, b, c});
    out_.section.push_back({a, c, e});
    // The wedge with the ends p0 a b and p1 e c.
    out_.above.push_back({part[p[0]], a, b, c});
    out_.above.push_back({part[p[0]], a, e, c});
    out_.above.push_back({part[p[0]], part[p[1]], e, c});
  }

  const Mesh& mesh_;
  int element_;
  const CuttingPlane& plane_;
  ElementCut& out_;
  std::size_t corners_ = 0, edges_ = 0;  ///< edges with a mid node
};

}  // namespace

double CuttingPlane::distance(const Vec3& x) const {
  const double d = normal.dot(x - point);
  return std::abs(d) < tolerance ? 0 : d;
}

PlaneSide side_of(const Mesh& mesh, int element, const CuttingPlane& plane) {
  const CellKind kind = mesh.kinds[static_cast<std::size_t>(element)];
  const auto corners = static_cast<std::size_t>(corner_count(kind)), nodes = static_cast<std::size_t>(node_count(kind));
  std::array<Vec3, 10> x;
  for (std::size_t a = 0; a < nodes; ++a) x[a] = mesh.points.row(mesh.cell(element)[a]).transpose();
  return side_of_simplex({x.data(), corners}, {x.data() + corners, nodes - corners}, plane);
}

ElementCut cut_element(const Mesh& mesh, int element, const CuttingPlane& plane) {
  ElementCut out;
  const Part whole{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  Cutter(mesh, element, plane, out).cut(whole, most_halvings);
  return out;
}

Vec3 position(const Mesh& mesh, int element, const Barycentric& at) {
  const std::vector<double> weights = shape_weights(mesh.kinds[static_cast<std::size_t>(element)], at);
  Vec3 x = Vec3::Zero();
  for (std::size_t a = 0; a < weights.size(); ++a) x += weights[a] * mesh.points.row(mesh.cell(element)[a]).transpose();
  return x;
}

}  // namespace msml::simulation
