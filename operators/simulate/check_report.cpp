// SPDX-License-Identifier: GPL-3.0-or-later
// The check after a run as text and as JSON.
#include "operators/simulate/check_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "operators/registry.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json vector(const Vec3& v) { return Json::array({number(v[0]), number(v[1]), number(v[2])}); }

const char* name(fe::LinearSolver solver) {
  switch (solver) {
    case fe::LinearSolver::direct:
      return "direct";
    case fe::LinearSolver::cg:
      return "CG";
    default:
      return "auto";
  }
}

const char* name(fe::Preconditioner preconditioner) {
  switch (preconditioner) {
    case fe::Preconditioner::none:
      return "none";
    case fe::Preconditioner::jacobi:
      return "jacobi";
    case fe::Preconditioner::block_jacobi:
      return "blockJacobi";
    case fe::Preconditioner::incomplete_cholesky:
      return "incompleteCholesky";
    case fe::Preconditioner::multigrid:
      return "multigrid";
    default:
      return "auto";
  }
}

std::string line(const std::string& what, const std::string& value) { return fmt::format("  {:<24}{}\n", what, value); }

/// A sum of forces; components of round-off size, relative to the largest force, are shown as 0.
std::string sum_text(Vec3 sum, double scale) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(sum[k]) <= 1e-12 * scale) sum[k] = 0;
  return place(sum);
}

std::string element_at(const Simulation& simulation, int id) {
  return id < 0 ? std::string() : fmt::format(" (element {} at {})", id, place(centroid(*simulation.body.mesh, id)));
}

std::string balance_text(const fe::Check& check, bool dynamic) {
  std::string text =
      line("residual", fmt::format("{:.2e} of {:.4g}, the largest force", check.residual, check.load_scale));
  text += line("sum of loads", sum_text(check.sum_loads, check.load_scale));
  text += line("sum of reactions", sum_text(check.sum_reactions, check.load_scale));
  if (dynamic) {
    text += line("sum of inertia", sum_text(check.sum_inertia, check.load_scale));
    text += line("sum of damping", sum_text(check.sum_damping, check.load_scale));
  }
  return text + line("balance of these", fmt::format("{:.2e}", check.balance));
}

/// What elements have and particles have not.
std::string shape_text(const Simulation& simulation, const fe::Check& check, const WorstShape& worst) {
  std::string text;
  text += line("volume", fmt::format("{:.6g}, changed by {:+.3g} %", check.volume, 100 * check.volume_change));
  text +=
      line("smallest J", fmt::format("{:.4g}{}", check.smallest_J, element_at(simulation, check.smallest_J_element)));
  text += line("largest strain", fmt::format("{:.3g}", check.largest_strain));
  text += line("largest rotation", fmt::format("{:.3g} degrees", check.largest_rotation));
  if (worst.angle_element < 0) return text;
  text += line(dimension(simulation.body.kind) == 3 ? "smallest dihedral angle" : "smallest angle",
               fmt::format("{:.3g} degrees{}", worst.smallest_angle, element_at(simulation, worst.angle_element)));
  text += line("smallest radius ratio",
               fmt::format("{:.3g}{}", worst.radius_ratio, element_at(simulation, worst.ratio_element)));
  return text;
}

/// Steps per second are those of the solver alone: neither set-up nor output.
std::string time_text(const fe::Outcome& outcome, const RunTimes& times, bool dynamic) {
  const double rest = std::max(0.0, times.steps - outcome.seconds_assembly - outcome.seconds_linear);
  std::string text = line(
      "time", fmt::format("{:.3g} s set-up, {:.3g} s assembly, {:.3g} s linear systems, {:.3g} s rest, {:.3g} s output",
                          outcome.seconds_setup, outcome.seconds_assembly, outcome.seconds_linear, rest, times.output));
  if (dynamic && outcome.state.increment > 0 && times.steps > 0)
    text += line("steps per second", fmt::format("{:.4g}", outcome.state.increment / times.steps));
  return text;
}

std::string memory_text(const fe::Outcome& outcome) {
  std::string text;
  for (const fe::Held& held : outcome.held)
    text += fmt::format("{}{} {:.1f} MB", text.empty() ? "" : ", ", held.name, 1e-6 * static_cast<double>(held.bytes));
  return line("memory", text);
}

Json held_json(const fe::Outcome& outcome) {
  Json json;
  for (const fe::Held& held : outcome.held) json[held.name] = held.bytes;
  return json;
}

Json steps_json(const Simulation& simulation) {
  Json steps = Json::array();
  for (const fe::Step& step : simulation.model.steps)
    steps.push_back({{"name", step.name},
                     {"dt", number(step.dt)},
                     {"iterations", step.count},
                     {"gravity", step.gravity_function ? Json("varies") : vector(step.gravity)}});
  return steps;
}

}  // namespace

