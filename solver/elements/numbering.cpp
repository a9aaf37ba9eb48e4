// SPDX-License-Identifier: GPL-3.0-or-later
// Orders elements and nodes along a space-filling curve.
#include <algorithm>
#include <cstdint>

#include "solver/elements/assembly.hpp"
#include "solver/elements/inlaid_elements.hpp"

namespace msml::fe {
namespace {

/// Interleaves three 20-bit integers: position on the Z-order curve (Morton 1966).
std::uint64_t interleave(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < 20; ++bit)
    code |= (std::uint64_t(x >> bit & 1u) << (3 * bit)) | (std::uint64_t(y >> bit & 1u) << (3 * bit + 1)) |
            (std::uint64_t(z >> bit & 1u) << (3 * bit + 2));
  return code;
}

class Curve {
 public:
  explicit Curve(const Points& points)
      : low_(points.colwise().minCoeff()),
        scale_(((1 << 20) - 1) / std::max((points.colwise().maxCoeff() - low_).maxCoeff(), 1e-300)) {}
  std::uint64_t at(const Eigen::RowVector3d& x) const {
    const Eigen::RowVector3d s = (x - low_) * scale_;
    return interleave(static_cast<std::uint32_t>(s[0]), static_cast<std::uint32_t>(s[1]),
                      static_cast<std::uint32_t>(s[2]));
  }

 private:
  Eigen::RowVector3d low_;
  double scale_;
};

struct Keyed {
  int region;
  std::uint64_t code;
  int id;
  auto operator<=>(const Keyed&) const = default;
};

void order_elements(const Model& model, const Curve& curve, Numbering& numbering) {
  const Mesh& mesh = *model.mesh;
  std::vector<Keyed> keys;
  for (std::size_t r = 0; r < model.regions.size(); ++r)
    for (const int e : model.regions[r].elements) {
      Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
      const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(e)]);
      for (int a = 0; a < corners; ++a) centre += mesh.points.row(mesh.cell(e)[a]) / corners;
      keys.push_back({static_cast<int>(r), curve.at(centre), e});
    }
  std::sort(keys.begin(), keys.end());
  numbering.elements.reserve(keys.size());
  numbering.region_of.reserve(keys.size());
  for (const Keyed& key : keys) {
    numbering.elements.push_back(key.id);
    numbering.region_of.push_back(key.region);
  }
}

/// Nodes with a mass of their own, and the pairs that springs join.
void add_loose_parts(const Model& model, Numbering& numbering) {
  for (const PointMass& mass : model.point_masses) {
    int& number = numbering.number_of[static_cast<std::size_t>(mass.node)];
    if (number >= 0) continue;
    number = numbering.nodes();
    numbering.node_of.push_back(mass.node);
  }
  for (const Step& step : model.steps)
    for (const Spring& spring : step.springs) {
      if (spring.second < 0) continue;
      const int first = numbering.number_of[static_cast<std::size_t>(spring.first)];
      const int second = numbering.number_of[static_cast<std::size_t>(spring.second)];
      if (first >= 0 && second >= 0) numbering.links.push_back({first, second});
    }
}

/// One additional node for each corner of each region, region after region in the order of the corners.
void add_pressure_nodes(Numbering& numbering, int nodes) {
  const std::size_t elements = numbering.elements.size();
  const auto corner = [&](std::size_t e, int c) {
    return static_cast<std::size_t>(
        numbering.element_nodes[e * static_cast<std::size_t>(nodes) + static_cast<std::size_t>(c)]);
  };
  for (std::size_t first = 0, last = 0; first < elements; first = last) {
    std::vector<int> extra(numbering.node_of.size(), -1);
    for (last = first; last < elements && numbering.region_of[last] == numbering.region_of[first]; ++last)
      for (int c = 0; c < 4; ++c) extra[corner(last, c)] = 0;
    for (std::size_t n = 0; n < extra.size(); ++n) {
      if (extra[n] < 0) continue;
      extra[n] = numbering.nodes();
      numbering.pressure_of.push_back(numbering.node_of[n]);
    }
    for (std::size_t e = first; e < last; ++e)
      for (int c = 0; c < 4; ++c) numbering.pressure_nodes.push_back(extra[corner(e, c)]);
  }
}

}  // namespace

Numbering number(const Model& model) {
  const Mesh& mesh = *model.mesh;
  const Curve curve(mesh.points);
  Numbering numbering;
  numbering.mesh = model.mesh;
  order_elements(model, curve, numbering);
  numbering.kind = element_kind(model);
  numbering.components = components(model);
  numbering.scalar = is_scalar(model);
  const int nodes = node_count(numbering.kind);
  numbering.number_of.assign(static_cast<std::size_t>(mesh.point_count()), -1);
  std::vector<Keyed> keys;
  for (const int e : numbering.elements)
    for (int a = 0; a < nodes; ++a) {
      const int point = mesh.cell(e)[a];
      if (numbering.number_of[static_cast<std::size_t>(point)] == 0) continue;
      numbering.number_of[static_cast<std::size_t>(point)] = 0;
      keys.push_back({0, curve.at(mesh.points.row(point)), point});
    }
  std::sort(keys.begin(), keys.end());
  numbering.node_of.reserve(keys.size());
  for (const Keyed& key : keys) {
    numbering.number_of[static_cast<std::size_t>(key.id)] = numbering.nodes();
    numbering.node_of.push_back(key.id);
  }
  numbering.element_nodes.reserve(numbering.elements.size() * static_cast<std::size_t>(nodes));
  for (const int e : numbering.elements)
    for (int a = 0; a < nodes; ++a)
      numbering.element_nodes.push_back(numbering.number_of[static_cast<std::size_t>(mesh.cell(e)[a])]);
  add_loose_parts(model, numbering);
  const auto links = inlay_links(model, numbering);
  numbering.links.insert(numbering.links.end(), links.begin(), links.end());
  if (model.formulation == Formulation::mixed) add_pressure_nodes(numbering, nodes);
  return numbering;
}

