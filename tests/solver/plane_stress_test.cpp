// SPDX-License-Identifier: GPL-3.0-or-later
// Laws under plane stress: nothing pulls across the plane.
#include <gtest/gtest.h>

#include "solver/equations.hpp"
#include "solver/materials/plane_stress.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// A deformation in the plane with stretches within 0.75 and 1.4; every law is defined there.
Mat3 in_plane(Random& random) {
  Mat3 F = Mat3::Identity();
  const double angle = random.number(-1, 1), turn = random.number(-1, 1);
  const Eigen::Matrix2d V = Eigen::Rotation2Dd(angle).toRotationMatrix(),
                        R = Eigen::Rotation2Dd(turn).toRotationMatrix();
  F.topLeftCorner<2, 2>() =
      R * V * Eigen::Vector2d(random.number(0.9, 1.4), random.number(0.75, 1.1)).asDiagonal() * V.transpose();
  return F;
}

const std::map<std::string, Value> fibres_in_the_plane{{"fiber", std::string("1 2 0")},
                                                       {"fiber2", std::string("-1 0.3 0")}};

TEST(PlaneStress, LeavesNoStressAcrossThePlane) {
  Random random;
  for (const auto& [name, law] : all_laws(fibres_in_the_plane)) {
    const auto plane = make_plane_stress(law);
    for (int k = 0; k < 5; ++k) {
      const Point point = evaluate(*plane, in_plane(random));
      EXPECT_LT(std::abs(point.P(2, 2)), 1e-11 * law->shear_modulus()) << name;
      for (int i = 0; i < 2; ++i) EXPECT_EQ(std::abs(point.P(i, 2)) + std::abs(point.P(2, i)), 0) << name;
    }
  }
}

TEST(PlaneStress, StressAndTangentAreDerivativesInThePlane) {
  Random random;
  const double h = 1e-5;  // as for the laws themselves, see materials_test.cpp
  for (const auto& [name, law] : all_laws(fibres_in_the_plane)) {
    const auto plane = make_plane_stress(law);
    for (int k = 0; k < 5; ++k) {
      const Mat3 F = in_plane(random);
      Mat3 d = random.matrix();
      d.row(2).setZero();
      d.col(2).setZero();
      const Point at = evaluate(*plane, F), up = evaluate(*plane, F + h * d), down = evaluate(*plane, F - h * d);
      EXPECT_NEAR(at.P.cwiseProduct(d).sum(), (up.energy - down.energy) / (2 * h), 1e-6 * law->shear_modulus()) << name;
      if (!law->exact_tangent()) continue;
      Eigen::Matrix<double, 9, 1> flat;
      for (int i = 0; i < 9; ++i) flat[i] = d(i / 3, i % 3);
      const Eigen::Matrix<double, 9, 1> slope = at.tangent * flat;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          EXPECT_NEAR(slope[3 * i + j], (up.P(i, j) - down.P(i, j)) / (2 * h), 1e-5 * law->shear_modulus()) << name;
    }
  }
}

/// A unit square on rollers, pulled along x by a dead traction.
Model pulled(CellKind kind, double traction, const std::shared_ptr<const Law>& law) {
  Model model = make_model(rectangle_mesh(2, 2, 1, 1, kind), {});
  model.regions[0].law = law;
  model.plane = Plane::stress;
  model.settings.tolerance = 1e-12;
  model.settings.load_steps = 5;
  model.steps[0].prescribed = {
      fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }), true, false, false),
      fix(points_where(*model.mesh, [](const Vec3& x) { return x[1] < 1e-9; }), false, true, false)};
  FaceLoad pull{.name = "pull", .tractions = {Vec3(traction, 0, 0)}};
  pull.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
  model.steps[0].face_loads = {pull};
  return model;
}

// e_xx = s/E, e_yy = -nu s/E.
TEST(PlaneStress, OfHookesLawIsUniaxialTension) {
  for (const CellKind kind : {CellKind::tri3, CellKind::tri6}) {
    const Model model =
        pulled(kind, 10, make_linear_elastic({.youngs_modulus = 1000, .poisson_ratio = 0.3, .strain = Strain::small}));
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const Vec3 corner = outcome.state.displacement.row(nearest_point(*model.mesh, {1, 1, 0})).transpose();
    EXPECT_LT((corner - Vec3(0.01, -0.003, 0)).norm(), 1e-12);
    const ElementResults results = element_results(model, outcome.state);
    EXPECT_NEAR(results.cauchy[0], 10, 1e-9);
    EXPECT_NEAR(results.cauchy[2], 0, 1e-9);
    EXPECT_NEAR(results.strain[2], -0.003, 1e-12);
    EXPECT_NEAR(results.J[0], 1.01 * 0.997 * 0.997, 1e-12);
  }
}

// mu/2 (I1 - 3) - mu ln J + lambda/2 ln^2 J, E = 1000, nu = 0.3 at a stretch of 1.5: nominal stress 378.280176, lateral
// stretch 0.88017459.
TEST(PlaneStress, OfTheNeoHookeanLawIsUniaxialTension) {
  const auto law = law_of("neoHookeanMaterial", {{"form", std::string("log")}});  // samples: E = 1000, nu = 0.3
  for (const CellKind kind : {CellKind::tri3, CellKind::tri6}) {
    const Model model = pulled(kind, 378.280176, law);
    const Outcome outcome = solve(model, {});
    ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const Vec3 corner = outcome.state.displacement.row(nearest_point(*model.mesh, {1, 1, 0})).transpose();
    EXPECT_NEAR(corner[0], 0.5, 1e-8);
    EXPECT_NEAR(corner[1], 0.88017459 - 1, 1e-8);
    EXPECT_NEAR(element_results(model, outcome.state).J[0], 1.5 * 0.88017459 * 0.88017459, 1e-7);
  }
}

