// SPDX-License-Identifier: GPL-3.0-or-later
// Springs between nodes, to a point, and from nodes to points in space.
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

struct SpringKeys {
  Key<Formula> stiffness, damping, rest;
  Key<std::vector<double>> table;
};

Key<std::vector<double>> add_spring_table(Description& tag) {
  // Springs that push the harder the longer they are hold nothing.
  return add_table(tag, "the force of the spring and its damper (stiffness and damping); each factor is >= 0", true);
}

SpringKeys add_spring(Description& tag) {
  return {
      tag.parameter<Formula>(
          "stiffness", {.unit = "force/length",
                        .range = positive(),
                        .doc = "tension per length: a number, or an expression in X, Y, Z of its first end and t"}),
      tag.parameter<Formula>(
          "damping", {.unit = "force time/length",
                      .range = nonnegative(),
                      .fallback = 0.0,
                      .doc = "force per rate of the length; in all directions where restLength is 0; expressions too. "
                             "Its line in time steps is that of dampingRayleighRatioStiffness's K"}),
      tag.parameter<Formula>(
          "restLength",
          {.unit = "length",
           .range = nonnegative(),
           .optional = true,
           .doc = "where it is free of force; absent: the distance in the reference mesh; expressions too"}),
      add_spring_table(tag)};
}

Key<std::string> add_step(Description& tag) {
  return tag.parameter<std::string>(
      "forStep", {.optional = true, .doc = "name of the step it acts in; absent: as the constraint around it says"});
}

Vec3 point_of(const std::vector<double>& numbers, std::size_t i = 0) {
  return Vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
}

double value_at(const Record& record, Key<Formula> key, const Vec3& X) { return function(record, key)(X, 0); }

/// The number of a spring at X as time goes on; empty where it stays.
fe::TimeFunction in_time(const Function& number, const Vec3& X, const fe::TimeFunction& factor) {
  if (!number.of_time() && !factor) return {};
  return {[=](double t) { return number(X, t) * (factor ? factor(t) : 1.0); }, factor.kinks};
}

/// What changes with time. `keys.rest` may be absent.
void set_times(const Record& record, const SpringKeys& keys, const Vec3& X, fe::Spring& spring) {
  const fe::TimeFunction factor = read_table(record, keys.table);
  spring.stiffness_at = in_time(function(record, keys.stiffness), X, factor);
  if (spring.damping > 0 || function(record, keys.damping).of_time())
    spring.damping_at = in_time(function(record, keys.damping), X, factor);
  if (record.has(keys.rest)) spring.rest_at = in_time(function(record, keys.rest), X, {});
}

fe::Spring spring_of(const Record& record, const SpringKeys& keys, int first, int second, const Vec3& point,
                     const Mesh& mesh) {
  const Vec3 end = second < 0 ? point : Vec3(mesh.points.row(second).transpose());
  const Vec3 start = mesh.points.row(first).transpose();
  fe::Spring spring{.name = label(record),
                    .first = first,
                    .second = second,
                    .point = point,
                    .stiffness = value_at(record, keys.stiffness, start),
                    .damping = value_at(record, keys.damping, start),
                    .rest = record.has(keys.rest) ? value_at(record, keys.rest, start) : (end - start).norm()};
  set_times(record, keys, start, spring);
  return spring;
}

int node_of(const Record& record, Key<Integer> key, const Body& body) {
  const Integer node = record[key];
  const std::string& name = record.description->slots()[static_cast<std::size_t>(key.slot)].name;
  if (node >= body.mesh->point_count())
    refuse(record,
           fmt::format("{} = {} is no node; the mesh has nodes 0 to {}", name, node, body.mesh->point_count() - 1));
  if (!body.solid[static_cast<std::size_t>(node)])
    refuse(record, fmt::format("{} = {} belongs to no element, so that nothing moves there", name, node));
  return static_cast<int>(node);
}

