// SPDX-License-Identifier: GPL-3.0-or-later
// Homogeneous deformations must come out exactly on irregular meshes.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>

#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

/// On the boundary of the unit segment, square or cube.
bool on_boundary(const Vec3& x, CellKind kind) {
  for (int d = 0; d < dimension(kind); ++d)
    if (x[d] < 1e-9 || x[d] > 1 - 1e-9) return true;
  return false;
}

/// The unit mesh with the inner corners moved at random; mid nodes stay in the middle of straight edges.
Mesh irregular_mesh(CellKind kind) {
  Mesh mesh = unit_mesh(3, kind);
  Random random;
  const int corners = corner_count(kind);
  std::vector<bool> corner(static_cast<std::size_t>(mesh.point_count()), false);
  for (int c = 0; c < mesh.cell_count(); ++c)
    for (int a = 0; a < corners; ++a) corner[static_cast<std::size_t>(mesh.cell(c)[a])] = true;
  for (int n = 0; n < mesh.point_count(); ++n)
    if (corner[static_cast<std::size_t>(n)] && !on_boundary(mesh.points.row(n).transpose(), kind))
      for (int d = 0; d < dimension(kind); ++d) mesh.points(n, d) += random.number(-0.07, 0.07);
  for (int c = 0; c < mesh.cell_count(); ++c)
    for (int k = 0; corners + k < node_count(kind); ++k)
      mesh.points.row(mesh.cell(c)[corners + k]) =
          0.5 * (mesh.points.row(mesh.cell(c)[edge_of(k)[0]]) + mesh.points.row(mesh.cell(c)[edge_of(k)[1]]));
  return mesh;
}

/// Without the rows and columns of axes that elements of a kind do not have.
Mat3 within(Mat3 m, CellKind kind) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::max(i, j) >= dimension(kind)) m(i, j) = 0;
  return m;
}

/// Prescribes u = H X on the boundary; returns the largest error of u inside.
double patch_error(Model& model, const Mat3& H, Outcome& outcome) {
  Prescribed boundary{.name = "boundary", .nodes = points_where(*model.mesh, [&](const Vec3& x) {
                                            return on_boundary(x, model.mesh->kinds.front());
                                          })};
  for (const int n : boundary.nodes) boundary.values.push_back(H * model.mesh->points.row(n).transpose());
  model.steps[0].prescribed = {boundary};
  outcome = solve(model, {});
  return (outcome.state.displacement - model.mesh->points * H.transpose()).cwiseAbs().maxCoeff();
}

TEST(EveryElement, PassesThePatchTestInSmallStrain) {
  Random random;
  for (const CellKind kind : every_kind) {
    Model model = make_model(irregular_mesh(kind), {.youngs_modulus = 1000, .strain = Strain::small});
    const Mat3 H = within(1e-3 * random.matrix(), kind), e = 0.5 * (H + H.transpose());
    Outcome outcome;
    const double error = patch_error(model, H, outcome);
    EXPECT_EQ(outcome.stop, Stop::converged);
    EXPECT_LT(error, 1e-10 * H.norm());
    const double mu = 1000 / 2.6, lambda = 1000 * 0.3 / (1.3 * 0.4);
    const Mat3 sigma = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
    const ElementResults results = element_results(model, outcome.state);
    for (int c = 0; c < model.mesh->cell_count(); ++c) {
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c)], sigma(0, 0), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 2)], sigma(2, 2), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 3)], sigma(0, 1), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 4)], sigma(1, 2), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 5)], sigma(0, 2), 1e-10);
    }
  }
}

