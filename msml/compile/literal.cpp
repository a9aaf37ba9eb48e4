// SPDX-License-Identifier: GPL-3.0-or-later
// Parsing of literals.
#include "msml/compile/literal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "msml/core/formula.hpp"

namespace msml {

std::string quoted_value(const std::string& text) { return shortened(text); }

namespace {

Parsed problem(const Slot& slot, const std::string& text, const std::string& what) {
  return {{}, fmt::format("{} = {} {}", slot.name, text.empty() ? "''" : quoted_value(text), what)};
}

/// from_chars with an optional plus sign; the whole text must be used up.
template <class T>
std::errc read(const std::string& text, T& value) {
  const std::size_t plus = text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0;
  const char* end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data() + plus, end, value);
  if (code != std::errc()) return code;
  return stop == end && !text.empty() ? std::errc() : std::errc::invalid_argument;
}

std::string number_problem(const Slot& slot, std::errc code, double value) {
  if (code == std::errc::result_out_of_range) return "is out of the range of numbers";
  if (code != std::errc()) return "is not a number";
  if (!std::isfinite(value)) return "is not a finite number";
  if (!slot.range.contains(value)) return "is not " + slot.range.str();
  return {};
}

std::string integer_problem(const Slot& slot, std::errc code, Integer value) {
  if (code == std::errc::result_out_of_range) return "is out of the range of integers";
  if (code != std::errc()) return "is not an integer";
  if (!slot.range.contains(static_cast<double>(value))) return "is not " + slot.range.str();
  return {};
}

Parsed parse_boolean(const Slot& slot, std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* yes : {"true", "1", "yes", "on"})
    if (text == yes) return {true, {}};
  for (const char* no : {"false", "0", "no", "off"})
    if (text == no) return {false, {}};
  return problem(slot, text, "is not a boolean: true or false, 1 or 0, yes or no, on or off");
}

Parsed parse_text(const Slot& slot, const std::string& text) {
  if (slot.choices.empty() || std::find(slot.choices.begin(), slot.choices.end(), text) != slot.choices.end())
    return {text, {}};
  return problem(slot, text,
                 fmt::format("is not one of {}{}", fmt::join(slot.choices, ", "), did_you_mean(text, slot.choices)));
}

std::string length_problem(const Slot& slot, std::size_t count) {
  if (!slot.counts.empty() && std::find(slot.counts.begin(), slot.counts.end(), count) == slot.counts.end())
    return fmt::format("{} has {} values, but needs {}", slot.name, count, fmt::join(slot.counts, " or "));
  if (slot.multiple_of > 0 && (count == 0 || count % slot.multiple_of != 0))
    return fmt::format("{} has {} values, but needs a multiple of {}", slot.name, count, slot.multiple_of);
  return {};
}

/// A list of T; `check` says what is wrong with one entry.
template <class T, class Check>
Parsed parse_list(const Slot& slot, const std::string& text, Check check) {
  std::vector<T> list;
  for (const std::string& part : list_parts(text)) {
    T value{};
    const std::errc code = read(part, value);
    if (const std::string what = check(slot, code, value); !what.empty())
      return {{},
              fmt::format("{}: entry {} of the list = {} {}", slot.name, list.size() + 1, quoted_value(part), what)};
    list.push_back(value);
  }
  if (const std::string what = length_problem(slot, list.size()); !what.empty()) return {{}, what};
  return {std::move(list), {}};
}

/// A number or an expression; one that depends on nothing folds to its number.
Parsed parse_formula(const Slot& slot, const std::string& text, const std::string& label) {
  double value = 0;
  const std::errc code = read(text, value);
  std::string what;
  if (code == std::errc::invalid_argument) {
    const FormulaFacts facts = examine(text);
    if (!facts.problem.empty()) return {{}, fmt::format("{} = {}: {}", label, quoted_value(text), facts.problem)};
    if (facts.of_position || facts.of_time) {
      const std::string never = never_allowed(text, slot.range);
      if (never.empty()) return {Formula(text), {}};
      return {{}, fmt::format("{} = {} {}", label, quoted_value(text), never)};
    }
    value = facts.value;
    what = number_problem(slot, std::errc(), value);
  } else {
    what = number_problem(slot, code, value);
  }
  if (what.empty()) return {Formula(value), {}};
  return {{}, fmt::format("{} = {} {}", label, quoted_value(text), what)};
}

Parsed parse_formulas(const Slot& slot, const std::string& text) {
  Formulas list;
  std::vector<std::string> parts = list_parts(text);
  const bool plain = std::all_of(parts.begin(), parts.end(), [](const std::string& part) {
    double value = 0;
    return read(part, value) != std::errc::invalid_argument;
  });
  if (!plain) parts = expression_parts(text);
  // Blanks may stand in one expression, but where each part is one by itself they divide the list.
  const bool divided =
      std::all_of(parts.begin(), parts.end(), [](const std::string& p) { return examine(p).problem.empty(); });
  if (!divided && length_problem(slot, 1).empty() && text.find(',') == std::string::npos &&
      examine(text).problem.empty())
    parts = {text};
  for (const std::string& part : parts) {
    Parsed entry = parse_formula(slot, part, fmt::format("{}: entry {} of the list", slot.name, list.size() + 1));
    if (!entry.problem.empty()) {
      const bool faulty = entry.problem.find("; an expression may use") != std::string::npos;
      if (faulty && parts.size() > 1 && text.find(',') == std::string::npos)
        entry.problem += "; entries that hold blanks are separated by commas";
      return entry;
    }
    list.push_back(std::get<Formula>(entry.value));
  }
  if (const std::string what = length_problem(slot, list.size()); !what.empty()) return {{}, what};
  return {std::move(list), {}};
}

