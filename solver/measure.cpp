// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation measures, stresses and strains of states.
#include "solver/measure.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "solver/elements/region_laws.hpp"
#include "solver/materials/polar.hpp"

namespace msml::fe {
namespace {

Mat3 at(const Tensor<Lanes>& a, int lane) {
  Mat3 m;
  for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = a.c[k][lane];
  return m;
}

/// xx yy zz xy yz xz.
void add_six(const Tensor<Lanes>& a, int lane, double weight, double* out) {
  constexpr int place[6] = {0, 4, 8, 1, 5, 2};
  for (int k = 0; k < 6; ++k) out[k] += weight * a.c[place[k]][lane];
}

/// Volume, area or length of the cell between its corners, up to a factor that all cells of a kind share.
double corner_volume(const Mesh& mesh, int cell) {
  const int* nodes = mesh.cell(cell);
  const int dimension = msml::dimension(mesh.kinds[static_cast<std::size_t>(cell)]);
  Mat3 edges = Mat3::Identity();
  for (int d = 0; d < dimension; ++d)
    edges.col(d) = (mesh.points.row(nodes[d + 1]) - mesh.points.row(nodes[0])).transpose();
  return std::abs(edges.topLeftCorner(dimension, dimension).determinant());
}

void measure_element(const ElementPoints& points, const Law& law, std::size_t cell, ElementResults& results) {
  Measures measures;
  law.measure({&points.gradient, 1}, {&measures, 1});
  const Deformation d = deformation(points);
  for (int q = 0; q < points.count; ++q) {
    const double share = points.weight[q] / d.volume;
    add_six(measures.cauchy, q, share, results.cauchy.data() + 6 * cell);
    add_six(measures.strain, q, share, results.strain.data() + 6 * cell);
    results.energy_density[cell] += share * measures.energy[q];
  }
  results.J[cell] = d.smallest_J;
  results.rotation[cell] = d.largest_rotation;
}

}  // namespace

double rotation_angle(const Mat3& R) {
  const Vec3 axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(axis.norm(), R.trace() - 1) * 180 / std::numbers::pi;
}

Deformation deformation(const ElementPoints& points) {
  Deformation d;
  Tensor<Lanes> F = points.gradient;
  for (int i = 0; i < 3; ++i) F(i, i) += 1.0;
  const Tensor<Lanes> R = polar_rotation(F);
  for (int q = 0; q < points.count; ++q) {
    const Mat3 f = at(F, q), r = at(R, q);
    const double J = f.determinant();
    d.volume += points.weight[q];
    d.deformed_volume += points.weight[q] * J;
    d.smallest_J = std::min(d.smallest_J, J);
    d.largest_rotation = std::max(d.largest_rotation, rotation_angle(r));
    const Mat3 U = r.transpose() * f;
    const Eigen::SelfAdjointEigenSolver<Mat3> stretches(0.5 * (U + U.transpose()), Eigen::EigenvaluesOnly);
    d.largest_strain = std::max(d.largest_strain, (stretches.eigenvalues().array() - 1).abs().maxCoeff());
  }
  return d;
}

ElementResults element_results(const Model& model, const State& state) {
  const std::unique_ptr<Elements> elements = make_elements(model);
  const Numbering& numbering = elements->numbering();
  const std::size_t cells = model.mesh->kinds.size();
  ElementResults results;
  results.cauchy.assign(6 * cells, 0);
  results.strain.assign(6 * cells, 0);
  results.energy_density.assign(cells, 0);
  results.J.assign(cells, 0);
  results.rotation.assign(cells, 0);
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  tbb::task_arena arena(std::min(model.settings.threads, static_cast<int>(allowed)));
  arena.execute([&] {
    const std::vector<ElementPoints> points = elements->points(to_vector(numbering, state.displacement));
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t e) {
      const Region& region = model.regions[static_cast<std::size_t>(numbering.region_of[e])];
      const std::span<const Vec3> places(points[e].place, static_cast<std::size_t>(points[e].count));
      const auto law = law_of_points(model, region, numbering.elements[e], places);
      measure_element(points[e], *law, static_cast<std::size_t>(numbering.elements[e]), results);
    });
  });
  return results;
}

std::vector<double> recover_at_nodes(const Model& model, const std::vector<double>& values, int components) {
  const Mesh& mesh = *model.mesh;
  const std::size_t points = static_cast<std::size_t>(mesh.point_count()), width = static_cast<std::size_t>(components);
  std::vector<double> mean(points * width, 0);
  std::vector<int> regions_at(points, 0);
  for (const Region& region : model.regions) {
    std::vector<double> sums(points * width, 0), weights(points, 0);
    for (const int e : region.elements) {
      const int* nodes = mesh.cell(e);
      const double volume = corner_volume(mesh, e);
      for (int a = 0; a < node_count(mesh.kinds[static_cast<std::size_t>(e)]); ++a) {
        const std::size_t n = static_cast<std::size_t>(nodes[a]);
        weights[n] += volume;
        for (std::size_t c = 0; c < width; ++c)
          sums[n * width + c] += volume * values[static_cast<std::size_t>(e) * width + c];
      }
    }
    for (std::size_t n = 0; n < points; ++n) {
      if (!(weights[n] > 0)) continue;
      ++regions_at[n];
      for (std::size_t c = 0; c < width; ++c) mean[n * width + c] += sums[n * width + c] / weights[n];
    }
  }
  for (std::size_t n = 0; n < points; ++n)
    for (std::size_t c = 0; c < width && regions_at[n] > 1; ++c) mean[n * width + c] /= regions_at[n];
  return mean;
}

}  // namespace msml::fe