TEST(EveryElement, PassesThePatchTestUnderLargeRotationAndStretch) {
  for (const CellKind kind : every_kind) {
    Model model = make_model(irregular_mesh(kind), {.youngs_modulus = 1000});
    model.settings.tolerance = 1e-12;
    const bool line = dimension(kind) == 1, plane = dimension(kind) == 2;
    const Vec3 axis = plane ? Vec3(0, 0, 1) : Vec3(1, 2, -1).normalized();
    const double angle = line ? 0 : 0.6;
    const Vec3 stretches(1.2, line ? 1 : 0.9, line || plane ? 1 : 1.05);
    const Mat3 R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Mat3 F = R * stretches.asDiagonal();
    Outcome outcome;
    EXPECT_LT(patch_error(model, F - Mat3::Identity(), outcome), 1e-10);
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const ElementResults results = element_results(model, outcome.state);
    for (const double J : results.J) EXPECT_NEAR(J, stretches.prod(), 1e-10);
    for (const double found : results.rotation) EXPECT_NEAR(found, angle * 180 / M_PI, 1e-8);
    EXPECT_NEAR(outcome.check.volume_change, stretches.prod() - 1, 1e-10);
    EXPECT_NEAR(outcome.check.largest_strain, 0.2, 1e-9);
  }
}

/// Elements that treat the volume change apart.
Model split_model(Formulation formulation, std::shared_ptr<const Law> law) {
  const CellKind kind = formulation == Formulation::mixed ? CellKind::tet10 : CellKind::tet4;
  Model model = make_model(irregular_mesh(kind), {});
  model.regions[0].law = std::move(law);
  model.formulation = formulation;
  model.settings.tolerance = 1e-12;
  return model;
}

TEST(EveryFormulation, PassesThePatchTestInSmallStrain) {
  Random random;
  const LinearElastic data{.youngs_modulus = 1000, .poisson_ratio = 0.45, .strain = Strain::small};
  const double mu = 1000 / 2.9, lambda = 1000 * 0.45 / (1.45 * 0.1);
  for (const Formulation formulation : {Formulation::mixed, Formulation::fbar}) {
    Model model = split_model(formulation, make_linear_elastic(data));
    const Mat3 H = 1e-3 * random.matrix(), e = 0.5 * (H + H.transpose());
    Outcome outcome;
    EXPECT_LT(patch_error(model, H, outcome), 1e-10 * H.norm());
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const Mat3 sigma = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
    const ElementResults results = element_results(model, outcome.state);
    const double energy = 0.5 * sigma.cwiseProduct(e).sum();
    for (std::size_t c = 0; c < results.J.size(); ++c) {
      EXPECT_NEAR(results.cauchy[6 * c], sigma(0, 0), 1e-9 * sigma.norm());
      EXPECT_NEAR(results.cauchy[6 * c + 3], sigma(0, 1), 1e-9 * sigma.norm());
      EXPECT_NEAR(results.energy_density[c], energy, 1e-9 * energy);
    }
    EXPECT_NEAR(outcome.state.energies.elastic, energy, 1e-9 * energy);  // of a unit volume
  }
}

