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

bool on_unit_box(const Vec3& x) { return x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9; }

/// 3 x 3 x 3 cubes with the inner corners moved at random; mid nodes stay in the middle of straight edges.
Mesh irregular_box(CellKind kind) {
  Mesh mesh = box_mesh(3, 3, 3, {1, 1, 1}, kind);
  Random random;
  std::vector<bool> corner(static_cast<std::size_t>(mesh.point_count()), false);
  for (int c = 0; c < mesh.cell_count(); ++c)
    for (int a = 0; a < 4; ++a) corner[static_cast<std::size_t>(mesh.cell(c)[a])] = true;
  for (int n = 0; n < mesh.point_count(); ++n)
    if (corner[static_cast<std::size_t>(n)] && !on_unit_box(mesh.points.row(n).transpose()))
      for (int d = 0; d < 3; ++d) mesh.points(n, d) += random.number(-0.07, 0.07);
  const std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  if (kind == CellKind::tet10)
    for (int c = 0; c < mesh.cell_count(); ++c)
      for (int k = 0; k < 6; ++k)
        mesh.points.row(mesh.cell(c)[4 + k]) =
            0.5 * (mesh.points.row(mesh.cell(c)[edges[k][0]]) + mesh.points.row(mesh.cell(c)[edges[k][1]]));
  return mesh;
}

/// Prescribes u = H X on the boundary; returns the largest error of u inside.
double patch_error(Model& model, const Mat3& H, Outcome& outcome) {
  Prescribed boundary{.name = "boundary", .nodes = points_where(*model.mesh, on_unit_box)};
  for (const int n : boundary.nodes) boundary.values.push_back(H * model.mesh->points.row(n).transpose());
  model.steps[0].prescribed = {boundary};
  outcome = solve(model, {});
  return (outcome.state.displacement - model.mesh->points * H.transpose()).cwiseAbs().maxCoeff();
}

TEST(EveryElement, PassesThePatchTestInSmallStrain) {
  Random random;
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model model = make_model(irregular_box(kind), {.youngs_modulus = 1000, .strain = Strain::small});
    const Mat3 H = 1e-3 * random.matrix(), e = 0.5 * (H + H.transpose());
    Outcome outcome;
    const double error = patch_error(model, H, outcome);
    EXPECT_EQ(outcome.stop, Stop::converged);
    EXPECT_LT(error, 1e-10 * H.norm());
    const double mu = 1000 / 2.6, lambda = 1000 * 0.3 / (1.3 * 0.4);
    const Mat3 sigma = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
    const ElementResults results = element_results(model, outcome.state);
    for (int c = 0; c < model.mesh->cell_count(); ++c) {
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c)], sigma(0, 0), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 3)], sigma(0, 1), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 4)], sigma(1, 2), 1e-10);
      EXPECT_NEAR(results.cauchy[static_cast<std::size_t>(6 * c + 5)], sigma(0, 2), 1e-10);
    }
  }
}

TEST(EveryElement, PassesThePatchTestUnderLargeRotationAndStretch) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model model = make_model(irregular_box(kind), {.youngs_modulus = 1000});
    model.settings.tolerance = 1e-12;
    const Mat3 R = Eigen::AngleAxisd(0.6, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    const Mat3 F = R * Vec3(1.2, 0.9, 1.05).asDiagonal();
    Outcome outcome;
    EXPECT_LT(patch_error(model, F - Mat3::Identity(), outcome), 1e-10);
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    const ElementResults results = element_results(model, outcome.state);
    for (const double J : results.J) EXPECT_NEAR(J, 1.2 * 0.9 * 1.05, 1e-10);
    for (const double angle : results.rotation) EXPECT_NEAR(angle, 0.6 * 180 / M_PI, 1e-8);
    EXPECT_NEAR(outcome.check.volume_change, 1.2 * 0.9 * 1.05 - 1, 1e-10);
    EXPECT_NEAR(outcome.check.largest_strain, 0.2, 1e-9);
  }
}

// The four-point rule integrates the stiffness of a curved element only approximately; the error is of interest, and
// must vanish with the curvature.
TEST(Tet10, MissesThePatchTestOnlyByTheCurvature) {
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    Mesh mesh = irregular_box(CellKind::tet10);
    Random random;
    for (int n = 0; n < mesh.point_count(); ++n)
      if (!on_unit_box(mesh.points.row(n).transpose()))
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

TEST(EveryElement, HasNoStressUnderARigidMotion) {
  const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const Model model = make_model(irregular_box(kind), {.youngs_modulus = 1});
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
