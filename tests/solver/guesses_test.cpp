// SPDX-License-Identifier: GPL-3.0-or-later
// Where iterative solutions start: in the span of those before.
#include "solver/linear/guesses.hpp"

#include <gtest/gtest.h>

#include <random>

#include "solver/equations.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe::testing {
namespace {

/// A beam's stiffness with a mass on the diagonal, clamped at one end, and random vectors.
struct Problem {
  Problem() : model(beam_model(5, CellKind::tet4, 0.3, Strain::small)), equations(model), A(pattern()) {
    Forces forces;
    const Vector zero = Vector::Zero(equations.size());
    equations.evaluate(zero, {}, Want::tangent, forces, &A);
    add(A, 1e3, equations.mass());
    fixed = make_supports(model.steps[0], equations.numbering(), zero).fixed;
  }
  PatternPtr pattern() const { return equations.elements().pattern(); }
  Vector vector() {
    Vector v(equations.size());
    for (double& value : v) value = std::uniform_real_distribution<double>(-1, 1)(random);
    zero_fixed(fixed, v);
    return v;
  }
  Vector image(const Vector& x) const {
    Vector b;
    multiply(A, x, b);
    zero_fixed(fixed, b);
    return b;
  }
  /// Notes a solution as a solver does.
  void keep(const Vector& x) {
    Vector r, unused;
    guesses.expect(Vector::Zero(x.size()));
    guesses.start({&A}, fixed, image(x), r, unused);
    guesses.keep(x);
  }
  /// |b - A x| / |b| where a solution starts.
  double left(const Vector& expected, const Vector& b, double round_off = 1e-12) {
    Vector r, x;
    guesses.expect(expected);
    guesses.start({&A}, fixed, b, r, x);
    EXPECT_LT((b - image(x) - r).norm(), round_off * b.norm());
    return r.norm() / b.norm();
  }

  Model model;
  Equations equations;
  BlockMatrix A;
  Mask fixed;
  Guesses guesses;
  std::mt19937 random{1};
};

TEST(Guesses, MeetEverySumOfTheLastSevenSolutionsAndWhatIsExpected) {
  Problem beam;
  std::vector<Vector> known;
  for (int k = 0; k < 8; ++k) known.push_back(beam.vector());
  for (int k = 0; k < 7; ++k) beam.keep(known[static_cast<std::size_t>(k)]);
  Vector sum = -3.0 * known[7];
  for (int k = 0; k < 7; ++k) sum += (1 + k) * known[static_cast<std::size_t>(k)];
  EXPECT_LT(beam.left(known[7], beam.image(sum)), 1e-11);  // round-off times the condition of the eight, below 1e4
  beam.keep(beam.vector());
  EXPECT_GT(beam.left(known[7], beam.image(known[0])), 1e-2) << "the eighth from last is forgotten";
}

TEST(Guesses, AreNearestInTheNormOfTheMatrix) {
  Problem beam;
  const Vector a = beam.vector(), likely = beam.vector(), x = beam.vector(), b = beam.image(x);
  beam.keep(a);
  Vector r, start;
  beam.guesses.expect(likely);
  beam.guesses.start({&beam.A}, beam.fixed, b, r, start);
  // What is left is orthogonal to both.
  EXPECT_LT(std::abs(r.dot(a)), 1e-12 * r.norm() * a.norm());
  EXPECT_LT(std::abs(r.dot(likely)), 1e-12 * r.norm() * likely.norm());
}

TEST(Guesses, StayFiniteWhereVectorsAreZeroOrMultiplesOfEachOther) {
  Problem beam;
  const Vector x = beam.vector(), b = beam.image(x);
  for (int k = 1; k < 5; ++k) beam.keep(k * x);
  EXPECT_LT(beam.left(Vector::Zero(x.size()), b), 1e-11);
  EXPECT_LT(beam.left(2 * x, b), 1e-11);
  EXPECT_EQ(beam.left(x, b) < 1e-11, true);
}

// Round-off, 1e-16, over the smallest eigenvalue of the normed energies, about 1e-8; the multiples are about 1e4.
TEST(Guesses, MeetWhatNearlyDependentVectorsSpan) {
  Problem beam;
  const Vector x = beam.vector(), y = beam.vector();
  beam.keep(x);
  beam.keep(x + 1e-4 * y);
  EXPECT_LT(beam.left(Vector::Zero(x.size()), beam.image(y), 1e-10), 1e-6);
}

TEST(Guesses, ServeOnlyWhereSomethingIsExpected) {
  Problem beam;
  const Vector x = beam.vector(), b = beam.image(x);
  beam.keep(x);
  Vector r, start;
  beam.guesses.start({&beam.A}, beam.fixed, b, r, start);
  EXPECT_EQ(start.norm(), 0);
  EXPECT_EQ(r, b);
}

}  // namespace
}  // namespace msml::fe::testing
