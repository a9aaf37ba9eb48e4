// SPDX-License-Identifier: GPL-3.0-or-later
// The cantilever of the comparison with other programs: one run, one line of JSON.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "msml/core/error.hpp"
#include "msml/run/memory.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/materials/neo_hookean.hpp"
#include "tests/bench/wake.hpp"
#include "tests/solver/meshes.hpp"

namespace {

using namespace msml;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr const char* usage =
    "usage: beam_bench WORK KIND N NU SOLVER [THREADS [COUNT]]\n"
    "  WORK    static: small strain; neo: neo-Hookean equilibrium; step: co-rotated implicit Euler, dt = 1/30;\n"
    "          push: the same, pushed from side to side from step 20 on\n"
    "  KIND    tet4, tet10 or tet10SR\n"
    "  N       5 N x N x N cubes of six tetrahedra\n"
    "  NU      Poisson's ratio\n"
    "  SOLVER  automatic, direct, multigrid, incompleteCholesky, blockJacobi\n"
    "  COUNT   time steps (60), or load steps of neo (1)\n";

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Choice {
  std::string work, kind;
  int n = 4;
  double poisson_ratio = 0.3;
  std::string solver;
  int threads = 2, count = 0;  ///< 0: as the usage says
  bool takes_steps() const { return work == "step" || work == "push"; }
};

Choice read(const std::vector<std::string>& words) {
  Choice choice{words.at(0), words.at(1), std::stoi(words.at(2)), std::stod(words.at(3)), words.at(4)};
  if (words.size() > 5) choice.threads = std::stoi(words[5]);
  if (words.size() > 6) choice.count = std::stoi(words[6]);
  return choice;
}

void choose_solver(const std::string& name, fe::Settings& settings) {
  if (name == "automatic") return;
  settings.linear_solver = name == "direct" ? fe::LinearSolver::direct : fe::LinearSolver::cg;
  if (name == "direct") return;
  const std::map<std::string, fe::Preconditioner> preconditioners{
      {"blockJacobi", fe::Preconditioner::block_jacobi},
      {"incompleteCholesky", fe::Preconditioner::incomplete_cholesky},
      {"multigrid", fe::Preconditioner::multigrid}};
  settings.preconditioner = preconditioners.at(name);
}

/// mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 with the moduli of E = 1e5.
std::shared_ptr<const fe::Law> neo_hookean(double poisson_ratio) {
  const fe::Lame lame = fe::lame_of(1e5, poisson_ratio);
  return std::make_shared<fe::PotentialLaw<fe::IsochoricNeoHookean>>(
      fe::IsochoricNeoHookean<fe::Lanes>{fe::lanes_of(lame.mu)}, fe::make_volumetric("J1", lame.bulk()),
      fe::LawFacts{.name = "neoHookean", .shear_modulus = lame.mu, .poisson_ratio = poisson_ratio});
}

/// A load as large as the weight that pushes sideways from step 20 on, every 25 steps to the other side.
fe::BodyForce pushes(const fe::Model& model) {
  const double dt = model.steps[0].dt;
  const auto side = [dt](double t) {
    const int step = static_cast<int>(std::lround(t / dt));
    return step < 20 ? 0.0 : (step - 20) / 25 % 2 == 0 ? 1.0 : -1.0;
  };
  return {.name = "pushes",
          .elements = model.regions[0].elements,
          .value = Vec3(0, 9.81 * model.regions[0].density, 0),
          .factor = fe::TimeFunction(side)};
}

fe::Model model_of(const Choice& choice) {
  const bool step = choice.takes_steps();
  fe::Model model = fe::testing::beam_model(choice.n, choice.kind == "tet4" ? CellKind::tet4 : CellKind::tet10,
                                            choice.poisson_ratio, step ? fe::Strain::corotated : fe::Strain::small);
  if (choice.work == "neo") model.regions[0].law = neo_hookean(choice.poisson_ratio);
  if (choice.kind == "tet10SR") model.formulation = fe::Formulation::single_rotation;
  fe::Settings& settings = model.settings;
  choose_solver(choice.solver, settings);
  settings.threads = choice.threads;
  settings.integrator = step ? fe::Integrator::implicit_euler : fe::Integrator::static_;
  if (step) {
    settings.newton_iterations = 1;
    settings.linear_tolerance = 1e-6;
    model.steps[0].dt = 1.0 / 30;
    model.steps[0].count = choice.count > 0 ? choice.count : 60;
    if (choice.work == "push") model.steps[0].body_forces = {pushes(model)};
  } else {
    settings.linear_tolerance = 1e-8;
    settings.load_steps = std::max(1, choice.count);
  }
  return model;
}

/// The first step, the median of the first sixty, while the body swings, and of later ones, when it has come
/// to rest and costs less, and the worst of all but the first.
void add_steps(std::vector<double> times, Json& json) {
  if (times.size() < 2) return;
  const auto median = [](std::vector<double> some) {
    std::sort(some.begin(), some.end());
    return some[some.size() / 2];
  };
  constexpr std::size_t swings = 60;
  const auto end = times.begin() + static_cast<long>(std::min(times.size(), swings));
  json["first"] = times[0];
  json["step"] = median({times.begin() + 1, end});
  if (times.size() >= 5 * swings) json["rest"] = median({times.begin() + 4 * swings, times.end()});
  json["worst"] = *std::max_element(times.begin() + 1, times.end());
}

Json run(const Choice& choice) {
  const std::size_t before = own_memory();
  const fe::Model model = model_of(choice);
  std::vector<double> times;
  Vec3 at_13 = Vec3::Zero();
  wake_processors(0.3, [] {});
  const Clock::time_point start = Clock::now();
  Clock::time_point last = start;
  double answer = 0;
  const fe::Outcome outcome = fe::solve(model, [&](const fe::State& state) {
    if (state.increment > 0) times.push_back(since(last));
    if (state.increment == 13) at_13 = fe::testing::tip(model, state);
    answer = since(start);
    last = Clock::now();
    return true;
  });
  const double total = since(start);
  const bool step = choice.takes_steps();
  const Vec3 tip = step ? at_13 : fe::testing::tip(model, outcome.state);
  Json json{{"work", choice.work},
            {"kind", choice.kind},
            {"n", choice.n},
            {"nu", choice.poisson_ratio},
            {"solver", choice.solver},
            {"threads", choice.threads},
            {"elements", model.mesh->cell_count()},
            {"unknowns", 3 * model.mesh->point_count()},
            {"tip", {tip[0], tip[1], tip[2]}},
            {"setup", outcome.seconds_setup},
            {"assembly", outcome.seconds_assembly},
            {"linear", outcome.seconds_linear},
            {"answer", answer},
            {"total", total}};
  if (step) add_steps(times, json);
  json["iterations"] = outcome.cg_iterations;
  json["solves"] = outcome.linear_solves;
  json["peak_mb"] = static_cast<double>(peak_memory()) / 1e6;
  const std::size_t mesh_bytes =
      24 * static_cast<std::size_t>(model.mesh->point_count()) + 4 * model.mesh->nodes.size();
  const std::size_t bare = before + program_memory();  // of the process, with code of its libraries that was used
  std::size_t reported = bare + mesh_bytes;
  json["bare_mb"] = 1e-6 * static_cast<double>(bare);
  for (const fe::Held& held : outcome.held) {
    reported += held.bytes;
    json[held.name + "_mb"] = 1e-6 * static_cast<double>(held.bytes);
  }
  json["reported_mb"] = 1e-6 * static_cast<double>(reported);
  json["failure"] = outcome.stop == fe::Stop::converged ? "" : outcome.diagnosis;
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return fmt::print(stderr, "{}", usage), 2;
  try {
    const Json json = run(read({argv + 1, argv + argc}));
    fmt::print("{}\n", json.dump());
    return json["failure"] == "" ? 0 : 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "beam_bench: {}\n{}", error.what(), usage);
    return 2;
  }
}
