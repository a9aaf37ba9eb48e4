// SPDX-License-Identifier: GPL-3.0-or-later
// Fields -> units -> labels.
#include "msml/study/units.hpp"

#include <map>
#include <set>
#include <sstream>

namespace msml {
namespace {

/// What a label measures, or "".
std::string measured_by(const std::string& label) {
  static const std::map<std::string, std::set<std::string>> known{{"length", {"m", "cm", "mm", "um", "µm", "km"}},
                                                                  {"force", {"N", "mN", "uN", "kN", "MN", "dyn"}},
                                                                  {"time", {"s", "ms", "us", "min", "h"}},
                                                                  {"stress", {"Pa", "kPa", "MPa", "GPa", "mmHg"}},
                                                                  {"mass", {"kg", "g", "mg", "t"}}};
  for (const auto& [unit, names] : known)
    if (names.contains(label)) return unit;
  return {};
}

}  // namespace

std::string field_unit(const std::string& field) {
  static const std::map<std::string, std::string> units{{"displacement", "length"},
                                                        {"velocity", "length/time"},
                                                        {"acceleration", "length/time^2"},
                                                        {"reaction", "force"},
                                                        {"stress", "stress"},
                                                        {"vonMises", "stress"},
                                                        {"principalStress", "stress"},
                                                        {"pressure", "stress"},
                                                        {"hydrostaticPressure", "stress"},
                                                        {"firstPiola", "stress"},
                                                        {"secondPiola", "stress"},
                                                        {"energyDensity", "stress"},
                                                        {"strain", "1"},
                                                        {"principalStrain", "1"},
                                                        {"smallStrain", "1"},
                                                        {"principalSmallStrain", "1"},
                                                        {"principalGreenLagrange", "1"},
                                                        {"greenLagrange", "1"},
                                                        {"deformationGradient", "1"},
                                                        {"J", "1"},
                                                        {"fiberStretch", "1"},
                                                        {"region", "1"},
                                                        {"value", "value"}};
  const std::string nodal = "_nodal";
  const auto found = units.find(field.ends_with(nodal) ? field.substr(0, field.size() - nodal.size()) : field);
  return found == units.end() ? "" : found->second;
}

std::string in_labels(const std::string& unit, const std::string& labels) {
  std::map<std::string, std::string> label_of;
  std::istringstream words(labels);
  for (std::string label; words >> label;)
    if (const std::string what = measured_by(label); !what.empty()) label_of.emplace(what, label);
  std::string text, word;
  const auto flush = [&] {
    const auto found = label_of.find(word);
    text += found == label_of.end() ? word : found->second;
    word.clear();
  };
  for (const char c : unit) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (letter) {
      word += c;
    } else {
      flush();
      text += c;
    }
  }
  flush();
  return text;
}

}  // namespace msml
