// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation measures, stresses and strains of states.
#include "solver/measure.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
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

void add_nine(const Mat3& a, double weight, double* out) {
  for (int k = 0; k < 9; ++k) out[k] += weight * a(k / 3, k % 3);
}

void add_six(const Mat3& a, double weight, double* out) {
  constexpr int rows[6] = {0, 1, 2, 0, 1, 0}, columns[6] = {0, 1, 2, 1, 2, 2};
  for (int k = 0; k < 6; ++k) out[k] += weight * 0.5 * (a(rows[k], columns[k]) + a(columns[k], rows[k]));
}

/// Room for what is asked for, zero.
ElementResults empty_results(const ElementRequest& request, std::size_t cells) {
  ElementResults results;
  if (request.law) {
    results.cauchy.assign(6 * cells, 0);
    results.strain.assign(6 * cells, 0);
    results.energy_density.assign(cells, 0);
  }
  if (request.J) results.J.assign(cells, 0);
  if (request.rotation) results.rotation.assign(cells, 0);
  if (request.tensors) {
    results.deformation_gradient.assign(9 * cells, 0);
    results.first_piola.assign(9 * cells, 0);
    results.second_piola.assign(6 * cells, 0);
    results.green_lagrange.assign(6 * cells, 0);
  }
  if (request.fibre_stretch) results.fibre_stretch.assign(cells, 1);
  if (request.stress_moments) results.stress_moments.assign(27 * cells, 0);
  if (request.volume) {
    results.volume.assign(cells, 0);
    results.deformed_volume.assign(cells, 0);
  }
  return results;
}

double volume_of(const ElementPoints& points) {
  double volume = 0;
  for (int q = 0; q < points.count; ++q) volume += points.weight[q];
  return volume;
}

/// Entry (i, j) of a symmetric tensor among its six components.
constexpr int place_of_six[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};

/// Stresses from what viscoelastic points remember, S: Cauchy F S F^T / J and first Piola F S, under small strain all
/// S.
void take_history(const ElementPoints& points, const double* stress, bool small_strain, Tensor<Lanes>* cauchy,
                  Tensor<Lanes>* P) {
  for (int q = 0; q < points.count; ++q) {
    Mat3 S;
    for (int k = 0; k < 9; ++k) S(k / 3, k % 3) = stress[6 * q + place_of_six[k]];
    const Mat3 F = small_strain ? Mat3(Mat3::Identity()) : Mat3(Mat3::Identity() + at(points.gradient, q));
    const Mat3 first = F * S, sigma = first * F.transpose() / F.determinant();
    for (int k = 0; k < 9; ++k) {
      if (cauchy) cauchy->c[k][q] = sigma(k / 3, k % 3);
      if (P) P->c[k][q] = first(k / 3, k % 3);
    }
  }
}

/// The measures of a law that was taken apart: W = rest + p^2/(2 k), stress of rest and p dg/dF.
Measures measure_split(const ElementPoints& points, const Split& split) {
  Measures sum, volume;
  split.rest->measure({&points.gradient, 1}, {&sum, 1});
  split.constraint->measure({&points.gradient, 1}, {&volume, 1});
  for (int k = 0; k < 9; ++k) sum.cauchy.c[k] += points.volume_stress * volume.cauchy.c[k];
  sum.energy += points.volume_stress * points.volume_stress * (0.5 / split.modulus);
  return sum;
}

bool splits(Formulation formulation) { return formulation == Formulation::mixed || formulation == Formulation::fbar; }

/// How the stress at the points of an element comes about. `history` is null where nothing is remembered.
struct Origin {
  const Law& law;
  Formulation formulation;
  const double* history;
  const double* energy;  ///< stored, of remembered points; null where it is not known
};

