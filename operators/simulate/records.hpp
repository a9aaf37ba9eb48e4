// SPDX-License-Identifier: GPL-3.0-or-later
// Finding one's way in the record of a simulation.
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "msml/core/describe.hpp"

namespace msml::simulation {

/// All records of a category under `root`, at any depth, in document order.
std::vector<const Record*> all_of(const Record& root, const std::string& category);

/// The first of them, or null.
const Record* first_of(const Record& root, const std::string& category);

/// The text of an attribute found by its name; "" where the tag has none or the scene leaves it out.
std::string text_of(const Record& record, const std::string& attribute);

/// The attribute `indices` of a tag. Throws Error where it is absent.
const IndexSet& indices_of(const Record& record);

/// "TAG: TEXT" at the place of the tag.
Error fault_of(const Record& record, const std::string& text);

/// Throws Error "TAG: TEXT" at the place of the tag.
[[noreturn]] void refuse(const Record& record, const std::string& text);

/// "line 12: TAG", or the tag alone where no place is known: the start of a warning.
std::string located(const Record& record);

/// What the tag's own description builds from the record. Throws an internal Error if it builds something else.
template <class Result>
Result make(const Record& record) {
  const auto* factory = dynamic_cast<const Factory<Result>*>(record.description);
  if (factory == nullptr) throw Error("the tag does not build what its place needs", record.where, Failure::internal);
  return factory->make(record);
}

/// The value of an attribute by its name; null if the tag has none of this name, or it is of another type.
template <class T>
const T* value_of(const Record& record, const char* attribute) {
  const int slot = record.description->find(attribute);
  return slot < 0 ? nullptr : std::get_if<T>(&record.values[static_cast<std::size_t>(slot)]);
}

/// "1 element", "12 elements".
std::string counted(long long count, const std::string& noun);

/// "(0.1, 2, -3.5)" in four digits.
std::string place(const Vec3& x);

}  // namespace msml::simulation
