// SPDX-License-Identifier: GPL-3.0-or-later
// Finding one's way in the record of a simulation.
#include "operators/simulate/records.hpp"

namespace msml::simulation {
namespace {

void collect(const Record& root, const std::string& category, std::vector<const Record*>& found) {
  for (const Record& child : root.children) {
    if (child.description->category() == category)
      found.push_back(&child);
    else
      collect(child, category, found);
  }
}

}  // namespace

std::vector<const Record*> all_of(const Record& root, const std::string& category) {
  std::vector<const Record*> found;
  collect(root, category, found);
  return found;
}

const Record* first_of(const Record& root, const std::string& category) {
  const auto found = all_of(root, category);
  return found.empty() ? nullptr : found.front();
}

std::string text_of(const Record& record, const std::string& attribute) {
  const int slot = record.description->find(attribute);
  if (slot < 0) return {};
  const auto* text = std::get_if<std::string>(&record.values[static_cast<std::size_t>(slot)]);
  return text == nullptr ? std::string() : *text;
}

const IndexSet& indices_of(const Record& record) { return record[Key<IndexSet>{record.description->find("indices")}]; }

Error fault_of(const Record& record, const std::string& text) {
  return Error(fmt::format("{}: {}", record.tag(), text), record.where);
}

void refuse(const Record& record, const std::string& text) { throw fault_of(record, text); }

std::string located(const Record& record) {
  return record.where.line <= 0 ? record.tag() : fmt::format("line {}: {}", record.where.line, record.tag());
}

std::string counted(long long count, const std::string& noun) {
  return with_commas(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string place(const Vec3& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]); }

}  // namespace msml::simulation
