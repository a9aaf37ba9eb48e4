// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of cells recovered at nodes: the linear field that fits the cells around a corner best (least squares at their
// centres), at a mid node the mean of the fits of both ends of its edge. Source: Zienkiewicz and Zhu 1992, the
// superconvergent patch recovery, doi 10.1002/nme.1620330702.
#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "solver/elements/shapes.hpp"
#include "solver/model.hpp"

namespace msml::fe {
namespace {

/// The cells of one region around each node of which they are corners: cells[start[n] .. start[n + 1]).
struct Around {
  std::vector<std::size_t> start;
  std::vector<int> cells;
  std::span<const int> at(int node) const {
    const auto n = static_cast<std::size_t>(node);
    return {cells.data() + start[n], start[n + 1] - start[n]};
  }
};

int corners_of(const Mesh& mesh, int cell) { return dimension(mesh.kinds[static_cast<std::size_t>(cell)]) + 1; }

Around cells_around(const Mesh& mesh, const std::vector<int>& elements) {
  Around around;
  around.start.assign(static_cast<std::size_t>(mesh.point_count()) + 1, 0);
  for (const int e : elements)
    for (int a = 0; a < corners_of(mesh, e); ++a) ++around.start[static_cast<std::size_t>(mesh.cell(e)[a]) + 1];
  for (std::size_t n = 1; n < around.start.size(); ++n) around.start[n] += around.start[n - 1];
  around.cells.resize(around.start.back());
  std::vector<std::size_t> next(around.start.begin(), around.start.end() - 1);
  for (const int e : elements)
    for (int a = 0; a < corners_of(mesh, e); ++a) around.cells[next[static_cast<std::size_t>(mesh.cell(e)[a])]++] = e;
  return around;
}

/// The cells that the fit at a corner takes: those around it, and where these are few, those around them.
std::vector<int> patch_of(const Mesh& mesh, const Around& around, int node) {
  const std::span<const int> own = around.at(node);
  std::vector<int> patch(own.begin(), own.end());
  const int corners = corners_of(mesh, own.front());
  // Twice as many values as coefficients leave no gradient to chance.
  if (own.size() >= static_cast<std::size_t>(2 * corners)) return patch;
  for (const int e : own)
    for (int a = 0; a < corners; ++a) {
      const std::span<const int> more = around.at(mesh.cell(e)[a]);
      patch.insert(patch.end(), more.begin(), more.end());
    }
  std::sort(patch.begin(), patch.end());
  patch.erase(std::unique(patch.begin(), patch.end()), patch.end());
  return patch;
}

Vec3 centre_of(const Mesh& mesh, int cell) {
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < corners_of(mesh, cell); ++a) sum += mesh.points.row(mesh.cell(cell)[a]).transpose();
  return sum / corners_of(mesh, cell);
}

/// Value at a corner and gradient of the best linear fit: 4 x components.
using Fit = Eigen::Matrix<double, 4, Eigen::Dynamic>;

Fit fit_at(const Mesh& mesh, const std::vector<int>& patch, int node, const std::vector<double>& values, int width) {
  const auto row = [&](int e) {
    return Eigen::Map<const Eigen::RowVectorXd>(values.data() + static_cast<std::ptrdiff_t>(e) * width, width);
  };
  const Vec3 origin = mesh.points.row(node).transpose();
  double size = 0;
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(width);
  for (const int e : patch) {
    size = std::max(size, (centre_of(mesh, e) - origin).norm());
    mean += row(e) / static_cast<double>(patch.size());
  }
  if (size == 0) size = 1;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Fit right = Fit::Zero(4, width);
  for (const int e : patch) {
    Eigen::Vector4d basis;
    basis << 1, (centre_of(mesh, e) - origin) / size;
    normal += basis * basis.transpose();
    right += basis * (row(e) - mean);
  }
  // Where centres lie in a plane or on a line, nothing is known across: the smallest gradient, here none, is taken.
  normal.diagonal().tail<3>().array() += 1e-9 * static_cast<double>(patch.size());
  Fit fit = normal.ldlt().solve(right);
  fit.row(0) += mean;
  fit.bottomRows<3>() /= size;
  return fit;
}

/// Of one region: nodal values, 0 at nodes that are not of it; counts nodes that are.
std::vector<double> recovered_in(const Mesh& mesh, const std::vector<int>& elements, const std::vector<double>& values,
                                 int width, std::vector<int>& regions_at) {
  const Around around = cells_around(mesh, elements);
  const auto points = static_cast<std::size_t>(mesh.point_count());
  std::vector<Fit> fits(points);
  tbb::parallel_for(0, mesh.point_count(), [&](int n) {
    if (!around.at(n).empty())
      fits[static_cast<std::size_t>(n)] = fit_at(mesh, patch_of(mesh, around, n), n, values, width);
  });
  std::vector<double> nodal(points * static_cast<std::size_t>(width), 0);
  std::vector<char> seen(points, 0);
  const auto set = [&](int n, const Eigen::RowVectorXd& value) {
    const auto at = static_cast<std::size_t>(n);
    if (seen[at] != 0) return;
    seen[at] = 1;
    ++regions_at[at];
    Eigen::Map<Eigen::RowVectorXd>(nodal.data() + static_cast<std::ptrdiff_t>(n) * width, width) = value;
  };
  for (const int e : elements) {
    const int* nodes = mesh.cell(e);
    const int corners = corners_of(mesh, e), count = node_count(mesh.kinds[static_cast<std::size_t>(e)]);
    const auto value = [&](int corner, int n) -> Eigen::RowVectorXd {
      const Fit& fit = fits[static_cast<std::size_t>(corner)];
      return fit.row(0) + (mesh.points.row(n) - mesh.points.row(corner)) * fit.bottomRows<3>();
    };
    for (int a = 0; a < corners; ++a) set(nodes[a], value(nodes[a], nodes[a]));
    for (int a = corners; a < count; ++a) {
      const auto [i, j] = Simplex<3, 10>::edges[static_cast<std::size_t>(a - corners)];
      set(nodes[a], 0.5 * (value(nodes[i], nodes[a]) + value(nodes[j], nodes[a])));
    }
  }
  return nodal;
}

}  // namespace

std::vector<double> recover_at_nodes(const Model& model, const std::vector<double>& values, int components) {
  const Mesh& mesh = *model.mesh;
  const std::size_t points = static_cast<std::size_t>(mesh.point_count()), width = static_cast<std::size_t>(components);
  std::vector<double> mean(points * width, 0);
  std::vector<int> regions_at(points, 0);
  for (const Region& region : model.regions) {
    const std::vector<double> nodal = recovered_in(mesh, region.elements, values, components, regions_at);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += nodal[k];
  }
  for (std::size_t n = 0; n < points; ++n)
    for (std::size_t c = 0; c < width && regions_at[n] > 1; ++c) mean[n * width + c] /= regions_at[n];
  return mean;
}

}  // namespace msml::fe