std::string words_problem(const Slot& slot, const Words& list) {
  for (const std::string& word : list)
    if (const Parsed one = parse_text(slot, word); !one.problem.empty()) return one.problem;
  return length_problem(slot, list.size());
}

Parsed parse_words(const Slot& slot, const std::string& text) {
  Words list = list_parts(text);
  if (const std::string what = words_problem(slot, list); !what.empty()) return {{}, what};
  return {std::move(list), {}};
}

Parsed parse_indices(const Slot& slot, const std::string& text, Indexed indexes) {
  Slot bounded = slot;
  bounded.range = closed(0, std::numeric_limits<int>::max());
  Parsed list = parse_list<Integer>(bounded, text, integer_problem);
  if (!list.problem.empty()) return list;
  const auto& ids = std::get<std::vector<Integer>>(list.value);
  if (ids.empty()) return problem(slot, text, "is an empty list of indices");
  auto set = std::make_shared<IndexSet>();
  set->kind = indexes;
  set->ids.assign(ids.begin(), ids.end());
  return {IndexSetPtr(set), {}};
}

bool allowed(const Range& range, double value) { return range.contains(value); }
bool allowed(const Range& range, Integer value) { return range.contains(static_cast<double>(value)); }
/// Expressions are checked where they are evaluated.
bool allowed(const Range& range, const Formula& value) { return !value.constant() || range.contains(value.number); }

template <class T>
std::string one_problem(const Slot& slot, const T& value) {
  return allowed(slot.range, value) ? "" : fmt::format("{} is not {}", summary(Value(value)), slot.range.str());
}

/// Range, choices and lengths.
std::string described_problem(const Slot& slot, const Value& value) {
  const auto of_list = [&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (const std::string what = one_problem(slot, list[i]); !what.empty())
        return fmt::format("{}: entry {} of the list = {}", slot.name, i + 1, what);
    return length_problem(slot, list.size());
  };
  const auto of_one = [&](const auto& one) {
    const std::string what = one_problem(slot, one);
    return what.empty() ? what : fmt::format("{} = {}", slot.name, what);
  };
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return of_list(*list);
  if (const auto* list = std::get_if<std::vector<Integer>>(&value)) return of_list(*list);
  if (const auto* list = std::get_if<Formulas>(&value)) return of_list(*list);
  if (const auto* text = std::get_if<std::string>(&value)) return parse_text(slot, *text).problem;
  if (const auto* words = std::get_if<Words>(&value)) return words_problem(slot, *words);
  if (const auto* one = std::get_if<Integer>(&value)) return of_one(*one);
  if (const auto* one = std::get_if<double>(&value)) return of_one(*one);
  if (const auto* one = std::get_if<Formula>(&value)) return of_one(*one);
  return {};
}

Parsed parse_described(const Slot& slot, const std::string& raw, Indexed indexes) {
  const std::string text = trimmed(raw);
  switch (slot.type) {
    case Type::boolean:
      return parse_boolean(slot, text);
    case Type::text:
      return parse_text(slot, text);
    case Type::integers:
      return parse_list<Integer>(slot, text, integer_problem);
    case Type::numbers:
      return parse_list<double>(slot, text, number_problem);
    case Type::words:
      return parse_words(slot, text);
    case Type::formula:
      return parse_formula(slot, text, slot.name);
    case Type::formulas:
      return parse_formulas(slot, text);
    case Type::index_set:
      return parse_indices(slot, text, indexes);
    case Type::integer: {
      Integer value = 0;
      const std::errc code = read(text, value);  // before its value is used: arguments have no order
      const std::string what = integer_problem(slot, code, value);
      return what.empty() ? Parsed{value, {}} : problem(slot, text, what);
    }
    case Type::number: {
      double value = 0;
      const std::errc code = read(text, value);
      const std::string what = number_problem(slot, code, value);
      return what.empty() ? Parsed{value, {}} : problem(slot, text, what);
    }
    default:
      return problem(slot, text, fmt::format("cannot be {} written in place", with_article(slot.type)));
  }
}

std::string checked(const Slot& slot, const Value& value) {
  const std::string what = slot.check ? slot.check(value) : "";
  return what.empty() ? what : slot.name + ": " + what;
}

}  // namespace

std::string value_problem(const Slot& slot, const Value& value) {
  const std::string what = described_problem(slot, value);
  return what.empty() ? checked(slot, value) : what;
}

Parsed parse_literal(const Slot& slot, const std::string& raw, Indexed indexes) {
  Parsed parsed = parse_described(slot, raw, indexes);
  if (parsed.problem.empty()) parsed.problem = checked(slot, parsed.value);
  return parsed;
}

}  // namespace msml
