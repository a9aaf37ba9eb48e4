// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic tetrahedra with one rotation: derivatives, invariance, and what the element work costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <iostream>

#include "msml/core/error.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/materials/diffusion.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

Model rotated_model(int n, Formulation formulation, TangentKind tangent = TangentKind::automatic) {
  Model model = make_model(box_mesh(n, n, n, {1, 1, 1}, CellKind::tet10),
                           {.youngs_modulus = 1000, .poisson_ratio = 0.4, .tangent = tangent});
  model.formulation = formulation;
  return model;
}

Vector bent(const Elements& elements, const Model& model, double size) {
  Vector u = to_vector(elements.numbering(), model.mesh->points);
  Random random;
  for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = size * (std::sin(2 * u[k]) + random.number());
  return u;
}

Vector force_at(const Elements& elements, const Vector& u) {
  Vector force = Vector::Zero(u.size());
  elements.add_internal(u, Want::stress, force, nullptr);
  return force;
}

TEST(SingleRotation, ForceIsDerivativeOfEnergyAndTangentOfForce) {
  const Model model = rotated_model(1, Formulation::single_rotation);
  const auto elements = make_elements(model);
  for (const double size : {0.01, 0.2}) {
    const Vector u = bent(*elements, model, size);
    BlockMatrix K(elements->pattern());
    Vector force = Vector::Zero(u.size()), unused = force, column, row;
    elements->add_internal(u, Want::tangent, force, &K);
    const double h = 1e-6;
    double scale = 0;
    for (const double k : K.values) scale = std::max(scale, std::abs(k));
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      Vector up = u, down = u;
      up[k] += h, down[k] -= h;
      const double slope = (elements->add_internal(up, Want::stress, unused, nullptr).energy -
                            elements->add_internal(down, Want::stress, unused, nullptr).energy) /
                           (2 * h);
      EXPECT_NEAR(force[k], slope, 1e-6 * (1 + force.norm())) << size;
      multiply(K, Vector::Unit(u.size(), k), column);
      const Vector difference = (force_at(*elements, up) - force_at(*elements, down)) / (2 * h);
      EXPECT_LT((column - difference).norm(), 1e-7 * scale) << size << " " << k;  // h^2 and 1e-16 / h of the scale
    }
  }
}

TEST(SingleRotation, ForcesHaveNoResultantAndNoMoment) {
  const Model model = rotated_model(2, Formulation::single_rotation);
  const auto elements = make_elements(model);
  const Vector X = to_vector(elements->numbering(), model.mesh->points), u = bent(*elements, model, 0.1);
  const Vector force = force_at(*elements, u);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  for (Eigen::Index k = 0; k < u.size(); k += 3) {
    const Vec3 x = X.segment<3>(k) + u.segment<3>(k), f = force.segment<3>(k);
    sum += f;
    moment += x.cross(f);
  }
  EXPECT_LT(sum.norm(), 1e-12 * force.norm());
  EXPECT_LT(moment.norm(), 1e-12 * force.norm());
}