std::vector<std::array<int, 2>> edge_ends(const Numbering& numbering) {
  constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};  // of line3 the first, of tri6 three
  const int nodes = node_count(numbering.kind);
  const int mids = nodes == 10 ? 6 : nodes == 6 ? 3 : numbering.kind == CellKind::line3 ? 1 : 0;
  if (mids == 0) return {};
  std::vector<std::array<int, 2>> ends(static_cast<std::size_t>(numbering.nodes()), {-1, -1});
  for (std::size_t first = 0; first < numbering.element_nodes.size(); first += static_cast<std::size_t>(nodes)) {
    const int* element = numbering.element_nodes.data() + first;
    for (int m = 0; m < mids; ++m)
      ends[static_cast<std::size_t>(element[nodes - mids + m])] = {element[edges[m][0]], element[edges[m][1]]};
  }
  return ends;
}

std::size_t Numbering::bytes() const {
  const std::size_t integers = elements.size() + region_of.size() + node_of.size() + number_of.size() +
                               element_nodes.size() + 2 * links.size() + pressure_of.size() + pressure_nodes.size();
  return integers * sizeof(int);
}

Points to_points(const Numbering& numbering, const Vector& values) {
  Points points = Points::Zero(static_cast<Eigen::Index>(numbering.number_of.size()), 3);
  for (int n = 0; n < numbering.body_nodes(); ++n)
    points.row(numbering.node_of[static_cast<std::size_t>(n)]) = values.segment<3>(3 * n).transpose();
  return points;
}

Vector to_vector(const Numbering& numbering, const Points& values) {
  Vector vector = Vector::Zero(3 * numbering.nodes());
  for (int n = 0; n < numbering.body_nodes(); ++n)
    vector.segment<3>(3 * n) = values.row(numbering.node_of[static_cast<std::size_t>(n)]).transpose();
  return vector;
}

std::vector<char> pressure_mask(const Numbering& numbering, bool all) {
  std::vector<char> mask(static_cast<std::size_t>(3 * numbering.nodes()), 0);
  for (std::size_t k = static_cast<std::size_t>(3 * numbering.body_nodes()); k < mask.size(); ++k)
    mask[k] = all || k % 3 > 0;
  return mask;
}

std::vector<double> to_pressures(const Numbering& numbering, const Vector& values) {
  if (!numbering.mixed()) return {};
  constexpr int nodes = 10, edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  std::vector<double> pressures(numbering.number_of.size(), 0);
  const auto at = [&](std::size_t element, int a) -> double& {
    const int node = numbering.element_nodes[nodes * element + static_cast<std::size_t>(a)];
    return pressures[static_cast<std::size_t>(numbering.node_of[static_cast<std::size_t>(node)])];
  };
  std::vector<int> regions(pressures.size(), 0);
  const std::vector<double> own = to_corner_pressures(numbering, values);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto point = static_cast<std::size_t>(numbering.pressure_of[k]);
    const int before = regions[point]++;
    pressures[point] += (own[k] - pressures[point]) / (before + 1);
  }
  for (std::size_t e = 0; e < numbering.elements.size(); ++e)
    for (int m = 0; m < 6; ++m) at(e, 4 + m) = 0.5 * (at(e, edges[m][0]) + at(e, edges[m][1]));
  return pressures;
}

std::vector<double> to_corner_pressures(const Numbering& numbering, const Vector& values) {
  std::vector<double> pressures;
  for (int n = numbering.body_nodes(); n < numbering.nodes(); ++n)
    pressures.push_back(-numbering.pressure_scale * values[3 * n]);
  return pressures;
}

std::array<double, 10> element_pressures(const Numbering& numbering, std::size_t element,
                                         const std::vector<double>& corner_pressures) {
  constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  std::array<double, 10> pressures{};
  for (std::size_t c = 0; c < 4; ++c) {
    const int node = numbering.pressure_nodes[4 * element + c] - numbering.body_nodes();
    pressures[c] = corner_pressures[static_cast<std::size_t>(node)];
  }
  for (std::size_t m = 0; m < 6; ++m) pressures[4 + m] = 0.5 * (pressures[edges[m][0]] + pressures[edges[m][1]]);
  return pressures;
}

void put_corner_pressures(const Numbering& numbering, const std::vector<double>& pressures, Vector& values) {
  for (std::size_t k = 0; k < pressures.size(); ++k)
    values[3 * (numbering.body_nodes() + static_cast<int>(k))] = -pressures[k] / numbering.pressure_scale;
}

}  // namespace msml::fe
