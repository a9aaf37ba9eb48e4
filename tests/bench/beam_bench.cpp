// SPDX-License-Identifier: GPL-3.0-or-later
// The cantilever of the comparison with other programs: one run, one line.
// usage: beam_bench static|step KIND N NU direct|blockJacobi|incompleteCholesky|multigrid [THREADS [STEPS]]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "msml/run/memory.hpp"
#include "tests/solver/meshes.hpp"

namespace {

using namespace msml;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void choose_solver(const std::string& name, fe::Settings& settings) {
  settings.linear_solver = name == "direct" ? fe::LinearSolver::direct : fe::LinearSolver::cg;
  if (name == "blockJacobi") settings.preconditioner = fe::Preconditioner::block_jacobi;
  if (name == "incompleteCholesky") settings.preconditioner = fe::Preconditioner::incomplete_cholesky;
  if (name == "multigrid") settings.preconditioner = fe::Preconditioner::multigrid;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return 2;
  const std::vector<std::string> words(argv + 1, argv + argc);
  const CellKind kind = words[1] == "tet4" ? CellKind::tet4 : CellKind::tet10;
  const bool step = words[0] == "step";
  fe::Model model = fe::testing::beam_model(std::stoi(words[2]), kind, std::stod(words[3]),
                                            step ? fe::Strain::corotated : fe::Strain::small);
  choose_solver(words[4], model.settings);
  model.settings.threads = words.size() > 5 ? std::stoi(words[5]) : 2;
  const int steps = words.size() > 6 ? std::stoi(words[6]) : 60;
  model.settings.integrator = step ? fe::Integrator::implicit_euler : fe::Integrator::static_;
  if (step) {
    model.settings.newton_iterations = 1;
    model.settings.linear_tolerance = 1e-6;
    model.steps[0].dt = 1.0 / 30;
    model.steps[0].count = steps;
  } else {
    model.settings.linear_tolerance = 1e-8;
  }
  std::vector<double> times;
  Clock::time_point last = Clock::now();
  const Clock::time_point start = last;
  Vec3 at_13 = Vec3::Zero();
  const fe::Outcome outcome = fe::solve(model, [&](const fe::State& state) {
    if (state.increment > 0) times.push_back(since(last));
    if (state.increment == 13) at_13 = fe::testing::tip(model, state);
    last = Clock::now();
    return true;
  });
  const double total = since(start);
  const Vec3 tip = step ? at_13 : fe::testing::tip(model, outcome.state);
  fmt::print(
      "{} {} n={} nu={} {}: unknowns {} tip {:.7f} {:.7f} {:.7f} | total {:.3f} s setup {:.3f} assembly {:.3f} linear "
      "{:.3f} | "
      "its {} solves {} | peak {:.0f} MB matrix {:.0f} factor {:.0f}",
      words[0], words[1], words[2], words[3], words[4], outcome.unknowns, tip[0], tip[1], tip[2], total,
      outcome.seconds_setup, outcome.seconds_assembly, outcome.seconds_linear, outcome.cg_iterations,
      outcome.linear_solves, static_cast<double>(peak_memory()) / 1048576,
      static_cast<double>(outcome.matrix_bytes) / 1048576, static_cast<double>(outcome.factor_bytes) / 1048576);
  if (step && times.size() > 1) {
    const std::vector<double> later(times.begin() + 1, times.end());
    fmt::print(" | first {:.2f} ms median {:.2f} worst {:.2f}", 1e3 * times[0], 1e3 * median(later),
               1e3 * *std::max_element(later.begin(), later.end()));
  }
  fmt::print(" {}\n", outcome.stop == fe::Stop::converged ? "" : outcome.diagnosis);
  return outcome.stop == fe::Stop::converged ? 0 : 3;
}