TEST(SingleRotation, IsTheStandardElementWhereTheDisplacementIsSmallOrHomogeneous) {
  const Model model = rotated_model(2, Formulation::single_rotation), plain = rotated_model(2, Formulation::standard);
  const auto elements = make_elements(model), standard = make_elements(plain);
  const Vector small = bent(*elements, model, 1e-8);
  const Vector wanted = force_at(*standard, small);
  EXPECT_LT((force_at(*elements, small) - wanted).norm(), 1e-6 * wanted.norm());  // differs by the square of 1e-8 / h
  const Mat3 R = Eigen::AngleAxisd(2.2, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const Mat3 F = R * Mat3(Vec3(1.3, 0.8, 1.1).asDiagonal());
  Points moved = model.mesh->points * (F - Mat3::Identity()).transpose();
  const Vector turned = to_vector(elements->numbering(), moved), same = force_at(*standard, turned);
  EXPECT_LT((force_at(*elements, turned) - same).norm(), 1e-11 * same.norm());
  Points rigid = model.mesh->points * (R - Mat3::Identity()).transpose();
  rigid.rowwise() += Eigen::RowVector3d(3, 2, 1);
  EXPECT_LT(force_at(*elements, to_vector(elements->numbering(), rigid)).norm(), 1e-11 * same.norm());
}

// Straight elements of one law make their stiffness anew each time; where the law may differ from place to place they
// keep the sum over quadrature points.
TEST(SingleRotation, HasTheSameStiffnessMadeAsKept) {
  const Model made = rotated_model(2, Formulation::single_rotation);
  Model kept = made;
  kept.regions[0].point_law = [law = made.regions[0].law](const auto&, const auto&) { return law; };
  const auto elements = make_elements(made), others = make_elements(kept);
  EXPECT_LT(elements->bytes() + 2000 * 40, others->bytes());
  const Vector u = bent(*elements, made, 0.1), force = force_at(*others, u);
  EXPECT_LT((force_at(*elements, u) - force).norm(), 1e-13 * force.norm());
  for (const Want want : {Want::tangent, Want::single_tangent}) {
    BlockMatrix K(elements->pattern()), L(others->pattern());
    Vector unused = Vector::Zero(u.size());
    elements->add_internal(u, want, unused, &K);
    others->add_internal(u, want, unused, &L);
    double largest = 0, apart = 0;
    for (std::size_t k = 0; k < K.values.size(); ++k) {
      largest = std::max(largest, std::abs(L.values[k]));
      apart = std::max(apart, std::abs(K.values[k] - L.values[k]));
    }
    EXPECT_LT(apart, 1e-13 * largest);
  }
}

TEST(SingleRotation, BendsABeamAsTheStandardElementDoes) {
  Vec3 tips[2];
  for (const Formulation formulation : {Formulation::standard, Formulation::single_rotation}) {
    Model model = beam_model(2, CellKind::tet10, 0.4, Strain::corotated);
    model.formulation = formulation;
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    tips[formulation == Formulation::single_rotation] = tip(model, outcome.state);
  }
  EXPECT_LT((tips[0] - tips[1]).norm(),
            0.02 * tips[0].norm());  // both with h = L/10; they differ in the element's bend
}

TEST(SingleRotation, RefusesOtherLawsAndElements) {
  const auto refusal = [](const Model& model) -> std::string {
    try {
      model.check();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {});
  model.formulation = Formulation::single_rotation;
  EXPECT_THAT(refusal(model), HasSubstr("singleRotation is for quadraticTet, the elements are tet4"));
  model = rotated_model(1, Formulation::single_rotation);
  model.regions[0].law = make_linear_elastic({.strain = Strain::small});
  EXPECT_THAT(refusal(model), HasSubstr("linearElasticMaterial of small strain"));
  model.regions[0].law = make_diffusion(1);
  EXPECT_THAT(refusal(model), HasSubstr("its law is diffusionMaterial"));
}

double milliseconds(const Elements& elements, const Vector& u, Want want, bool tangent) {
  BlockMatrix K(elements.pattern());
  Vector force = Vector::Zero(u.size());
  double best = 1e9;
  for (int k = 0; k < 5; ++k) {
    const auto start = std::chrono::steady_clock::now();
    elements.add_internal(u, want, force, tangent ? &K : nullptr);
    best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

// Times are printed, not tested: a loaded machine would fail them.
TEST(SingleRotation, CostsAFractionOfTheStandardElement) {
  const Model model = rotated_model(8, Formulation::single_rotation), plain = rotated_model(8, Formulation::standard),
              turned = rotated_model(8, Formulation::standard, TangentKind::rotated);
  const auto elements = make_elements(model), standard = make_elements(plain), rotated = make_elements(turned);
  const Vector u = bent(*elements, model, 0.01);
  std::cout << "element work in ms, " << model.mesh->cell_count() << " tet10: force "
            << milliseconds(*standard, u, Want::stress, false) << " -> "
            << milliseconds(*elements, u, Want::stress, false) << "; with R K R^T "
            << milliseconds(*rotated, u, Want::tangent, true) << " -> "
            << milliseconds(*elements, u, Want::single_tangent, true) << "; with the exact tangent "
            << milliseconds(*standard, u, Want::tangent, true) << " -> "
            << milliseconds(*elements, u, Want::tangent, true) << "\n";
}

}  // namespace
}  // namespace msml::fe