TEST(EveryFormulation, PassesThePatchTestUnderLargeRotationAndStretch) {
  const Mat3 R = Eigen::AngleAxisd(0.6, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Mat3 F = R * Vec3(1.2, 0.9, 1.05).asDiagonal();
  for (const NamedLaw& named : all_laws()) {
    const auto split = named.law->split();
    if (!split || !std::isfinite(split->modulus[0])) continue;
    for (const Formulation formulation : {Formulation::mixed, Formulation::fbar}) {
      Model model = split_model(formulation, named.law);
      Outcome outcome;
      EXPECT_LT(patch_error(model, F - Mat3::Identity(), outcome), 1e-10) << named.name;
      EXPECT_EQ(outcome.stop, Stop::converged) << named.name << ": " << outcome.diagnosis;
      if (named.law->small_strain()) continue;
      const ElementResults results = element_results(model, outcome.state);
      const Mat3 cauchy = evaluate(*named.law, F).P * F.transpose() / F.determinant();
      // Corotated: written as P R^T.
      if (named.law->name() == "linearElasticMaterial") continue;
      for (std::size_t c = 0; c < results.J.size(); ++c)
        EXPECT_NEAR(results.cauchy[6 * c + 3], cauchy(0, 1), 1e-8 * cauchy.norm()) << named.name;
    }
  }
}

// The four-point rule integrates the stiffness of a curved element only approximately; the error is of interest, and
// must vanish with the curvature.
TEST(Tet10, MissesThePatchTestOnlyByTheCurvature) {
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    Mesh mesh = irregular_mesh(CellKind::tet10);
    Random random;
    for (int n = 0; n < mesh.point_count(); ++n)
      if (!on_boundary(mesh.points.row(n).transpose(), CellKind::tet10))
        for (int d = 0; d < 3; ++d) mesh.points(n, d) += (k == 0 ? 0.01 : 0.005) * random.number();
    Model model = make_model(std::move(mesh), {.strain = Strain::small});
    Outcome outcome;
    errors[k] = patch_error(model, 1e-3 * Mat3::Ones(), outcome) / 1e-3;
    std::cout << "patch test, curved tet10, mid nodes off by " << (k == 0 ? 0.01 : 0.005) << ": relative error "
              << errors[k] << "\n";
  }
  EXPECT_LT(errors[0], 1e-2);
  EXPECT_LT(errors[1], 0.6 * errors[0]);
}

// dN/dxi times the cofactors of a quadratic map: degree 3.
TEST(Tet10, PassesThePatchTestWhereCurvedWithEightPoints) {
  Mesh mesh = irregular_mesh(CellKind::tet10);
  Random random;
  for (int n = 0; n < mesh.point_count(); ++n)
    if (!on_boundary(mesh.points.row(n).transpose(), CellKind::tet10))
      for (int d = 0; d < 3; ++d) mesh.points(n, d) += 0.01 * random.number();
  Model model = make_model(std::move(mesh), {.strain = Strain::small});
  model.quadrature = 8;
  Outcome outcome;
  EXPECT_LT(patch_error(model, 1e-3 * Mat3::Ones(), outcome) / 1e-3, 1e-10);
  EXPECT_EQ(outcome.stop, Stop::converged);
}

// Of mixed elements too; four points miss it.
TEST(MixedTet10, PassesThePatchTestWhereCurvedWithEightPoints) {
  for (const int points : {4, 8}) {
    Model model = split_model(Formulation::mixed, make_linear_elastic({.strain = Strain::small}));
    Mesh mesh = *model.mesh;
    Random random;
    for (int n = 0; n < mesh.point_count(); ++n)
      if (!on_boundary(mesh.points.row(n).transpose(), CellKind::tet10))
        for (int d = 0; d < 3; ++d) mesh.points(n, d) += 0.01 * random.number();
    model.mesh = std::make_shared<const Mesh>(std::move(mesh));
    model.quadrature = points;
    Outcome outcome;
    const double error = patch_error(model, 1e-3 * Mat3::Ones(), outcome) / 1e-3;
    EXPECT_EQ(outcome.stop, Stop::converged);
    if (points == 8)
      EXPECT_LT(error, 1e-10);
    else
      EXPECT_GT(error, 1e-6);
  }
}

TEST(EveryElement, HasNoStressUnderARigidMotion) {
  const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const Model model = make_model(irregular_mesh(kind), {.youngs_modulus = 1});
    State state;
    state.displacement = model.mesh->points * (R - Mat3::Identity()).transpose();
    state.displacement.rowwise() += Eigen::RowVector3d(3, -1, 2);
    const ElementResults results = element_results(model, state);
    // Round-off of the positions, about 1e-15, over the size of an element, about 0.1, times E = 1.
    for (const double s : results.cauchy) EXPECT_NEAR(s, 0, 1e-12);
    for (const double angle : results.rotation) EXPECT_NEAR(angle, 2.5 * 180 / M_PI, 1e-9);
  }
}

}  // namespace
}  // namespace msml::fe
