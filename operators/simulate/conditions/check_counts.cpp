// SPDX-License-Identifier: GPL-3.0-or-later
// How many numbers a condition has, against what it acts on.
#include <algorithm>
#include <set>

#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

template <class T>
const T* value_of(const Record& record, const std::string& attribute) {
  const int slot = record.description->find(attribute);
  return slot < 0 ? nullptr : std::get_if<T>(&record.values[static_cast<std::size_t>(slot)]);
}

bool constant(const Formulas& formulas) {
  return std::ranges::all_of(formulas, [](const Formula& each) { return each.constant(); });
}

/// The attribute that holds a vector for all nodes or one for each, or "".
std::string of_nodes(const std::string& tag) {
  if (tag == "displacementConstraint" || tag == "initialDisplacement") return "displacement";
  if (tag == "forceConstraint") return "force";
  return tag == "initialVelocity" ? "velocity" : "";
}

/// Tags whose nodes each count once.
bool selects_nodes(const std::string& tag) {
  constexpr const char* tags[] = {"fixedConstraint", "symmetryPlane", "roller", "springToPoint", "fixedValue"};
  return !of_nodes(tag).empty() || std::ranges::find(tags, tag) != std::end(tags);
}

void check_once(const Record& record, const IndexSet& set, const fe::Tell& tell) {
  std::set<int> seen, twice;
  for (const int id : set.ids)
    if (!seen.insert(id).second && twice.insert(id).second)
      tell(fault_of(record, fmt::format("indices lists node {} twice", id)));
}

void check_points(const Record& record, const fe::Tell& tell) {
  const auto* from = value_of<std::vector<double>>(record, "movingPoints");
  const auto* to = value_of<std::vector<double>>(record, "fixedPoints");
  if (from != nullptr && to != nullptr && from->size() != to->size())
    tell(fault_of(record, fmt::format("movingPoints has {}, but fixedPoints {}; each spring needs one of both",
                                      counted(static_cast<long long>(from->size() / 3), "point"), to->size() / 3)));
}

/// Hands what `check` throws to `tell`.
template <class Check>
void attempt(const fe::Tell& tell, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    tell(error);
  }
}

}  // namespace

void check_per_node(const Record& record, const std::string& attribute, const Formulas& formulas, bool of_nodes,
                    int listed) {
  if (formulas.size() == 3) return;
  if (!constant(formulas))
    refuse(record,
           fmt::format("{} has expressions in a list of one vector per node; write 3 expressions for all nodes, "
                       "where X, Y and Z tell them apart",
                       attribute));
  if (!of_nodes)
    refuse(record, fmt::format("{} has {} numbers; without indices, and with those of faces or elements, 3 are "
                               "allowed, the same for all nodes",
                               attribute, formulas.size()));
  if (listed >= 0 && formulas.size() != 3 * static_cast<std::size_t>(listed))
    refuse(record, fmt::format("{} has {} numbers; allowed are 3, or 3 for each of the {} in indices ({})", attribute,
                               formulas.size(), counted(listed, "node"), 3 * listed));
}

void check_per_face(const Record& record, const std::string& attribute, const Formulas& formulas, bool of_faces,
                    int listed) {
  if (formulas.size() == 1 || formulas.size() == 3) return;
  if (!of_faces || (listed >= 0 && formulas.size() != static_cast<std::size_t>(listed)))
    refuse(record, fmt::format("{} has {} numbers; allowed are 1, 3 (a traction vector){}", attribute, formulas.size(),
                               of_faces ? fmt::format(", or one for each of the {} in indices", counted(listed, "face"))
                                        : std::string(" where indices counts nodes")));
  if (!constant(formulas))
    refuse(record, fmt::format("{} has expressions in a list of one number per face; write one expression for all "
                               "faces, where X, Y and Z tell them apart",
                               attribute));
}

void check_counts(const Record& condition, const fe::Tell& tell) {
  check_points(condition, tell);
  const int slot = condition.description->find("indices");
  if (slot < 0) return;
  const auto s = static_cast<std::size_t>(slot);
  const auto* literal = std::get_if<IndexSetPtr>(&condition.values[s]);
  const IndexSet* set = literal == nullptr ? nullptr : literal->get();
  const int listed = set == nullptr ? -1 : static_cast<int>(set->ids.size());
  const bool nodes = set == nullptr ? condition.given[s] : set->kind == Indexed::nodes;
  const std::string attribute = of_nodes(condition.tag());
  if (const auto* numbers = value_of<Formulas>(condition, attribute); numbers != nullptr)
    attempt(tell, [&] { check_per_node(condition, attribute, *numbers, nodes, listed); });
  if (const auto* numbers = value_of<Formulas>(condition, "pressure"); numbers != nullptr)
    attempt(tell, [&] { check_per_face(condition, "pressure", *numbers, set == nullptr || !nodes, listed); });
  if (set != nullptr && nodes && selects_nodes(condition.tag())) check_once(condition, *set, tell);
}

}  // namespace msml::simulation