void measure_law(const ElementPoints& points, const Origin& origin, std::size_t cell, ElementResults& results) {
  Measures measures;
  if (splits(origin.formulation))
    measures = measure_split(points, origin.law.split().value());
  else
    origin.law.measure({&points.gradient, 1}, {&measures, 1});
  if (origin.history) take_history(points, origin.history, origin.law.small_strain(), &measures.cauchy, nullptr);
  const double volume = volume_of(points);
  for (int q = 0; q < points.count; ++q) {
    const double share = points.weight[q] / volume;
    add_six(measures.cauchy, q, share, results.cauchy.data() + 6 * cell);
    add_six(measures.strain, q, share, results.strain.data() + 6 * cell);
    results.energy_density[cell] += share * (origin.energy ? origin.energy[q] : measures.energy[q]);
  }
}

/// First Piola stress at the points.
Tensor<Lanes> first_piola(const ElementPoints& points, const Law& law, Formulation formulation) {
  Response response;
  if (!splits(formulation)) {
    law.evaluate(Want::stress, {&points.gradient, 1}, {&response, 1});
    return response.P;
  }
  const Split split = law.split().value();
  split.rest->evaluate(Want::stress, {&points.gradient, 1}, {&response, 1});
  Tensor<Lanes> P = response.P;
  split.constraint->evaluate(Want::stress, {&points.gradient, 1}, {&response, 1});
  for (int k = 0; k < 9; ++k) P.c[k] += points.volume_stress * response.P.c[k];
  return P;
}

void measure_tensors(const ElementPoints& points, const Origin& origin, std::size_t cell, ElementResults& results) {
  Tensor<Lanes> stress = first_piola(points, origin.law, origin.formulation);
  if (origin.history) take_history(points, origin.history, origin.law.small_strain(), nullptr, &stress);
  const double volume = volume_of(points);
  for (int q = 0; q < points.count; ++q) {
    const double share = points.weight[q] / volume;
    const Mat3 H = at(points.gradient, q), F = Mat3::Identity() + H, P = at(stress, q);
    add_nine(F, share, results.deformation_gradient.data() + 9 * cell);
    add_nine(P, share, results.first_piola.data() + 9 * cell);
    add_six(0.5 * (H + H.transpose() + H.transpose() * H), share, results.green_lagrange.data() + 6 * cell);
    if (origin.law.small_strain())
      add_six(P, share, results.second_piola.data() + 6 * cell);  // to first order all stresses are one
    else if (F.determinant() != 0)
      add_six(Mat3(F.inverse() * P), share, results.second_piola.data() + 6 * cell);
  }
}

void measure_moments(const ElementPoints& points, const Origin& origin, std::size_t cell, ElementResults& results) {
  Tensor<Lanes> stress = first_piola(points, origin.law, origin.formulation);
  if (origin.history) take_history(points, origin.history, origin.law.small_strain(), nullptr, &stress);
  Vec3 middle = Vec3::Zero();
  for (int q = 0; q < points.count; ++q) middle += points.weight[q] / volume_of(points) * points.place[q];
  for (int q = 0; q < points.count; ++q) {
    Vec3 arm = points.place[q] - middle;
    if (!origin.law.small_strain()) arm += at(points.gradient, q) * arm;
    for (std::size_t j = 0; j < 3; ++j)
      add_nine(at(stress, q), points.weight[q] * arm[static_cast<Eigen::Index>(j)],
               results.stress_moments.data() + 27 * cell + 9 * j);
  }
}

double smallest_J(const ElementPoints& points) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int q = 0; q < points.count; ++q)
    smallest = std::min(smallest, (Mat3::Identity() + at(points.gradient, q)).determinant());
  return smallest;
}

/// Mean of |F g| over the points.
double fibre_stretch(const ElementPoints& points, const Law& law) {
  const auto fibre = law.fibre();
  if (!fibre) return 1;
  double sum = 0;
  for (int q = 0; q < points.count; ++q) {
    const Vec3 g((*fibre)[0][q], (*fibre)[1][q], (*fibre)[2][q]);
    sum += points.weight[q] * (g + at(points.gradient, q) * g).norm();
  }
  return sum / volume_of(points);
}

