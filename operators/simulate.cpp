// SPDX-License-Identifier: GPL-3.0-or-later
// One object of a scene: model, run, results on disk, check.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "msml/core/atomic_file.hpp"
#include "msml/core/operator.hpp"
#include "operators/simulate/check_report.hpp"
#include "operators/simulate/examine_scene.hpp"
#include "operators/simulate/series_writer.hpp"
#include "solver/unknowns.hpp"

namespace msml::operators {

Operator simulate();

namespace {

using simulation::SeriesWriter;
using simulation::Simulation;
using simulation::StateFields;

/// Increments of a step: time steps, or the parts that the loads of a static step come in.
int increments(const fe::Model& model, const fe::Step& step) {
  if (model.settings.arc_length.on) return model.settings.arc_length.steps;
  return model.settings.integrator == fe::Integrator::static_ ? model.settings.load_steps : step.count;
}

/// What was told last, and is told again while an increment takes long.
struct Progress {
  double share = 0;
  std::string words;
};

Progress progress_at(const fe::Model& model, const fe::State& state) {
  int before = 0, all = 0;
  for (std::size_t s = 0; s < model.steps.size(); ++s) {
    if (static_cast<int>(s) < state.step) before += increments(model, model.steps[s]);
    all += increments(model, model.steps[s]);
  }
  const fe::Step& step = model.steps[static_cast<std::size_t>(state.step)];
  return {static_cast<double>(state.increment) / std::max(1, all),
          fmt::format("step '{}' {}/{}  t = {:.6g}", step.name, state.increment - before, increments(model, step),
                      state.time)};
}

using Writers = std::vector<std::unique_ptr<simulation::OutputWriter>>;

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

fe::Outcome run(const Simulation& simulation, Writers& writers, Reporter& reporter, Progress& progress,
                simulation::RunTimes& times) {
  Clock::time_point start = Clock::now();
  return fe::solve(simulation.model, [&](const fe::State& state) {
    const Clock::time_point arrived = Clock::now();
    if (state.increment > 0) times.steps += std::chrono::duration<double>(arrived - start).count();
    StateFields fields(simulation.model, simulation.body, state);
    for (const auto& writer : writers)
      if (writer->wants(state)) writer->write(state, fields);
    ++times.states;
    progress = progress_at(simulation.model, state);
    reporter.progress(progress.share, progress.words);
    times.output += since(arrived);
    start = Clock::now();
    return true;
  });
}

void finish(const Simulation& simulation, const fe::Outcome& outcome, const simulation::RunTimes& times,
            const std::filesystem::path& folder, Reporter& reporter) {
  const simulation::WorstShape worst = simulation::worst_shape(simulation.body);
  const auto warnings = simulation::check_warnings(simulation, outcome, worst);
  const std::string settings = simulation::settings_json(simulation);
  const std::string check = simulation::check_json(simulation, outcome, worst, times, warnings);
  reporter.print(simulation::check_text(simulation, outcome, worst, times));
  for (const std::string& warning : warnings) reporter.warn(warning);
  reporter.record("settings", settings);
  reporter.record("check", check);
  for (const simulation::OutputRequest& request : simulation.outputs)
    write_whole(folder / (request.id + ".json"), simulation::report_json(simulation, settings, check));
}

/// Adds the mesh and the output, and puts the largest first.
void note_memory(const Simulation& simulation, const Writers& writers, fe::Outcome& outcome) {
  std::size_t output = 0;
  for (const auto& writer : writers) output += writer->bytes();
  outcome.held.push_back({"mesh", bytes(Value(simulation.body.mesh))});
  outcome.held.push_back({"output", output});
  std::stable_sort(outcome.held.begin(), outcome.held.end(),
                   [](const fe::Held& a, const fe::Held& b) { return a.bytes > b.bytes; });
}

void simulate_object(Context& context) {
  Simulation simulation = simulation::build_model(context.args(), context.reporter(), context.threads());
  Progress progress;
  Clock::time_point last = Clock::now();
  simulation.model.settings.pulse = [&] {
    if (since(last) < 0.1) return;  // often enough to look alive and to be ended in time
    last = Clock::now();
    context.reporter().progress(progress.share, progress.words);
  };
  simulation.model.check();
  Writers writers = simulation::make_writers(simulation, context.output_folder(), context.reporter());
  simulation::RunTimes times;
  fe::Outcome outcome = [&] {
    try {
      return run(simulation, writers, context.reporter(), progress, times);
    } catch (const Error&) {  // ended from outside: how large the problem is, is known all the same
      context.reporter().record("size", fmt::format("{{\"unknowns\": {}}}", fe::unknowns(simulation.model, 0)));
      throw;
    }
  }();
  // Where the start has no forces, there is no state to write.
  const bool stateless = times.states == 0 && outcome.stop != fe::Stop::unstable_step;
  StateFields fields(simulation.model, simulation.body, outcome.state);
  for (const auto& writer : writers)
    if (!stateless) writer->finish(outcome.state, fields);
  note_memory(simulation, writers, outcome);
  finish(simulation, outcome, times, context.output_folder(), context.reporter());
  if (outcome.stop != fe::Stop::converged)
    throw Error(outcome.diagnosis, simulation.where,
                outcome.stop == fe::Stop::interrupted ? Failure::interrupted : Failure::not_converged);
  for (std::size_t i = 0; i < writers.size(); ++i) context.set(static_cast<int>(i), writers[i]->value());
}

}  // namespace

Operator simulate() {
  Operator op("Simulate", "Computes the deformation of an object of the scene and writes the results it asks for.");
  op.note("The compiler makes one of each <object>; it is not written in a workflow.");
  op.allow({"object", 1, 1});
  op.allow({"solver", 1, 1});
  op.allow({"simulation", 1, 1});
  op.examine(simulation::examine_scene);
  op.run(simulate_object);
  return op;
}

}  // namespace msml::operators
