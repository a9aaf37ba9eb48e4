// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges, slots and records.
#include "msml/core/describe.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace msml {

bool Range::contains(double x) const {
  if (!std::isfinite(x)) return false;
  return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
}

bool Range::bounded() const { return std::isfinite(low) || std::isfinite(high); }

std::string Range::str() const {
  if (!bounded()) return "finite";
  if (!std::isfinite(high)) return fmt::format("{} {}", low_open ? ">" : ">=", low);
  if (!std::isfinite(low)) return fmt::format("{} {}", high_open ? "<" : "<=", high);
  return fmt::format("in {}{}, {}{}", low_open ? '(' : '[', low, high, high_open ? ')' : ']');
}

Range closed(double low, double high) { return {low, high, false, false}; }
Range open(double low, double high) { return {low, high, true, true}; }
Range half_open(double low, double high) { return {low, high, false, true}; }
Range positive() { return {.low = 0, .low_open = true}; }
Range nonnegative() { return {.low = 0}; }

Description::Description(std::string tag, std::string category, std::string doc)
    : tag_(std::move(tag)), category_(std::move(category)), doc_(std::move(doc)) {}

int Description::find(const std::string& name, bool output) const {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].name == name && (slots_[i].role == Role::output) == output) return static_cast<int>(i);
  return -1;
}

int Description::add_slot(Slot slot) {
  assert(find(slot.name, slot.role == Role::output) < 0 && "slot described twice");
  slots_.push_back(std::move(slot));
  return static_cast<int>(slots_.size()) - 1;
}

std::vector<const Record*> Record::of_category(const std::string& category) const {
  std::vector<const Record*> found;
  for (const Record& child : children)
    if (child.description->category() == category) found.push_back(&child);
  return found;
}

std::vector<const Record*> Record::of_tag(const std::string& tag) const {
  std::vector<const Record*> found;
  for (const Record& child : children)
    if (child.tag() == tag) found.push_back(&child);
  return found;
}

void Record::missing(int slot) const {
  const auto& name = description->slots()[static_cast<std::size_t>(slot)].name;
  throw Error(fmt::format("{} has no {}", description->tag(), name), where);
}

}  // namespace msml
