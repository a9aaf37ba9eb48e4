// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene leaves open, filled in.
#include "operators/simulate/fillings.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "msml/core/formula.hpp"
#include "solver/materials/fibres.hpp"

namespace msml::simulation {
namespace {

constexpr int of_expressions = 9, of_faults = 36;  // fillings: enough for the numbers below, and for all choices

bool varies(const Value& value) {
  const auto changes = [](const Formula& formula) { return !formula.constant(); };
  const auto* formula = std::get_if<Formula>(&value);
  const auto* list = std::get_if<Formulas>(&value);
  return (formula != nullptr && changes(*formula)) || (list != nullptr && std::ranges::any_of(*list, changes));
}

bool absent(const Record& record, std::size_t s) {
  const Slot& slot = record.description->slots()[s];
  return slot.role == Role::parameter && type(record.values[s]) == Type::nothing && (record.given[s] || slot.required);
}

bool varying(const Record& record, std::size_t s) {
  const std::string& category = record.description->category();
  if (category != "material" && category != "mass" && category != "prony") return false;
  const auto* text = std::get_if<std::string>(&record.values[s]);
  return varies(record.values[s]) || (text != nullptr && record.description->slots()[s].unit == "direction" &&
                                      fe::direction_numbers(*text).empty());
}

/// A number of the range near x.
double fitted(const Range& range, double x) {
  for (const double y : {x, 0.3, 1.0, -1.0, 0.5 * (range.low + range.high), range.low + 1, range.high - 1})
    if (range.contains(y)) return y;
  return x;
}

double number_of(const Range& range, int filling, const Formula& formula = {}) {
  constexpr double tries[] = {0.3, 1e12, -0.3, -1e12, 1e-6};
  const int turn = filling % of_expressions;
  if (formula.constant()) return fitted(range, turn < 5 ? tries[turn] : turn);
  if (turn < 5) return fitted(range, tries[turn]);
  try {
    const double scale = std::pow(10.0, 3 * (turn - 6));
    return fitted(range, Function(formula, "", {}, {})(scale * Vec3(0.31, 0.53, 0.71), 0));
  } catch (const Error&) {
    return fitted(range, tries[0]);  // not finite there
  }
}

/// Which of `count` the n-th open parameter takes: the first one first, and each once in every `count` fillings.
std::size_t choice(int filling, std::size_t count, int n) {
  const auto turn = static_cast<std::size_t>(filling);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937 random(static_cast<unsigned>(n) * 1000 + static_cast<unsigned>(turn / count));
  if (turn >= count) std::shuffle(order.begin(), order.end(), random);
  return order[turn % count];
}

Value list_of(const Slot& slot, int filling) {
  const std::size_t length = slot.counts.empty() ? slot.multiple_of : slot.counts.front();
  if (length == 0) return {};
  const double x = number_of(slot.range, filling);
  if (slot.type == Type::numbers) return std::vector<double>(length, x);
  return Formulas(length, Formula(x));
}

/// A value that the slot allows; nothing where none is known.
Value value_of(const Slot& slot, int filling, int n) {
  switch (slot.type) {
    case Type::number:
      return number_of(slot.range, filling);
    case Type::formula:
      return Formula(number_of(slot.range, filling));
    case Type::integer:
      return static_cast<Integer>(fitted(slot.range, filling + n));
    case Type::boolean:
      return choice(filling, 2, n) == 1;
    case Type::text:
      if (!slot.choices.empty()) return slot.choices[choice(filling, slot.choices.size(), n)];
      return std::string(slot.unit == "direction" ? "1 0 0" : "x");
    case Type::numbers:
    case Type::formulas:
      return list_of(slot, filling);
    default:
      return {};
  }
}

void fill_absent(Record& record, std::size_t s, int filling, int n) {
  const Slot& slot = record.description->slots()[s];
  const bool left_out = !slot.required && (filling % 4 == 0 || slot.type == Type::words);
  record.given[s] = !left_out;
  record.values[s] = left_out ? slot.fallback : value_of(slot, filling, n);
}

void fill_varying(Record& record, std::size_t s, int filling) {
  const Range& range = record.description->slots()[s].range;
  Value& value = record.values[s];
  if (auto* formula = std::get_if<Formula>(&value)) {
    *formula = number_of(range, filling, *formula);
  } else if (auto* list = std::get_if<Formulas>(&value)) {
    for (Formula& each : *list)
      if (!each.constant()) each = number_of(range, filling, each);
  } else {
    value = std::string("1 0 0");
  }
}

void fill(Record& record, int filling, int& n) {
  for (std::size_t s = 0; s < record.values.size(); ++s) {
    if (absent(record, s))
      fill_absent(record, s, filling, n++);
    else if (varying(record, s))
      fill_varying(record, s, filling);
  }
  for (Record& child : record.children) fill(child, filling, n);
}

int fillings_of(const Record& record) {
  int count = 1;
  for (std::size_t s = 0; s < record.values.size(); ++s) {
    if (absent(record, s)) return of_faults;
    if (varying(record, s)) count = of_expressions;
  }
  for (const Record& child : record.children) count = std::max(count, fillings_of(child));
  return count;
}

}  // namespace

Fillings::Fillings(const Record& args) : args_(args), count_(fillings_of(args)) {}

Record Fillings::at(int filling) const {
  Record record = args_;
  int n = 0;
  fill(record, filling, n);
  return record;
}

bool complete(const Record& record) {
  for (std::size_t s = 0; s < record.values.size(); ++s)
    if (absent(record, s)) return false;
  return true;
}

}  // namespace msml::simulation