/// The node of the body nearest to a place, which must lie within a hundredth of the mesh's diagonal.
int nearest_node(const Record& record, const Vec3& x, const Body& body) {
  int best = -1;
  double least = 0;
  for (int n = 0; n < body.mesh->point_count(); ++n) {
    if (!body.solid[static_cast<std::size_t>(n)]) continue;
    const double distance = (body.mesh->points.row(n).transpose() - x).norm();
    if (best < 0 || distance < least) best = n, least = distance;
  }
  if (best < 0 || least > 0.01 * diagonal(*body.mesh))
    refuse(record,
           fmt::format("no node lies near the moving point {}; the nearest is {:.4g} away, and the body spans {}",
                       place(x), least, bounds(body)));
  return best;
}

}  // namespace

ConditionFactory spring() {
  ConditionFactory tag("spring", "constraint", "A spring between two nodes, with a damper beside it.");
  const auto first = tag.parameter<Integer>("first", {.range = nonnegative(), .doc = "id of a node"});
  const auto second = tag.parameter<Integer>("second", {.range = nonnegative(), .doc = "id of another node"});
  const SpringKeys keys = add_spring(tag);
  add_step(tag);
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const int one = node_of(record, first, body), two = node_of(record, second, body);
      return {std::vector<fe::Spring>{spring_of(record, keys, one, two, Vec3::Zero(), *body.mesh)}};
    };
  });
  return tag;
}

ConditionFactory spring_to_point() {
  ConditionFactory tag("springToPoint", "constraint", "Springs from nodes to one point in space, with dampers beside.");
  add_common(tag, "the nodes, each with a spring of its own; or faces or elements, whose nodes are meant");
  const auto point =
      tag.parameter<std::vector<double>>("point", {.unit = "length", .counts = {3}, .doc = "where they are fixed"});
  const SpringKeys keys = add_spring(tag);
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      std::vector<fe::Spring> springs;
      for (const int node : select_nodes(record, body, reporter).nodes)
        springs.push_back(spring_of(record, keys, node, -1, point_of(record[point]), *body.mesh));
      return {springs};
    };
  });
  return tag;
}

ConditionFactory spring_mesh_to_fixed() {
  ConditionFactory tag("springMeshToFixed", "constraint", "Springs from points of the mesh to points in space.");
  const auto stiffness = tag.parameter<Formula>(
      "stiffness", {.unit = "force/length",
                    .range = positive(),
                    .doc = "force per distance: a number, or an expression in X, Y, Z of the node and t"});
  const auto damping = tag.parameter<Formula>("rayleighStiffnes",
                                              {.unit = "time",
                                               .range = nonnegative(),
                                               .fallback = 0.0,
                                               .doc = "damping over stiffness (spelled so in MSML); expressions too"});
  const auto fixed = tag.parameter<std::vector<double>>(
      "fixedPoints", {.unit = "length", .multiple_of = 3, .doc = "points in space, x y z each"});
  const auto moving = tag.parameter<std::vector<double>>(
      "movingPoints", {.unit = "length",
                       .multiple_of = 3,
                       .doc = "points of the mesh, as many; the nearest node of the body is taken"});
  const auto table = add_spring_table(tag);
  add_step(tag);
  tag.note("The springs have no rest length: each pulls its point of the mesh to its point in space.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter&) -> Condition {
      const auto &from = record[moving], &to = record[fixed];
      if (from.size() != to.size())
        refuse(record, fmt::format("movingPoints has {} points, but fixedPoints {}; each spring needs one of both",
                                   from.size() / 3, to.size() / 3));
      std::vector<fe::Spring> springs;
      for (std::size_t i = 0; 3 * i < from.size(); ++i) {
        const int node = nearest_node(record, point_of(from, i), body);
        const Vec3 X = body.mesh->points.row(node).transpose();
        const double k = value_at(record, stiffness, X);
        fe::Spring& spring = springs.emplace_back();
        spring = {.name = label(record),
                  .first = node,
                  .point = point_of(to, i),
                  .stiffness = k,
                  .damping = value_at(record, damping, X) * k};
        const Function number = function(record, stiffness), ratio = function(record, damping);
        spring.stiffness_at = in_time(number, X, read_table(record, table));
        if (spring.stiffness_at || ratio.of_time())
          spring.damping_at = {
              [=, k = spring.stiffness_at](double t) { return ratio(X, t) * (k ? k(t) : number(X, t)); },
              spring.stiffness_at.kinks};
      }
      return {springs};
    };
  });
  return tag;
}

}  // namespace msml::simulation
