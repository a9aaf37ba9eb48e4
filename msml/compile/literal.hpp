// SPDX-License-Identifier: GPL-3.0-or-later
// Text of an attribute -> value of a slot's type, within the slot's range, choices and lengths.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "msml/core/describe.hpp"

namespace msml {

/// The value, or what is wrong with it ("youngModulus = -3 is not > 0"). For the types nothing is read from disk for:
/// boolean, integer, number, text, integers, numbers, words, formula, formulas, index_set. `indexes` is what a list of
/// indices counts.
struct Parsed {
  Value value;
  std::string problem;
};
Parsed parse_literal(const Slot& slot, const std::string& text, Indexed indexes);

/// What is wrong with a value that came along an edge, by the slot's range, choices, lengths and check; "" if nothing
/// is.
std::string value_problem(const Slot& slot, const Value& value);

/// Shortened for a message: at most 60 characters.
std::string quoted_value(const std::string& text);

}  // namespace msml
