// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints and loads put into the steps they act in.
#include <algorithm>
#include <map>
#include <set>

#include "operators/simulate/build_model.hpp"
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

void collect(const Record& root, const std::string& step, std::vector<Placed>& found) {
  for (const Record& child : root.children) {
    const std::string own = text_of(child, "forStep");
    const std::string& here = own.empty() ? step : own;
    if (child.description->category() == "constraint")
      found.push_back({&child, here});
    else
      collect(child, here, found);
  }
}

/// Puts each kind of condition into its list of a step.
struct Put {
  fe::Step& step;
  void operator()(const fe::Prescribed& prescribed) const { step.prescribed.push_back(prescribed); }
  void operator()(const fe::NodalForce& force) const { step.forces.push_back(force); }
  void operator()(const fe::FaceLoad& load) const { step.face_loads.push_back(load); }
  void operator()(const fe::BodyForce& force) const { step.body_forces.push_back(force); }
  void operator()(const fe::Slide& slide) const { step.slides.push_back(slide); }
  void operator()(const std::vector<fe::Spring>& springs) const {
    step.springs.insert(step.springs.end(), springs.begin(), springs.end());
  }
  void operator()(const InitialState&) const {}
  void operator()(const fe::Inlay&) const {}
};

void start_with(fe::Model& model, const InitialState& state) {
  Points& points = state.velocity ? model.initial_velocity : model.initial_displacement;
  if (points.rows() == 0) points = Points::Zero(model.mesh->points.rows(), 3);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) points.row(state.nodes[i]) = state.values[i].transpose();
}

/// Points that the constraints and loads of a step name.
std::vector<bool> named_nodes(const fe::Step& step, const Body& body) {
  std::vector<bool> named(body.solid.size(), false);
  const auto name = [&](const std::vector<int>& nodes) {
    for (const int node : nodes) named[static_cast<std::size_t>(node)] = true;
  };
  for (const fe::Prescribed& prescribed : step.prescribed) name(prescribed.nodes);
  for (const fe::NodalForce& force : step.forces) name(force.nodes);
  for (const fe::FaceLoad& load : step.face_loads)
    for (const fe::Face& face : load.faces) name(face_nodes(*body.mesh, face));
  for (const fe::Slide& slide : step.slides) name(slide.nodes);
  return named;
}

/// The part of a displacement whose nodes are not named.
fe::Prescribed unnamed_part(const fe::Prescribed& whole, const std::vector<bool>& named) {
  fe::Prescribed part = whole;
  part.ramp = fe::Ramp::step;
  part.nodes.clear();
  if (whole.values.size() > 1) part.values.clear();
  for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
    if (named[static_cast<std::size_t>(whole.nodes[i])]) continue;
    part.nodes.push_back(whole.nodes[i]);
    if (whole.values.size() > 1) part.values.push_back(whole.values[i]);
  }
  return part;
}

/// Displacements of earlier steps go on in later ones. `lasting` holds, per step, what it prescribes and lasts.
void carry_on(std::vector<fe::Step>& steps, const std::vector<std::vector<fe::Prescribed>>& lasting, const Body& body,
              Reporter& reporter) {
  std::vector<fe::Prescribed> carried;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const auto named = named_nodes(steps[s], body);
    std::vector<fe::Prescribed> still;
    for (const fe::Prescribed& earlier : carried) {
      fe::Prescribed part = unnamed_part(earlier, named);
      if (part.nodes.empty()) continue;
      reporter.note(fmt::format("step '{}': '{}' of an earlier step still holds {}", steps[s].name, part.name,
                                counted(static_cast<int>(part.nodes.size()), "node")));
      still.push_back(std::move(part));
    }
    steps[s].prescribed.insert(steps[s].prescribed.begin(), still.begin(), still.end());
    carried = std::move(still);
    carried.insert(carried.end(), lasting[s].begin(), lasting[s].end());
  }
}

void warn_unknown_step(const Placed& placed, const std::vector<fe::Step>& steps, Reporter& reporter) {
  std::vector<std::string> names;
  for (const fe::Step& step : steps) names.push_back(step.name);
  // A note: the compiler has warned of it, with the line.
  reporter.note(fmt::format("{} never acts: forStep = '{}' is no step{}; the steps are {}", located(*placed.record),
                            placed.step, did_you_mean(placed.step, names), fmt::join(names, ", ")));
}

