// SPDX-License-Identifier: GPL-3.0-or-later
// Parsing of literals.
#include "msml/compile/literal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace msml {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::vector<std::string> list_parts(const std::string& text) {
  std::string inner = trimmed(text);
  if (inner.size() >= 2 && inner.front() == '{' && inner.back() == '}') inner = inner.substr(1, inner.size() - 2);
  std::vector<std::string> parts;
  std::size_t i = 0;
  while ((i = inner.find_first_not_of(" \t\r\n,", i)) != std::string::npos) {
    const std::size_t end = std::min(inner.find_first_of(" \t\r\n,", i), inner.size());
    parts.push_back(inner.substr(i, end - i));
    i = end;
  }
  return parts;
}

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

}  // namespace

std::string value_problem(const Slot& slot, const Value& value) {
  const auto of_list = [&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (!slot.range.contains(static_cast<double>(list[i])))
        return fmt::format("{}: entry {} of the list = {} is not {}", slot.name, i + 1, list[i], slot.range.str());
    return length_problem(slot, list.size());
  };
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return of_list(*list);
  if (const auto* list = std::get_if<std::vector<Integer>>(&value)) return of_list(*list);
  if (const auto* text = std::get_if<std::string>(&value)) return parse_text(slot, *text).problem;
  const auto* whole = std::get_if<Integer>(&value);
  const auto* number = std::get_if<double>(&value);
  if (!whole && !number) return {};
  if (slot.range.contains(number ? *number : static_cast<double>(*whole))) return {};
  return fmt::format("{} = {} is not {}", slot.name, summary(value), slot.range.str());
}

Parsed parse_literal(const Slot& slot, const std::string& raw, Indexed indexes) {
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

}  // namespace msml
