// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of convergence of every element, measured on solutions that are known everywhere.
#include <gtest/gtest.h>

#include <iostream>

#include "solver/materials/diffusion.hpp"
#include "tests/solver/manufactured.hpp"

namespace msml::fe {
namespace {

using namespace testing;

constexpr double young = 1000, nu = 0.3, mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));

/// u_i = sin(k . x + i) for i below the dimension.
struct Wave {
  int dimension;
  Vec3 k;
  explicit Wave(int d) : dimension(d), k(1.9, d > 1 ? 1.1 : 0, d > 2 ? 0.6 : 0) {}
  Vec3 u(const Vec3& x) const {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < dimension; ++i) v[i] = std::sin(k.dot(x) + i);
    return v;
  }
  Mat3 gradient(const Vec3& x) const {
    Mat3 H = Mat3::Zero();
    for (int i = 0; i < dimension; ++i) H.row(i) = std::cos(k.dot(x) + i) * k.transpose();
    return H;
  }
  /// -div(c sigma) with c = 1 + slope . x: c ((lambda + mu) k (k . u) + mu |k|^2 u) - sigma slope.
  Vec3 load(const Vec3& x, const Vec3& slope) const {
    const Mat3 H = gradient(x), sigma = mu * (H + H.transpose()) + lambda * H.trace() * Mat3::Identity();
    return (1 + slope.dot(x)) * ((lambda + mu) * k * k.dot(u(x)) + mu * k.squaredNorm() * u(x)) - sigma * slope;
  }
};

/// Young's modulus times 1 + slope . x.
PointLaw sloping(LinearElastic data, const Vec3& slope) {
  return [data, slope](std::span<const int>, std::span<const Vec3> places) {
    std::vector<std::shared_ptr<const Law>> laws;
    for (std::size_t k = 0; k < lanes; ++k) {
      LinearElastic here = data;
      here.youngs_modulus *= 1 + slope.dot(places[std::min(k, places.size() - 1)]);
      laws.push_back(make_linear_elastic(here));
    }
    return laws.front()->merged(laws);
  };
}

template <int dimension, int nodes>
Errors elastic_errors(int n, CellKind kind, Formulation formulation = Formulation::standard,
                      const Vec3& slope = Vec3::Zero()) {
  const Wave wave(dimension);
  const double size = formulation == Formulation::standard ? 1 : 1e-7;  // corotated laws see a small field as linear
  const LinearElastic data{
      .youngs_modulus = young, .poisson_ratio = nu, .strain = size < 1 ? Strain::corotated : Strain::small};
  Model model = make_model(unit_mesh(n, kind), data);
  if (!slope.isZero()) model.regions[0].point_law = sloping(data, slope);
  model.formulation = formulation;
  Prescribed boundary{.name = "boundary", .nodes = points_where(*model.mesh, [](const Vec3& x) {
                                            for (int d = 0; d < dimension; ++d)
                                              if (x[d] < 1e-9 || x[d] > 1 - 1e-9) return true;
                                            return false;
                                          })};
  for (const int p : boundary.nodes) boundary.values.push_back(size * wave.u(model.mesh->points.row(p).transpose()));
  model.steps[0].prescribed = {boundary};
  model.steps[0].forces = {
      volume_load<dimension, nodes>(model, [&](const Vec3& x) -> Vec3 { return size * wave.load(x, slope); })};
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return errors_of<dimension, nodes>(
      model, outcome.state, [&](const Vec3& x) -> Vec3 { return size * wave.u(x); },
      [&](const Vec3& x) -> Mat3 { return size * wave.gradient(x); });
}

void expect_order(const char* what, const Errors& coarse, const Errors& fine, double order) {
  const double l2 = std::log2(coarse.l2 / fine.l2), h1 = std::log2(coarse.h1 / fine.h1);
  std::cout << what << ": L2 error " << fine.l2 << ", order " << l2 << "; H1 error " << fine.h1 << ", order " << h1
            << "\n";
  EXPECT_NEAR(l2, order, 0.15) << what;
  EXPECT_NEAR(h1, order - 1, 0.15) << what;
}

