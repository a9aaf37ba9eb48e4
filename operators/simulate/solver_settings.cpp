// SPDX-License-Identifier: GPL-3.0-or-later
// The tags `solver` and `step`.
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/idle_attributes.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/settings.hpp"

namespace msml::simulation {
namespace {

struct Keys {
  Key<std::string> integration, linear, preconditioner, unit, mass;
  Key<double> damping_mass, damping_stiffness, tolerance, linear_tolerance;
  Key<Integer> newton, load_steps, threads, old_threads;
  Key<bool> line_search, allow_unstable, adaptive, arc_length, allow_inverted, untangle;
  Key<Integer> arc_steps;
  Key<double> beta, gamma, spectral_radius, step_tolerance, largest_load, largest_displacement;
  Key<std::string> definiteness;
};

const std::map<std::string, fe::Integrator>& integrators() {
  static const std::map<std::string, fe::Integrator> known = [] {
    std::map<std::string, fe::Integrator> names;
    for (const fe::Integrator integrator :
         {fe::Integrator::static_, fe::Integrator::quasi_static, fe::Integrator::implicit_euler,
          fe::Integrator::newmark, fe::Integrator::generalized_alpha, fe::Integrator::forward_euler,
          fe::Integrator::symplectic_euler, fe::Integrator::central_difference})
      names[fe::name(integrator)] = integrator;
    names["NewmarkShapeMatching"] = fe::Integrator::newmark;
    return names;
  }();
  return known;
}

const std::map<std::string, fe::Preconditioner>& preconditioners() {
  static const std::map<std::string, fe::Preconditioner> known{
      {"none", fe::Preconditioner::none},
      {"jacobi", fe::Preconditioner::jacobi},
      {"blockJacobi", fe::Preconditioner::block_jacobi},
      {"incompleteCholesky", fe::Preconditioner::incomplete_cholesky},
      {"multigrid", fe::Preconditioner::multigrid},
      {"auto", fe::Preconditioner::automatic}};
  return known;
}

/// What is wrong with the name of a preconditioner.
std::string preconditioner_problem(const Value& value) {
  const auto* name = std::get_if<std::string>(&value);
  if (name == nullptr || preconditioners().count(*name) > 0 || of_other_program(*name)) return "";
  std::vector<std::string> names;
  for (const auto& entry : preconditioners()) names.push_back(entry.first);
  return fmt::format("'{}' is not one of {}{}", *name, fmt::join(names, ", "), did_you_mean(*name, names));
}

fe::Preconditioner preconditioner(const std::string& name, Reporter& reporter) {
  if (const auto known = preconditioners().find(name); known != preconditioners().end()) return known->second;
  reporter.note(fmt::format("solver: preconditioner {} belongs to another program; taken as auto", name));
  return fe::Preconditioner::automatic;
}

void describe_method(Factory<SettingsBuilder>& tag, Keys& keys) {
  keys.integration = tag.parameter<std::string>(
      "timeIntegration",
      {.fallback = "dynamicImplicitEuler",
       .choices = {"static", "quasiStatic", "dynamicImplicitEuler", "Newmark", "NewmarkShapeMatching",
                   "generalizedAlpha", "forwardEuler", "symplecticEuler", "centralDifference"},
       .doc = "static: loads ramped; quasiStatic: equilibrium at each time step; NewmarkShapeMatching: Newmark; the "
              "last three are explicit, with lumped mass and a largest stable dt"});
  keys.linear = tag.parameter<std::string>(
      "linearSolver", {.fallback = "auto",
                       .choices = {"direct", "iterativeCG", "CG", "GMRES", "auto"},
                       .doc = "direct: sparse Cholesky; CG, GMRES: conjugate gradients; auto and MSML's iterativeCG: "
                              "direct when small, multigrid for larger solids"});
  keys.preconditioner = tag.parameter<std::string>(
      "preconditioner",
      {.fallback = "auto",
       .check = preconditioner_problem,
       .doc = "of conjugate gradients: none, jacobi, blockJacobi, incompleteCholesky, multigrid (solids of "
              "tetrahedra) or auto; names of other programs, written in capitals, count as auto"});
  keys.unit = tag.parameter<std::string>(
      "processingUnit",
      {.fallback = "CPU", .choices = {"CPU", "CPUDouble", "GPU"}, .doc = "all run on the CPU in double precision"});
  keys.mass = tag.parameter<std::string>(
      "mass", {.fallback = "full", .choices = {"full", "lumped"}, .doc = "full: consistent mass matrix"});
  keys.damping_mass = tag.parameter(
      "dampingRayleighRatioMass",
      {.unit = "1/time", .range = nonnegative(), .fallback = 0.0, .doc = "damping matrix alpha M + beta K: alpha"});
  keys.damping_stiffness = tag.parameter(
      "dampingRayleighRatioStiffness",
      {.unit = "time",
       .range = nonnegative(),
       .fallback = 0.0,
       .doc = "damping matrix alpha M + beta K: beta. K turns with the body: it is that of the end of the time step, "
              "which "
              "Newmark and generalizedAlpha iterate to the tolerance and dynamicImplicitEuler to a thousandth of all "
              "forces; with forwardEuler, symplecticEuler and one linear solve per step that of its start. "
              "centralDifference takes it with the velocity that the last two half steps lead to, which is of second "
              "order and halves the stable step of strong damping"});
}

void describe_method_numbers(Factory<SettingsBuilder>& tag, Keys& keys) {
  const fe::Settings usual;
  keys.beta = tag.parameter("beta", {.range = positive(),
                                     .fallback = usual.newmark_beta,
                                     .doc = "of Newmark; 1/4 with gamma 1/2: average acceleration"});
  keys.gamma = tag.parameter("gamma", {.range = closed(0, 1), .fallback = usual.newmark_gamma, .doc = "of Newmark"});
  keys.spectral_radius = tag.parameter(
      "spectralRadius", {.range = closed(0, 1),
                         .fallback = usual.spectral_radius,
                         .doc = "of generalizedAlpha: what a step leaves of the highest frequencies; 1: all"});
  keys.allow_unstable = tag.parameter<bool>(
      "allowUnstable", {.fallback = false, .doc = "run methods beyond their stable time step, to study them"});
}

void describe_steps(Factory<SettingsBuilder>& tag, Keys& keys) {
  const fe::Settings usual;
  keys.adaptive = tag.parameter<bool>(
      "adaptiveStep",
      {.fallback = false,
       .doc = "shorter and longer steps between the reported states, by iterations and error; with prony in "
              "statics at most half its shortest tau. Kinks of tables are met; those of an expression are not known: "
              "take a "
              "dt that sees them"});
  keys.step_tolerance = tag.parameter(
      "stepTolerance", {.range = open(0, 1),
                        .fallback = usual.step_tolerance,
                        .doc = "with adaptiveStep in implicit dynamics: error of a step beside the displacement"});
  keys.arc_length = tag.parameter<bool>(
      "arcLength", {.fallback = false,
                    .doc = "static: follow equilibria past limit points of the load; the first step goes as far as the "
                           "tangent foresees for one of loadSteps parts of it, later ones up to ten times as far"});
  keys.arc_steps = tag.parameter<Integer>(
      "arcSteps", {.range = closed(1, 1000000), .fallback = usual.arc_length.steps, .doc = "of arcLength: states"});
  keys.largest_load =
      tag.parameter("largestLoadFactor", {.range = positive(), .optional = true, .doc = "of arcLength: where it ends"});
  keys.largest_displacement = tag.parameter(
      "largestDisplacement",
      {.unit = "length", .range = positive(), .optional = true, .doc = "of arcLength: of a node, where it ends"});
  keys.allow_inverted = tag.parameter<bool>(
      "allowInverted",
      {.fallback = false,
       .doc =
           "take states in which elements are inside out: where laws have forces there, dynamics passes through such "
           "states in any case, but a run that ends in one has failed"});
  keys.untangle = tag.parameter<bool>(
      "untangle", {.fallback = usual.untangle,
                   .doc = "where elements start inside out or crushed, find the way with the stable neo-Hookean law; "
                          "the answer is that of the scene's own laws"});
}

void describe_control(Factory<SettingsBuilder>& tag, Keys& keys) {
  const fe::Settings usual;
  keys.newton = tag.parameter<Integer>(
      "newtonIterations",
      {.range = closed(1, 1000), .fallback = usual.newton_iterations, .doc = "at most; 1: one linear solve per step"});
  keys.tolerance =
      tag.parameter("tolerance", {.range = open(0, 1),
                                  .fallback = usual.tolerance,
                                  .doc = "of Newton: residual beside the forces, increment that is still missing "
                                         "beside the displacement, root of the energy of that beside the energy stored "
                                         "or the work done; linear problems end after one solution"});
  keys.linear_tolerance = tag.parameter(
      "linearTolerance",
      {.range = open(0, 1),
       .fallback = usual.linear_tolerance,
       .doc = "of conjugate gradients: true residual over the right-hand side; with newtonIterations=1 a right-hand "
              "side that is round-off of forces in balance is left alone"});
  keys.line_search = tag.parameter<bool>("lineSearch", {.fallback = true, .doc = "shorten steps that do not descend"});
  keys.definiteness = tag.parameter<std::string>(
      "definiteness",
      {.fallback = "auto",
       .choices = {"auto", "always", "never"},
       .doc = "a semidefinite tangent of the elements (Teran, Sifakis, Irving and Fedkiw 2005, doi "
              "10.1145/1073368.1073394): where the exact one is indefinite, in each iteration, or never"});
  keys.load_steps = tag.parameter<Integer>(
      "loadSteps", {.range = closed(1, 100000), .fallback = 1, .doc = "static: equal parts that the loads come in"});
  keys.threads = tag.parameter<Integer>(
      "threads", {.range = closed(1, 1024), .optional = true, .doc = "absent: as many as the program may use"});
  keys.old_threads = tag.parameter<Integer>(
      "numParallelProcessesOnCPU",
      {.range = closed(1, 1024), .optional = true, .doc = "MSML's name of threads, which wins over this"});
}

void note_old_names(const Record& record, const Keys& keys, Reporter& reporter) {
  if (record[keys.unit] == "GPU") reporter.note("solver: processingUnit GPU is not there; the CPU is used");
  if (record[keys.linear] == "iterativeCG")
    reporter.note(
        "solver: iterativeCG is taken as auto, which factorises where that is faster; CG insists on iterating");
  if (record[keys.linear] == "GMRES") reporter.note("solver: GMRES is taken as CG, since the matrices are symmetric");
  if (record[keys.integration] == "NewmarkShapeMatching")
    reporter.note("solver: NewmarkShapeMatching is taken as Newmark");
}

fe::Settings read(const Record& record, const Keys& keys, Reporter& reporter, int threads) {
  note_old_names(record, keys, reporter);
  fe::Settings settings;
  settings.integrator = integrators().at(record[keys.integration]);
  const std::string& linear = record[keys.linear];
  settings.linear_solver = linear == "direct"                            ? fe::LinearSolver::direct
                           : linear == "auto" || linear == "iterativeCG" ? fe::LinearSolver::automatic
                                                                         : fe::LinearSolver::cg;
  settings.preconditioner = preconditioner(record[keys.preconditioner], reporter);
  settings.damping_mass = record[keys.damping_mass];
  settings.damping_stiffness = record[keys.damping_stiffness];
  settings.lumped_mass = record[keys.mass] == "lumped";
  settings.newton_iterations = static_cast<int>(record[keys.newton]);
  settings.tolerance = record[keys.tolerance];
  settings.linear_tolerance = record[keys.linear_tolerance];
  settings.line_search = record[keys.line_search];
  settings.definiteness = record[keys.definiteness] == "auto"     ? fe::Definiteness::automatic
                          : record[keys.definiteness] == "always" ? fe::Definiteness::always
                                                                  : fe::Definiteness::never;
  settings.newmark_beta = record[keys.beta];
  settings.newmark_gamma = record[keys.gamma];
  settings.spectral_radius = record[keys.spectral_radius];
  settings.allow_unstable = record[keys.allow_unstable];
  settings.allow_inverted = record[keys.allow_inverted];
  settings.untangle = record[keys.untangle];
  settings.adaptive_step = record[keys.adaptive];
  settings.step_tolerance = record[keys.step_tolerance];
  settings.arc_length.on = record[keys.arc_length];
  settings.arc_length.steps = static_cast<int>(record[keys.arc_steps]);
  if (record.has(keys.largest_load)) settings.arc_length.load = record[keys.largest_load];
  if (record.has(keys.largest_displacement)) settings.arc_length.displacement = record[keys.largest_displacement];
  settings.load_steps = static_cast<int>(record[keys.load_steps]);
  settings.threads = record.has(keys.threads)       ? static_cast<int>(record[keys.threads])
                     : record.has(keys.old_threads) ? static_cast<int>(record[keys.old_threads])
                                                    : threads;
  return settings;
}

}  // namespace

void check_mass_matrix(const Record& solver, const fe::Settings& settings) {
  const int slot = solver.description->find("mass");
  if (fe::is_explicit(settings.integrator) && solver.given[static_cast<std::size_t>(slot)] && !settings.lumped_mass)
    refuse(solver, fmt::format("mass=\"full\" does not go with the explicit timeIntegration=\"{}\", which divides by "
                               "lumped masses: take mass=\"lumped\", or an implicit timeIntegration",
                               fe::name(settings.integrator)));
}

bool of_other_program(const std::string& name) {
  return name.empty() || std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
         });
}

