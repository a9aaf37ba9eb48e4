// SPDX-License-Identifier: GPL-3.0-or-later
// Settings grouped by the reason of their refusal.
#include "msml/study/refusals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace msml {
namespace {

constexpr std::size_t most_reasons = 20, most_settings = 3;

struct Group {
  std::string reason;
  std::vector<const Settings*> settings;
};

/// In the order of the runs.
std::vector<Group> by_reason(const std::vector<StudyRun>& runs) {
  std::vector<Group> groups;
  for (const StudyRun& run : runs) {
    if (run.scene) continue;
    auto group = std::ranges::find(groups, run.reason, &Group::reason);
    if (group == groups.end()) group = groups.insert(groups.end(), {run.reason, {}});
    group->settings.push_back(&run.settings);
  }
  return groups;
}

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  return text.empty() ? "as it stands" : text;
}

std::string line_of(const Group& group) {
  std::string line = "\n  ";
  const std::size_t shown = std::min(group.settings.size(), most_settings);
  for (std::size_t i = 0; i < shown; ++i) line += (i > 0 ? ", " : "") + text_of(*group.settings[i]);
  if (group.settings.size() > shown) line += fmt::format(" and {} more", group.settings.size() - shown);
  return line + ": " + group.reason;
}

std::string heading(const Study& study, const Refusals& found) {
  if (found.all == 0) return fmt::format("study '{}' has no settings to run", study.id);
  if (found.hopeless())
    return fmt::format(
        "no run of study '{}' can be carried out: {}", study.id,
        found.all == 1 ? "its only setting is refused" : fmt::format("all of its {} settings are refused", found.all));
  return fmt::format("study '{}': {} of {} settings {} refused; {} in the table all the same, with the reason",
                     study.id, found.refused, found.all, found.refused == 1 ? "is" : "are",
                     found.refused == 1 ? "it stands" : "they stand");
}

}  // namespace

Refusals find_refusals(const Study& study, const std::vector<StudyRun>& runs) {
  const std::vector<Group> groups = by_reason(runs);
  Refusals found{.refused = 0, .all = runs.size(), .told = {study.where, ""}};
  for (const Group& group : groups) found.refused += group.settings.size();
  if (found.refused == 0 && found.all > 0) return found;
  found.told.message = heading(study, found);
  for (std::size_t i = 0; i < std::min(groups.size(), most_reasons); ++i) found.told.message += line_of(groups[i]);
  if (groups.size() > most_reasons)
    found.told.message +=
        fmt::format("\n  and {} more reasons; msml study --dry-run lists all settings", groups.size() - most_reasons);
  return found;
}

}  // namespace msml
