// SPDX-License-Identifier: GPL-3.0-or-later
// Stresses and tangents of every energy against dual numbers, to round-off.
#include <gtest/gtest.h>

#include "solver/materials/guccione.hpp"
#include "solver/materials/linear_elastic.hpp"
#include "solver/materials/neo_hookean.hpp"
#include "solver/materials/ogden.hpp"
#include "solver/materials/polynomial.hpp"
#include "solver/materials/potential_law.hpp"
#include "solver/materials/saint_venant_kirchhoff.hpp"
#include "tests/solver/dual.hpp"
#include "tests/solver/laws.hpp"

namespace msml::fe {
namespace {

using namespace testing;

template <class T>
Tensor<T> gradient(const Mat3& F, const Mat3& direction) {
  Tensor<T> H;
  for (int k = 0; k < 9; ++k) {
    const double value = F(k / 3, k % 3) - (k % 4 == 0 ? 1 : 0);
    if constexpr (std::is_same_v<T, Dual>)
      H.c[k] = {value, direction(k / 3, k % 3)};
    else
      H.c[k] = value;
  }
  return H;
}

/// Energy, stress and tangent in doubles against the slopes of energy and stress in dual numbers along d.
void compare(const ResponseOf<double>& exact, const ResponseOf<Dual>& dual, const Mat3& d, const char* name) {
  double size = 0, work = 0, product[9] = {};
  for (int i = 0; i < 9; ++i) {
    work += exact.P.c[i] * d(i / 3, i % 3);
    for (int j = 0; j < 9; ++j) {
      const double entry = exact.tangent[i >= j ? packed_at(i, j) : packed_at(j, i)];
      product[i] += entry * d(j / 3, j % 3);
      size += entry * entry;
    }
  }
  size = std::sqrt(size);
  EXPECT_NEAR(work, dual.energy.slope, 1e-10 * size) << name;
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(product[i], dual.P.c[i].slope, 1e-10 * size) << name << " " << i;
}

/// Distance from the singular points: every stretch is at least 0.2 away from 0, f of tension at least 1e-3 from 0.
template <template <class> class Kernel>
void check(const char* name, const Kernel<Lanes>& kernel, VolumeMeasure measure, bool inverted) {
  const auto same = [](const Lanes& x) { return x[0]; };
  const auto as_dual = [](const Lanes& x) { return Dual(x[0]); };
  Random random;
  for (int sample = 0; sample < 20; ++sample) {
    const double smallest = inverted && sample % 2 == 1 ? -0.4 : 0.4;
    const Mat3 F = sample < 10 ? random.stretched(2.2, 1.3, smallest) : Mat3(Mat3::Identity() + 0.1 * random.matrix()),
               d = random.matrix();
    ResponseOf<double> exact;
    ResponseOf<Dual> dual;
    respond<true>(kernel.template map<double>(same), Volumetric<double>{measure, 700}, gradient<double>(F, d), exact);
    respond<false>(kernel.template map<Dual>(as_dual), Volumetric<Dual>{measure, 700}, gradient<Dual>(F, d), dual);
    compare(exact, dual, d, name);
  }
}

constexpr auto lnJ = VolumeMeasure::logarithm;

TEST(Derivatives, OfNeoHookeanEnergiesAreExact) {
  check<LogNeoHookean>("log", {lanes_of(300)}, lnJ, false);
  check<CubicNeoHookean>("cubic", {lanes_of(300)}, VolumeMeasure::cubic, true);
  check<StableNeoHookean>("stable", {lanes_of(300)}, VolumeMeasure::change, true);
  check<IsochoricNeoHookean>("isochoric", {lanes_of(300)}, VolumeMeasure::square, false);
}

TEST(Derivatives, OfPolynomialsAreExact) {
  check<SaintVenantKirchhoff>("SVK", {lanes_of(300), lanes_of(500)}, VolumeMeasure::none, true);
  check<MooneyRivlin>("Mooney-Rivlin", {lanes_of(200), lanes_of(70)}, lnJ, false);
  check<ReducedPolynomial>("Yeoh", {{lanes_of(200), lanes_of(-30), lanes_of(9)}}, lnJ, false);
  check<Polynomial>("polynomial", {{{1, 0, lanes_of(200)}, {0, 1, lanes_of(70)}, {1, 2, lanes_of(8)}}}, lnJ, false);
}

TEST(Derivatives, OfFibreEnergiesAreExact) {
  const Direction<Lanes> g{lanes_of(0.6), lanes_of(0), lanes_of(0.8)}, h{lanes_of(0), lanes_of(1), lanes_of(0)};
  check<TransverselyIsotropic>("fibre", {lanes_of(300), lanes_of(150), lanes_of(0.3), g}, lnJ, false);
  check<HolzapfelGasserOgden>("HGO", {lanes_of(300), lanes_of(150), lanes_of(0.3), lanes_of(0.1), lanes_of(1), g, h},
                              lnJ, false);
  check<Guccione>("Guccione", {lanes_of(300), lanes_of(1.2), lanes_of(0.5), lanes_of(0.8), g}, lnJ, false);
}

TEST(Derivatives, OfOgdensEnergyAreExactForDistinctStretches) {
  const Ogden<double> exact_kernel{{400, -150}, {1.3, -2.2}};
  const Ogden<Dual> dual_kernel{{400, -150}, {1.3, -2.2}};
  Random random;
  for (int sample = 0; sample < 20; ++sample) {
    const Mat3 F = random.stretched(2.2, 1.3, sample % 2 ? 0.4 : 1.3001), d = random.matrix();
    ResponseOf<double> exact;
    ResponseOf<Dual> dual;
    const Invariants<double> at(gradient<double>(F, d));
    const Invariants<Dual> dual_at(gradient<Dual>(F, d));
    const auto s = stretches_of(at.F());
    const auto dual_s = stretches_of(dual_at.F());
    respond(exact_kernel(s.value, at.j, {lnJ, 700}), s, true, exact);
    respond(dual_kernel(dual_s.value, dual_at.j, {lnJ, 700}), dual_s, false, dual);
    compare(exact, dual, d, "Ogden");
  }
}

/// R of F = R U by Newton's iteration in dual numbers; the derivative converges along with it.
Tensor<Dual> dual_rotation(Tensor<Dual> X) {
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Tensor<Dual> cof = cofactor(X);
    const Dual det = determinant(X, cof);
    for (int k = 0; k < 9; ++k) X.c[k] = 0.5 * (X.c[k] + cof.c[k] / det);
  }
  return X;
}

TEST(Derivatives, OfTheCorotatedLawAreExact) {
  const double mu = 300, nu = 0.3, lambda = 2 * mu * nu / (1 - 2 * nu);
  const auto law = make_linear_elastic({.youngs_modulus = 2 * mu * (1 + nu), .poisson_ratio = nu});
  Random random;
  for (int sample = 0; sample < 20; ++sample) {
    const Mat3 F = random.stretched(2.2, 1.3, 0.4), d = random.matrix();
    const Tensor<Dual> H = gradient<Dual>(F, d), R = dual_rotation(Invariants<Dual>(H).F());
    Dual trace = -3;  // tr(R^T F) - 3
    for (int k = 0; k < 9; ++k) trace += R.c[k] * (H.c[k] + (k % 4 == 0 ? 1.0 : 0.0));
    const Point point = evaluate(*law, F);
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> direction = d;
    const Eigen::Matrix<double, 9, 1> product =
        point.tangent * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(direction.data());
    for (int k = 0; k < 9; ++k) {
      const Dual P = 2 * mu * (H.c[k] + (k % 4 == 0 ? 1.0 : 0.0) - R.c[k]) + lambda * trace * R.c[k];
      EXPECT_NEAR(product[k], P.slope, 1e-10 * point.tangent.norm());
    }
  }
}

}  // namespace
}  // namespace msml::fe
