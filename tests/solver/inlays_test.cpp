// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes embedded in a body.
#include <gtest/gtest.h>

#include <numeric>

#include "solver/elements/assembly.hpp"
#include "tests/solver/laws.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

std::vector<int> all_cells(const Mesh& mesh) {
  std::vector<int> cells(mesh.kinds.size());
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

/// A mesh of the same nodes as the body's: each is tied to one of an element that has it.
Inlay twin(const Model& model, const LinearElastic& law, double density = 1) {
  Inlay inlay{.mesh = model.mesh,
              .region = {.name = "twin",
                         .law = make_linear_elastic(law),
                         .density = density,
                         .elements = all_cells(*model.mesh)},
              .ties = {}};
  inlay.ties.resize(static_cast<std::size_t>(model.mesh->point_count()));
  for (const int e : inlay.region.elements) {
    const int nodes = node_count(model.mesh->kinds[static_cast<std::size_t>(e)]);
    for (int a = 0; a < nodes; ++a) {
      Tie tie{e, std::vector<double>(static_cast<std::size_t>(nodes), 0)};
      tie.weights[static_cast<std::size_t>(a)] = 1;
      inlay.ties[static_cast<std::size_t>(model.mesh->cell(e)[a])] = tie;
    }
  }
  return inlay;
}

struct Assembly {
  Vector force;
  BlockMatrix K;
  ScalarMatrix M;
  double energy = 0;
};

Assembly assemble(const Model& model, bool lumped = false) {
  const auto elements = make_elements(model);
  const int size = 3 * elements->numbering().nodes();
  Assembly a{Vector::Zero(size), BlockMatrix(elements->pattern()), ScalarMatrix(elements->pattern())};
  Random random;
  Vector u(size);
  for (Eigen::Index k = 0; k < size; ++k) u[k] = 0.05 * random.number();
  a.energy = elements->add_internal(u, Want::tangent, a.force, &a.K).energy;
  elements->add_mass(lumped, a.M);
  return a;
}

double difference(const Numbers<double>& a, const Numbers<double>& b) {
  double most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return most / size;
}

// With the same Poisson's ratio all is linear in Young's modulus.
TEST(Inlay, OfTheSameNodesAddsItsStiffnessAndMass) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    Model one = make_model(box_mesh(2, 1, 1, {2, 1, 1}, kind), {.youngs_modulus = 1000});
    one.inlays = {twin(one, {.youngs_modulus = 500}, 0.5 * one.regions[0].density)};
    Model sum = make_model(box_mesh(2, 1, 1, {2, 1, 1}, kind), {.youngs_modulus = 1500});
    sum.regions[0].density *= 1.5;
    for (const bool lumped : {false, true}) {
      const Assembly a = assemble(one, lumped), b = assemble(sum, lumped);
      ASSERT_EQ(a.K.pattern->columns, b.K.pattern->columns);
      EXPECT_LT((a.force - b.force).norm(), 1e-13 * b.force.norm());
      EXPECT_LT(difference(a.K.values, b.K.values), 1e-13);
      EXPECT_LT(difference(a.M.values, b.M.values), 1e-13);
      EXPECT_NEAR(a.energy, b.energy, 1e-13 * b.energy);
    }
  }
}

/// A finer grid inside the lower half of a coarse cube along each axis, tied by hand: the coarse body is one linear
/// field, whose weights are barycentric coordinates in the tetrahedra of the Kuhn cut.
Inlay fine_grid(const Model& model, const LinearElastic& law) {
  Inlay inlay{.mesh = std::make_shared<const Mesh>(
                  grid_mesh(3, 3, 3, CellKind::tet4,
                            [](double x, double y, double z) { return Vec3(0.1 + 0.5 * x, 0.2 + 0.4 * y, 0.7 * z); })),
              .region = {.name = "fine", .law = make_linear_elastic(law), .density = 2, .elements = {}},
              .ties = {}};
  inlay.region.elements = all_cells(*inlay.mesh);
  for (int n = 0; n < inlay.mesh->point_count(); ++n) {
    Tie best;
    double most = -1;
    for (int e = 0; e < model.mesh->cell_count(); ++e) {
      Eigen::Matrix4d corners;
      for (int a = 0; a < 4; ++a) corners.col(a) << model.mesh->points.row(model.mesh->cell(e)[a]).transpose(), 1;
      Eigen::Vector4d x;
      x << inlay.mesh->points.row(n).transpose(), 1;
      const Eigen::Vector4d L = corners.inverse() * x;
      if (L.minCoeff() <= most) continue;
      most = L.minCoeff();
      best = {e, {L[0], L[1], L[2], L[3]}};
    }
    inlay.ties.push_back(best);
  }
  return inlay;
}