Factory<SettingsBuilder> solver() {
  Factory<SettingsBuilder> tag("solver", "solver", "How the equations are integrated and solved.");
  Keys keys;
  describe_method(tag, keys);
  describe_method_numbers(tag, keys);
  describe_steps(tag, keys);
  describe_control(tag, keys);
  tag.build([=](const Record& record) -> SettingsBuilder {
    return [=, &record](Reporter& reporter, int threads) { return read(record, keys, reporter, threads); };
  });
  return tag;
}

Factory<fe::Step> step() {
  Factory<fe::Step> tag("step", "step", "A stage of the simulation; steps run one after another.");
  const auto name = tag.parameter<std::string>("name", {.optional = true, .doc = "what forStep refers to"});
  const auto dt = tag.parameter("dt", {.unit = "time", .range = positive(), .fallback = 0.05, .doc = "the time step"});
  const auto iterations = tag.parameter<Integer>(
      "iterations", {.range = closed(1, 1e9), .fallback = 100, .doc = "number of time steps; no meaning in static"});
  const auto gravity =
      tag.parameter<Formulas>("gravity", {.unit = "length/time^2",
                                          .fallback = Formulas{0.0, 0.0, -9.81},
                                          .counts = {3},
                                          .doc = "acceleration on all masses, 3 numbers or expressions; a step that "
                                                 "says nothing has earth's, in metres and seconds"});
  const auto table = add_table(tag, "gravity");
  tag.build([=](const Record& record) {
    const std::vector<Function> g = functions(record, gravity);
    fe::Step made{.name = record.has(name) ? record[name] : record.id,
                  .dt = record[dt],
                  .count = static_cast<int>(record[iterations]),
                  .gravity = Vec3::Zero()};
    made.gravity_steady = !record.has(table) && !g[0].of_time() && !g[1].of_time() && !g[2].of_time();
    if (record.has(table)) {
      const fe::TimeFunction factor = read_table(record, table);
      made.gravity_kinks = factor.kinks;
      made.gravity_function = [factor, vector = vector_of(g)](const Vec3& X, double t) {
        return Vec3(factor(t) * vector(X, t));
      };
      return made;
    }
    if (g[0].constant() && g[1].constant() && g[2].constant())
      made.gravity = vector_of(g)(Vec3::Zero(), 0);
    else
      made.gravity_function = vector_of(g);
    return made;
  });
  return tag;
}

}  // namespace msml::simulation