void measure_volume(const ElementPoints& points, bool scalar, std::size_t cell, ElementResults& results) {
  results.volume[cell] = volume_of(points);
  for (int q = 0; q < points.count; ++q)
    results.deformed_volume[cell] +=
        points.weight[q] * (scalar ? 1 : (Mat3::Identity() + at(points.gradient, q)).determinant());
}

void measure_element(const ElementPoints& points, const Origin& origin, std::size_t cell, const ElementRequest& request,
                     ElementResults& results) {
  const bool scalar = origin.law.components() == 1;
  if (request.law) measure_law(points, origin, cell, results);
  if (request.tensors) measure_tensors(points, origin, cell, results);
  if (request.J) results.J[cell] = scalar ? 1 : smallest_J(points);
  if (request.fibre_stretch) results.fibre_stretch[cell] = fibre_stretch(points, origin.law);
  if (request.stress_moments) measure_moments(points, origin, cell, results);
  if (request.volume) measure_volume(points, scalar, cell, results);
  if (request.rotation) results.rotation[cell] = deformation(points, scalar).largest_rotation;
}

/// Told the place of an element in the numbering and what its points are, from several threads.
using StateVisitor = std::function<void(const Numbering&, std::size_t element, const ElementPoints&)>;

void visit_state(const Model& model, const State& state, const StateVisitor& visit) {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  tbb::task_arena arena(std::min(model.settings.threads, static_cast<int>(allowed)));
  arena.execute([&] {
    const std::shared_ptr<const Elements> elements = state.elements ? state.elements : make_elements(model);
    const Numbering& numbering = elements->numbering();
    Vector u = to_vector(numbering, state.displacement);
    put_corner_pressures(numbering, state.corner_pressure, u);
    elements->visit_points(u, [&](std::size_t e, const ElementPoints& points) { visit(numbering, e, points); });
  });
}

}  // namespace

double rotation_angle(const Mat3& R) {
  const Vec3 axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(axis.norm(), R.trace() - 1) * 180 / std::numbers::pi;
}

Deformation deformation(const ElementPoints& points, bool scalar) {
  Deformation d;
  if (scalar) {
    for (int q = 0; q < points.count; ++q) d.volume += points.weight[q];
    d.deformed_volume = d.volume;
    d.smallest_J = 1;
    return d;
  }
  const Tensor<Lanes> F = deformation_gradient(points.gradient);
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

std::vector<double> small_strains(const Model& model, const State& state) {
  std::vector<double> strains(6 * model.mesh->kinds.size(), 0);
  visit_state(model, state, [&](const Numbering& numbering, std::size_t e, const ElementPoints& points) {
    double* strain = strains.data() + 6 * static_cast<std::size_t>(numbering.elements[e]);
    for (int q = 0; q < points.count; ++q)
      add_six(at(points.gradient, q), points.weight[q] / volume_of(points), strain);
  });
  return strains;
}

ElementResults element_results(const Model& model, const State& state, const ElementRequest& request) {
  ElementResults results = empty_results(request, model.mesh->kinds.size());
  visit_state(model, state, [&](const Numbering& numbering, std::size_t e, const ElementPoints& points) {
    const Region& region = model.regions[static_cast<std::size_t>(numbering.region_of[e])];
    const std::span<const Vec3> places(points.place, static_cast<std::size_t>(points.count));
    const auto law = law_of_points(model, region, numbering.elements[e], places);
    const bool remembers = state.history_stress && !region.prony.g.empty();
    const std::size_t offset = e * static_cast<std::size_t>(points.count);
    const Origin origin{*law, model.formulation, remembers ? state.history_stress->data() + 6 * offset : nullptr,
                        remembers && state.history_energy ? state.history_energy->data() + offset : nullptr};
    measure_element(points, origin, static_cast<std::size_t>(numbering.elements[e]), request, results);
  });
  return results;
}

}  // namespace msml::fe