// All deformations linear in X are linear in the finer mesh too: the energies of both add up, volume by volume.
TEST(Inlay, OfAnotherMeshStretchesWithTheBody) {
  Model model = make_model(box_mesh(2, 2, 2, {1, 1, 1}, CellKind::tet4), {.youngs_modulus = 1000});
  const LinearElastic law{.youngs_modulus = 3000};
  const auto plain = make_elements(model);
  model.inlays = {fine_grid(model, law)};
  const auto elements = make_elements(model);
  const Numbering& numbering = elements->numbering();
  Mat3 H;
  H << 0.1, 0.05, 0, -0.02, 0.2, 0.03, 0, 0.01, -0.1;
  Vector u(3 * numbering.nodes());
  for (int n = 0; n < numbering.nodes(); ++n)
    u.segment<3>(3 * n) = H * model.mesh->points.row(numbering.node_of[static_cast<std::size_t>(n)]).transpose();
  Vector force = Vector::Zero(u.size());
  const double both = elements->add_internal(u, Want::stress, force, nullptr).energy;
  Vector plain_force = Vector::Zero(u.size());
  const double own = plain->add_internal(u, Want::stress, plain_force, nullptr).energy;
  const double share = 0.5 * 0.4 * 0.7;  // of the body's volume, 1
  EXPECT_NEAR(both, own * (1 + 3 * share), 1e-12 * both);
  Vec3 sum = Vec3::Zero(), turn = Vec3::Zero();
  for (int n = 0; n < numbering.nodes(); ++n) {
    sum += force.segment<3>(3 * n);
    const Vec3 X = model.mesh->points.row(numbering.node_of[static_cast<std::size_t>(n)]).transpose();
    turn += (X + u.segment<3>(3 * n)).cross(force.segment<3>(3 * n));
  }
  EXPECT_LT(sum.norm(), 1e-12 * force.norm());   // no force of its own on the body
  EXPECT_LT(turn.norm(), 1e-12 * force.norm());  // and no moment
}

TEST(Inlay, AddsItsMassOnce) {
  Model model = make_model(box_mesh(2, 2, 2, {1, 1, 1}, CellKind::tet4), {});
  const double own = model.regions[0].density;
  model.inlays = {fine_grid(model, {})};
  for (const bool lumped : {false, true}) {
    const Assembly a = assemble(model, lumped);
    const double sum = std::accumulate(a.M.values.begin(), a.M.values.end(), 0.0);
    EXPECT_NEAR(sum, own + 2 * 0.5 * 0.4 * 0.7, 1e-12);
    if (!lumped) continue;
    for (const double m : a.M.values) EXPECT_GE(m, 0);
  }
}

TEST(Inlay, HasTheTangentOfItsForces) {
  Model model = make_model(box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4), {});
  model.inlays = {fine_grid(model, {})};
  const auto elements = make_elements(model);
  const int size = 3 * elements->numbering().nodes();
  Random random;
  Vector u(size), step(size), force = Vector::Zero(size), up = force, down = force, product;
  for (Eigen::Index k = 0; k < size; ++k) {
    u[k] = 0.1 * random.number();
    step[k] = random.number();
  }
  BlockMatrix K(elements->pattern());
  elements->add_internal(u, Want::tangent, force, &K);
  const double h = 1e-6;  // central differences: round-off 1e-16 / h
  elements->add_internal(u + h * step, Want::stress, up, nullptr);
  elements->add_internal(u - h * step, Want::stress, down, nullptr);
  multiply(K, step, product);
  EXPECT_LT(((up - down) / (2 * h) - product).norm(), 1e-8 * product.norm());
}

}  // namespace
}  // namespace msml::fe