/// Where node i is at a time, or at the end of the step for what ramps.
Vec3 value_of(const fe::Prescribed& prescribed, std::size_t i, const Mesh& mesh, double t) {
  const double factor = prescribed.factor ? prescribed.factor(t) : 1;
  if (prescribed.function) return factor * prescribed.function(mesh.points.row(prescribed.nodes[i]).transpose(), t);
  return factor * (prescribed.values.size() == 1 ? prescribed.values.front() : prescribed.values[i]);
}

/// Warns of nodes that two conditions of a step move to different places.
void warn_of_conflicts(const fe::Step& step, const Mesh& mesh, double t, Reporter& reporter) {
  struct Held {
    double value;
    std::size_t by;
  };
  std::map<std::pair<int, int>, Held> held;
  std::map<std::pair<std::size_t, std::size_t>, std::set<int>> conflicts;
  for (std::size_t p = 0; p < step.prescribed.size(); ++p) {
    const fe::Prescribed& prescribed = step.prescribed[p];
    for (std::size_t i = 0; i < prescribed.nodes.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        if (!prescribed.components[k]) continue;
        const Held now{value_of(prescribed, i, mesh, t)[k], p};
        const auto [before, fresh] = held.try_emplace({prescribed.nodes[i], k}, now);
        if (!fresh && before->second.value != now.value) conflicts[{before->second.by, p}].insert(prescribed.nodes[i]);
        before->second = now;
      }
  }
  for (const auto& [pair, nodes] : conflicts)
    reporter.warn(fmt::format(
        "step '{}': '{}' and '{}' hold {} differently (the first is node {}); the later, '{}', wins. "
        "Take the nodes out of the indices of one",
        step.name, step.prescribed[pair.first].name, step.prescribed[pair.second].name,
        counted(static_cast<int>(nodes.size()), "node"), *nodes.begin(), step.prescribed[pair.second].name));
}

}  // namespace

std::vector<Placed> placed_conditions(const Record& root) {
  std::vector<Placed> placed;
  collect(root, "", placed);
  return placed;
}

std::vector<std::string> step_names(const Record& root) {
  std::vector<std::string> names;
  for (const Record* step : all_of(root, "step"))
    names.push_back(step->id.empty() ? fmt::format("step{}", names.size() + 1) : step->id);
  return names;
}

void check_steps(const Placed& condition, const std::vector<std::string>& steps) {
  if (condition.record->tag() != "supportingMesh" || condition.step.empty() || steps.empty()) return;
  if (steps.size() > 1 || steps.front() != condition.step)
    refuse(*condition.record, fmt::format("forStep = '{}': it acts in all steps; leave forStep out", condition.step));
}

void add_conditions(const Record& root, const Body& body, Reporter& reporter, fe::Model& model) {
  std::vector<fe::Step>& steps = model.steps;
  const Surroundings around{.kind = body.kind, .scalar = body.scalar, .settings = &model.settings};
  std::vector<std::string> names;
  for (const fe::Step& step : steps) names.push_back(step.name);
  std::vector<std::vector<fe::Prescribed>> lasting(steps.size());
  for (const Placed& each : placed_conditions(root)) {
    check_condition(*each.record, around);
    check_steps(each, names);
    const Condition condition = make<ConditionBuilder>(*each.record)(body, reporter);
    if (const auto* start = std::get_if<InitialState>(&condition.what)) {
      start_with(model, *start);
      continue;
    }
    if (const auto* inlay = std::get_if<fe::Inlay>(&condition.what)) {
      model.inlays.push_back(*inlay);
      continue;
    }
    bool acts = each.step.empty();
    for (std::size_t s = 0; s < steps.size(); ++s) {
      if (!each.step.empty() && steps[s].name != each.step) continue;
      std::visit(Put{steps[s]}, condition.what);
      if (condition.lasting) lasting[s].push_back(std::get<fe::Prescribed>(condition.what));
      acts = true;
    }
    if (!acts) warn_unknown_step(each, steps, reporter);
  }
  carry_on(steps, lasting, body, reporter);
  double end = 0;
  for (const fe::Step& step : steps) warn_of_conflicts(step, *body.mesh, end += step.dt * step.count, reporter);
}

}  // namespace msml::simulation