std::string check_text(const Simulation& simulation, const fe::Outcome& outcome, const WorstShape& worst,
                       const RunTimes& times) {
  const fe::Check& check = outcome.check;
  const bool balanced = outcome.stop == fe::Stop::converged || outcome.stop == fe::Stop::interrupted;
  std::string text = fmt::format("check of '{}' at t = {:.6g}", simulation.name, outcome.state.time);
  const bool inverted = outcome.stop == fe::Stop::inverted_element && check.smallest_J <= 0;
  text += balanced ? "\n"
                   : fmt::format(", the last {}state (stopped: {})\n", inverted ? "" : "good ", fe::name(outcome.stop));
  if (balanced) text += balance_text(check, fe::is_dynamic(simulation.model.settings.integrator));
  text += line("mass", fmt::format("{:.6g}", check.mass));
  if (!simulation.model.regions.empty()) text += shape_text(simulation, check, worst);
  if (check.lowest_period > 0)
    text += line("lowest period", fmt::format("{:.4g}, damped by {:.3g} % a cycle by the time step",
                                              check.lowest_period, 100 * check.damped_per_cycle));
  for (const std::string& note : outcome.notes) text += line("note", note);
  text += line("unknowns", with_commas(outcome.unknowns));
  text += line("solves", fmt::format("{} of Newton, {} linear", outcome.newton_iterations, outcome.linear_solves));
  return text + time_text(outcome, times, fe::is_dynamic(simulation.model.settings.integrator)) + memory_text(outcome);
}

std::string check_json(const Simulation& simulation, const fe::Outcome& outcome, const WorstShape& worst,
                       const RunTimes& times, const std::vector<std::string>& warnings) {
  const fe::Check& check = outcome.check;
  const Json json{
      {"object", simulation.name},
      {"ended", fe::name(outcome.stop)},
      {"diagnosis", outcome.diagnosis},
      {"time", number(outcome.state.time)},
      {"loadFactor", number(outcome.state.load_factor)},
      {"notes", outcome.notes},
      {"recoveries", outcome.recoveries},
      {"stableStep", number(outcome.stable_step)},
      {"residual", number(check.residual)},
      {"loadScale", number(check.load_scale)},
      {"sumOfLoads", vector(check.sum_loads)},
      {"sumOfReactions", vector(check.sum_reactions)},
      {"sumOfInertia", vector(check.sum_inertia)},
      {"sumOfDamping", vector(check.sum_damping)},
      {"balance", number(check.balance)},
      {"volume", number(check.volume)},
      {"volumeChange", number(check.volume_change)},
      {"mass", number(check.mass)},
      {"smallestJ", {{"value", number(check.smallest_J)}, {"element", check.smallest_J_element}}},
      {"largestStrain", number(check.largest_strain)},
      {"largestRotationDegrees", number(check.largest_rotation)},
      {"smallestDihedralAngleDegrees", {{"value", number(worst.smallest_angle)}, {"element", worst.angle_element}}},
      {"smallestRadiusRatio", {{"value", number(worst.radius_ratio)}, {"element", worst.ratio_element}}},
      {"lowestPeriod", number(check.lowest_period)},
      {"dampedPerCycle", number(check.damped_per_cycle)},
      {"unknowns", outcome.unknowns},
      {"newtonIterations", outcome.newton_iterations},
      {"linearSolves", outcome.linear_solves},
      {"cgIterations", outcome.cg_iterations},
      {"seconds",
       {{"setup", number(outcome.seconds_setup)},
        {"steps", number(times.steps)},
        {"assembly", number(outcome.seconds_assembly)},
        {"linear", number(outcome.seconds_linear)},
        {"output", number(times.output)}}},
      {"bytes", held_json(outcome)},
      {"warnings", warnings}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string settings_json(const Simulation& simulation) {
  const fe::Settings& settings = simulation.model.settings;
  Json versions{{"msml", MSML_VERSION}};
  for (const auto& [library, version] : library_versions()) versions[library] = version;
  const Json json{{"versions", versions},
                  {"mesh", simulation.body.mesh->summary()},
                  {"elements", msml::name(simulation.body.kind)},
                  {"timeIntegration", fe::name(settings.integrator)},
                  {"linearSolver", name(settings.linear_solver)},
                  {"preconditioner", name(settings.preconditioner)},
                  {"dampingRayleighRatioMass", number(settings.damping_mass)},
                  {"dampingRayleighRatioStiffness", number(settings.damping_stiffness)},
                  {"mass", settings.lumped_mass || fe::is_explicit(settings.integrator) ? "lumped" : "full"},
                  {"newtonIterations", settings.newton_iterations},
                  {"tolerance", number(settings.tolerance)},
                  {"linearTolerance", number(settings.linear_tolerance)},
                  {"lineSearch", settings.line_search},
                  {"adaptiveStep", settings.adaptive_step},
                  {"arcLength", settings.arc_length.on},
                  {"allowUnstable", settings.allow_unstable},
                  {"allowInverted", settings.allow_inverted},
                  {"untangle", settings.untangle},
                  {"loadSteps", settings.load_steps},
                  {"threads", settings.threads},
                  {"steps", steps_json(simulation)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string report_json(const Simulation& simulation, const std::string& settings, const std::string& check) {
  const Json json{{"object", simulation.name}, {"settings", Json::parse(settings)}, {"check", Json::parse(check)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace msml::simulation