TEST(Orders, OfLinearElasticityAreThoseOfTheory) {
  expect_order("line2", elastic_errors<1, 2>(16, CellKind::line2), elastic_errors<1, 2>(32, CellKind::line2), 2);
  expect_order("line3", elastic_errors<1, 3>(16, CellKind::line3), elastic_errors<1, 3>(32, CellKind::line3), 3);
  expect_order("tri3", elastic_errors<2, 3>(12, CellKind::tri3), elastic_errors<2, 3>(24, CellKind::tri3), 2);
  expect_order("tri6", elastic_errors<2, 6>(8, CellKind::tri6), elastic_errors<2, 6>(16, CellKind::tri6), 3);
  expect_order("tet4", elastic_errors<3, 4>(6, CellKind::tet4), elastic_errors<3, 4>(12, CellKind::tet4), 2);
  expect_order("tet10", elastic_errors<3, 10>(3, CellKind::tet10), elastic_errors<3, 10>(6, CellKind::tet10), 3);
  const auto single = Formulation::single_rotation;
  expect_order("tet10SR", elastic_errors<3, 10>(3, CellKind::tet10, single),
               elastic_errors<3, 10>(6, CellKind::tet10, single), 3);
}

TEST(Orders, AreKeptWhereTheModulusVariesInsideElements) {
  const Vec3 slope(3, -0.5, 1);
  const auto errors = [&](int n, Formulation formulation) {
    return elastic_errors<3, 10>(n, CellKind::tet10, formulation, slope);
  };
  for (const auto& [name, formulation] :
       {std::pair{"tet10, E(x)", Formulation::standard}, std::pair{"tet10SR, E(x)", Formulation::single_rotation},
        std::pair{"mixed, E(x)", Formulation::mixed}})
    expect_order(name, errors(3, formulation), errors(6, formulation), 3);
  const auto linear = [&](int n) { return elastic_errors<3, 4>(n, CellKind::tet4, Formulation::fbar, slope); };
  const Errors coarse = linear(6), fine = linear(12);
  EXPECT_NEAR(std::log2(coarse.l2 / fine.l2), 2, 0.15) << coarse.l2 << " " << fine.l2;
}

// -((1 + x) u')' = (1 + x)^-2, u(0) = 1, 2 u'(1) = -1/2; exact: u = 2 - 1/(1 + x) - ln(1 + x).
template <int nodes>
Errors poisson_errors(int n, CellKind kind) {
  Model model = make_model(segment_mesh(n, 1, kind), {});
  Region& region = model.regions[0];
  region.law = make_diffusion(1);
  region.point_law = [](std::span<const int>, std::span<const Vec3> places) {
    Lanes c;
    for (std::size_t k = 0; k < lanes; ++k) c[static_cast<int>(k)] = 1 + places[std::min(k, places.size() - 1)][0];
    return make_diffusion(c);
  };
  model.steps[0].prescribed = {fix({0})};
  model.steps[0].prescribed[0].values = {Vec3(1, 0, 0)};
  model.steps[0].forces = {
      volume_load<1, nodes>(model, [](const Vec3& x) { return Vec3(std::pow(1 + x[0], -2), 0, 0); })};
  FaceLoad flux{.name = "flux", .tractions = {Vec3(-0.5, 0, 0)}};
  flux.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
  model.steps[0].face_loads = {flux};
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  return errors_of<1, nodes>(
      model, outcome.state, [](const Vec3& x) { return Vec3(2 - 1 / (1 + x[0]) - std::log(1 + x[0]), 0, 0); },
      [](const Vec3& x) {
        Mat3 H = Mat3::Zero();
        H(0, 0) = std::pow(1 + x[0], -2) - 1 / (1 + x[0]);
        return H;
      });
}

TEST(Orders, OfThePoissonProblemWithAVaryingCoefficientAreThoseOfTheory) {
  expect_order("Poisson line2", poisson_errors<2>(16, CellKind::line2), poisson_errors<2>(32, CellKind::line2), 2);
  expect_order("Poisson line3", poisson_errors<3>(16, CellKind::line3), poisson_errors<3>(32, CellKind::line3), 3);
}

}  // namespace
}  // namespace msml::fe
