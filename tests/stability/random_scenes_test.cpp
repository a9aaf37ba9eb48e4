// SPDX-License-Identifier: GPL-3.0-or-later
// 500 scenes drawn at random: every one ends in equilibrium, or in a diagnosis from a closed list of causes.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <map>

#include "msml/core/error.hpp"
#include "tests/stability/random_scenes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

TEST(RandomScenes, EndInEquilibriumOrInADiagnosis) {
  std::map<std::string, int> counts;
  double longest = 0;
  for (unsigned seed = 1; seed <= 500; ++seed) {
    const Drawn drawn = draw_scene(seed);
    SCOPED_TRACE(drawn.words);
    const auto begin = std::chrono::steady_clock::now();
    try {
      const Outcome outcome = solve(drawn.model, {});
      const bool well = outcome.stop == Stop::converged;
      ++counts[name(outcome.stop)];
      EXPECT_TRUE(outcome.state.displacement.allFinite());
      EXPECT_TRUE(outcome.state.velocity.allFinite());
      EXPECT_TRUE(outcome.state.reaction.allFinite());
      EXPECT_EQ(outcome.diagnosis.empty(), well);
      EXPECT_EQ(outcome.diagnosis.find("nan"), std::string::npos) << outcome.diagnosis;
      // One linear solve per step leaves what it leaves; explicit methods solve nothing.
      if (well && drawn.model.settings.newton_iterations > 1) {
        EXPECT_LE(outcome.check.residual, 1e-6);
      }
    } catch (const Error& error) {
      ++counts["refused"];
      ADD_FAILURE() << error.what();  // nothing that is drawn is to be refused
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_LT(seconds, 10);
    longest = std::max(longest, seconds);
  }
  for (const auto& [cause, count] : counts) std::printf("%4d %s\n", count, cause.c_str());
  std::printf("longest %.2f s\n", longest);
}

/// A scene in which one thing was made wrong on purpose, and the word that must be in what is said of it.
struct Planted {
  std::string cause, word;
  Model model;
};

Mesh moved_mesh(const Model& model, const std::function<void(Mesh&)>& change) {
  Mesh mesh = *model.mesh;
  change(mesh);
  return mesh;
}

/// Ten scenes each of five causes.
Planted planted(unsigned seed) {
  Draw draw(1000 + seed);
  std::string words;
  const int n = 1 + draw.index(2);
  Model model = make_model(box_mesh(2 * n, n, n, {drawn_length, 1, 1}, CellKind::tet4), {});
  const auto any = [](const Vec3&) { return true; };
  const double nu = draw.number(0, 0.45);
  model.regions[0].law = draw_law(draw, Family::corotated, false, words);
  model.steps[0].prescribed = {fix(points_where(*model.mesh, at_wall))};
  model.settings.load_steps = 2 + draw.index(8);
  const Vec3 direction = Vec3(draw.number(0.1, 1), draw.number(-1, 1), draw.number(-1, 1)).normalized();
  const FaceLoad pull{.name = "pull", .faces = faces_where(*model.mesh, at_end), .tractions = {direction}};
  switch (seed % 5) {
    case 0:  // the stable step is found, and exceeded by 5 % to a thousandfold
      model.settings.integrator = draw.chance(0.5) ? Integrator::symplectic_euler : Integrator::central_difference;
      model.settings.lumped_mass = true;
      model.steps[0].face_loads = {pull};
      model.steps[0].dt = 1;
      model.steps[0].dt = solve(model, {}).stable_step * draw.power(1.05, 1000);
      return {"time step over the limit", "is unstable above", model};
    case 1:  // the end is pushed beyond the wall, sideways motion held
      model.regions[0].law = neo_hookean("log", drawn_young, nu);
      model.steps[0].prescribed.push_back(fix(points_where(*model.mesh, any), false, true, true));
      model.steps[0].prescribed.push_back(Prescribed{.name = "end",
                                                     .nodes = points_where(*model.mesh, at_end),
                                                     .values = {Vec3(-drawn_length * draw.number(1.1, 3), 0, 0)}});
      return {"inverted element", "inverted element", model};
    case 2:
      model.steps[0].prescribed.clear();
      model.steps[0].face_loads = {pull};
      return {"unconstrained motion", "rigid", model};
    case 3: {  // past the turn of P = E/2 l (l^2 - 1)
      model.regions[0].law =
          law_by_name("stVenantKirchhoffMaterial", {{"youngModulus", drawn_young}, {"poissonRatio", 0.0}});
      model.steps[0].prescribed.push_back(fix(points_where(*model.mesh, any), false, true, true));
      FaceLoad press = pull;
      press.tractions = {Vec3(-drawn_young / (3 * std::sqrt(3.0)) * draw.power(1.02, 10), 0, 0)};
      model.steps[0].face_loads = {press};
      return {"load past a limit point", "pass a limit point", model};
    }
    default: {  // one corner of an element pushed through the face opposite
      const int node = draw.index(model.mesh->point_count());
      model.mesh = std::make_shared<const Mesh>(moved_mesh(model, [&](Mesh& mesh) {
        mesh.points.row(node) += (3 * (Vec3(1, 0.5, 0.5) - mesh.points.row(node).transpose())).transpose();
        if ((mesh.points.row(node) - Vec3(1, 0.5, 0.5).transpose()).norm() < 1e-9) mesh.points(node, 0) += 2;
      }));
      model.steps[0].face_loads = {pull};
      return {"bad element", "inverted or flat in the reference mesh", model};
    }
  }
}

TEST(PlantedCauses, AreNamedRight) {
  std::map<std::string, int> named;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Planted scene = planted(seed);
    std::string said;
    try {
      const Outcome outcome = solve(scene.model, {});
      said = outcome.diagnosis;
      EXPECT_TRUE(outcome.state.displacement.allFinite());
    } catch (const Error& error) {
      said = error.what();
    }
    const bool right = !said.empty() && said.find(scene.word) != std::string::npos;
    named[scene.cause] += right;
    EXPECT_TRUE(right) << seed << ", " << scene.cause << ": " << said;
  }
  for (const auto& [cause, count] : named) std::printf("%3d of 10 %s\n", count, cause.c_str());
}

}  // namespace
}  // namespace msml::fe
