// SPDX-License-Identifier: GPL-3.0-or-later
// What an answer must not depend on: threads, the numbers of nodes, where the scene lies in space.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>

#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

struct Body {
  const char* name;
  CellKind kind;
  Formulation formulation;
};

// Every element of three dimensions. Newton's tolerance is far below the 1e-8 that are asked for.
class Invariance : public ::testing::TestWithParam<Body> {
 protected:
  static Model beam() {
    Model model =
        beam_model(GetParam().formulation == Formulation::mixed ? 1 : 2, GetParam().kind, 0.3, Strain::corotated);
    model.formulation = GetParam().formulation;
    if (model.formulation != Formulation::single_rotation) model.regions[0].law = neo_hookean("log", 1e5, 0.3);
    model.settings.linear_solver = LinearSolver::direct;
    model.settings.tolerance = 1e-12;
    return model;
  }
  static Points displacement(const Model& model) {
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged) << outcome.diagnosis;
    EXPECT_GT(outcome.state.displacement.rowwise().norm().maxCoeff(), 0.01);  // a tenth of the length
    return outcome.state.displacement;
  }
  static double difference(const Points& a, const Points& b) { return (a - b).norm() / b.norm(); }
};

TEST_P(Invariance, ThreadsChangeTheAnswerByLessThan1e10) {
  const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 4);  // also where there are fewer cores
  Model model = beam();
  const Points one = displacement(model);
  model.settings.threads = 3;
  EXPECT_LT(difference(displacement(model), one), 1e-10);
}

TEST_P(Invariance, TheNumbersOfNodesChangeItByLessThan1e8) {
  Model model = beam();
  const Points plain = displacement(model);
  Mesh mesh = *model.mesh;
  std::vector<int> number(static_cast<std::size_t>(mesh.point_count()));
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(3));
  for (int n = 0; n < mesh.point_count(); ++n)
    mesh.points.row(number[static_cast<std::size_t>(n)]) = model.mesh->points.row(n);
  for (int& node : mesh.nodes) node = number[static_cast<std::size_t>(node)];
  for (int& node : model.steps[0].prescribed[0].nodes) node = number[static_cast<std::size_t>(node)];
  model.mesh = std::make_shared<const Mesh>(mesh);
  const Points shuffled = displacement(model);
  Points back = shuffled;
  for (int n = 0; n < mesh.point_count(); ++n) back.row(n) = shuffled.row(number[static_cast<std::size_t>(n)]);
  EXPECT_LT(difference(back, plain), 1e-8);
}

TEST_P(Invariance, ARigidMotionOfTheSceneTurnsItAndChangesItByLessThan1e8) {
  Model model = beam();
  const Points plain = displacement(model);
  const Mat3 R = Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  Mesh mesh = *model.mesh;
  for (int n = 0; n < mesh.point_count(); ++n)
    mesh.points.row(n) = (R * model.mesh->points.row(n).transpose() + Vec3(3, -1, 2)).transpose();
  model.mesh = std::make_shared<const Mesh>(mesh);
  model.steps[0].gravity = R * model.steps[0].gravity;
  const Points back = displacement(model) * R;  // rows: R^T u
  EXPECT_LT(difference(back, plain), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Elements, Invariance,
                         ::testing::Values(Body{"tet4", CellKind::tet4, Formulation::standard},
                                           Body{"fbar", CellKind::tet4, Formulation::fbar},
                                           Body{"tet10", CellKind::tet10, Formulation::standard},
                                           Body{"tet10SR", CellKind::tet10, Formulation::single_rotation},
                                           Body{"mixed", CellKind::tet10, Formulation::mixed}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace msml::fe