/// A square held on x = 0 and y = 0, pressed on its other edges.
Model pressed_square(CellKind kind, std::shared_ptr<const Law> law, double pressure) {
  Model model = make_model(rectangle_mesh(2, 2, 1, 1, kind), {});
  model.plane = Plane::stress;
  model.thickness = 0.3;
  model.regions[0].law = std::move(law);
  FaceLoad load{.name = "p", .pressures = {pressure}, .follower = true};
  load.faces = faces_where(*model.mesh, [](const Vec3& x) { return x[0] > 1 - 1e-9; });
  for (const Face& face : faces_where(*model.mesh, [](const Vec3& x) { return x[1] > 1 - 1e-9; }))
    load.faces.push_back(face);
  const auto side = [&](int d) {
    return points_where(*model.mesh, [=](const Vec3& x) { return std::abs(x[d]) < 1e-9; });
  };
  model.steps[0].prescribed = {fix(side(0), true, false, false), fix(side(1), false, true, false)};
  model.steps[0].face_loads = {load};
  return model;
}

// A pressure is force per deformed area, of the deformed thickness too: the Cauchy stress is -p in the plane. The
// closed form of the incompressible sheet, sigma = mu (l^2 - l^-4), is met as the bulk modulus grows.
TEST(PlaneStress, AFollowerPressureActsOnTheDeformedThickness) {
  for (const CellKind kind : {CellKind::tri3, CellKind::tri6})
    for (const double pressure : {-300.0, 150.0}) {
      Model model = pressed_square(
          kind, law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}}), pressure);
      model.settings.load_steps = 4;
      const Outcome outcome = solve(model, {});
      ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
      const auto stress = element_results(model, outcome.state).cauchy;
      for (std::size_t k = 0; k < stress.size(); k += 6) {
        EXPECT_NEAR(stress[k], -pressure, 1e-5);  // Newton's tolerance, 1e-8 of the loads
        EXPECT_NEAR(stress[k + 1], -pressure, 1e-5);
      }
    }
  const double mu = 1, l = 1.3;
  Model sheet = pressed_square(
      CellKind::tri6,
      law_of("neoHookeanMaterial",
             {{"youngModulus", 3 * mu * (1 - 1e-7)}, {"poissonRatio", 0.5 - 1e-7}, {"form", std::string("isochoric")}}),
      -mu * (l * l - std::pow(l, -4)));
  sheet.settings.load_steps = 4;
  const Outcome outcome = solve(sheet, {});
  ASSERT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
  EXPECT_NEAR(outcome.state.displacement(nearest_point(*sheet.mesh, {1, 1, 0}), 0), l - 1, 1e-5);  // 1e-7 / (1 - 2 nu)
}

TEST(PlaneStress, AFollowerPressureHasItsTangent) {
  const auto soft_above = [](std::span<const int>, std::span<const Vec3> places) {
    std::vector<std::shared_ptr<const Law>> laws;
    for (const Vec3& X : places)
      laws.push_back(law_of("neoHookeanMaterial", {{"youngModulus", 1000 - 500 * X[1]}, {"poissonRatio", 0.3}}));
    laws.resize(lanes, laws.back());
    return laws.front()->merged(laws);
  };
  for (const CellKind kind : {CellKind::tri3, CellKind::tri6})
    for (const bool varying : {false, true}) {
      Model model =
          pressed_square(kind, law_of("neoHookeanMaterial", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}}), 2);
      if (varying) model.regions[0].point_law = soft_above;
      if (varying) model.steps[0].face_loads[0].pressure_function = [](const Vec3& X, double) { return 1 + X[1]; };
      const Equations equations(model);
      Vector u = Vector::Zero(equations.size());
      for (Eigen::Index k = 0; k < u.size(); ++k)
        if (k % 3 < 2) u[k] = 0.05 * std::sin(3.0 * static_cast<double>(k));
      BlockMatrix K(equations.elements().pattern());
      Vector force = Vector::Zero(u.size());
      add_followers({&equations.loads(0), 1, 0}, equations.positions(), u, force, &K);
      const double h = 1e-6;
      for (Eigen::Index k = 0; k < u.size(); ++k) {
        if (k % 3 == 2) continue;  // held at zero
        Vector up = u, down = u, plus = Vector::Zero(u.size()), minus = plus, column;
        up[k] += h, down[k] -= h;
        add_followers({&equations.loads(0), 1, 0}, equations.positions(), up, plus, nullptr);
        add_followers({&equations.loads(0), 1, 0}, equations.positions(), down, minus, nullptr);
        multiply(K, Vector::Unit(u.size(), k), column);
        EXPECT_LT((column + (plus - minus) / (2 * h)).cwiseAbs().maxCoeff(), 1e-8);
      }
    }
}

}  // namespace
}  // namespace msml::fe
