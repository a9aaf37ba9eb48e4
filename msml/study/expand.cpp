// SPDX-License-Identifier: GPL-3.0-or-later
// Lists, ranges, products, tuples and samples.
#include "msml/study/expand.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "msml/compile/literal.hpp"

namespace msml {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  for (std::string& part : parts) part = trimmed(part);
  if (parts.size() > 1 && parts.back().empty()) parts.pop_back();
  return parts;
}

/// Words divided by blanks or commas; what stands between braces is one word, with its braces.
std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> found{""};
  int depth = 0;
  for (const char c : text) {
    depth += (c == '{') - (c == '}');
    if (depth <= 0 && (c == ',' || std::isspace(static_cast<unsigned char>(c))))
      found.emplace_back();
    else
      found.back() += c;
  }
  std::erase(found, "");
  return found;
}

/// The value a share s of the way along a range.
std::string value_at(const Vary& vary, double s) {
  double x = vary.log ? vary.from * std::pow(vary.to / vary.from, s) : vary.from + (vary.to - vary.from) * s;
  if (vary.whole) x = std::round(x);
  return fmt::format("{:.12g}", x);
}

void append(Settings& settings, const Vary& vary, const std::vector<std::string>& tuple) {
  for (std::size_t i = 0; i < vary.variables.size() && i < tuple.size(); ++i)
    settings.emplace_back(vary.variables[i], tuple[i]);
}

std::vector<Settings> product(const Study& study) {
  std::vector<Settings> runs{Settings{}};
  for (const Vary& vary : study.vary) {
    std::vector<Settings> longer;
    for (const Settings& settings : runs)
      for (const auto& tuple : vary.values) {
        longer.push_back(settings);
        append(longer.back(), vary, tuple);
      }
    runs = std::move(longer);
  }
  return runs;
}

std::vector<Settings> zip(const Study& study, const FaultSink& fault) {
  std::vector<Settings> runs(study.vary.empty() ? 0 : study.vary.front().values.size());
  for (const Vary& vary : study.vary) {
    if (vary.values.size() != runs.size()) {
      fault(vary.where, fmt::format("combine = zip: {} has {} values, but {} has {}", fmt::join(vary.variables, " "),
                                    vary.values.size(), fmt::join(study.vary.front().variables, " "), runs.size()));
      return {};
    }
    for (std::size_t i = 0; i < runs.size(); ++i) append(runs[i], vary, vary.values[i]);
  }
  return runs;
}

std::vector<Settings> latin_hypercube(const Study& study) {
  std::mt19937_64 random(static_cast<std::uint64_t>(study.seed));
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };  // the same on every machine
  const auto n = static_cast<std::size_t>(study.samples);
  std::vector<Settings> runs(n);
  for (const Vary& vary : study.vary) {
    std::vector<std::size_t> part(n);
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i) std::swap(part[i - 1], part[random() % i]);
    for (std::size_t i = 0; i < n; ++i) {
      const double s = (static_cast<double>(part[i]) + uniform()) / static_cast<double>(n);
      if (vary.ranged)
        runs[i].emplace_back(vary.variables.front(), value_at(vary, s));
      else
        append(runs[i], vary, vary.values[static_cast<std::size_t>(s * static_cast<double>(vary.values.size()))]);
    }
  }
  // Samples that rounding has made equal are one run.
  std::set<Settings> seen;
  if (std::any_of(study.vary.begin(), study.vary.end(), [](const Vary& vary) { return vary.whole; }))
    std::erase_if(runs, [&](const Settings& run) { return !seen.insert(run).second; });
  return runs;
}

}  // namespace

std::vector<std::vector<std::string>> parse_values(const std::string& text, const Vary& vary, const FaultSink& fault) {
  std::vector<std::vector<std::string>> values;
  const std::size_t width = vary.variables.size();
  const bool tuples = text.find(';') != std::string::npos || width > 1;
  for (const std::string& part : tuples ? split(text, ';') : words(text)) {
    values.push_back(width == 1 ? std::vector<std::string>{part} : words(part));
    if (values.back().size() != width)
      fault(vary.where, fmt::format("values: '{}' has {} words, but {} variables vary together ({})",
                                    quoted_value(part), values.back().size(), width, fmt::join(vary.variables, " ")));
  }
  if (values.empty()) fault(vary.where, "values is empty");
  return values;
}

std::vector<std::vector<std::string>> range_values(const Vary& vary, int count) {
  std::vector<std::vector<std::string>> values;
  for (int i = 0; i < count; ++i) values.push_back({value_at(vary, count == 1 ? 0.0 : i / (count - 1.0))});
  values.erase(std::unique(values.begin(), values.end()), values.end());  // rounding may make neighbours equal
  return values;
}

Settings parse_settings(const std::string& text, const Location& where, const FaultSink& fault) {
  Settings settings;
  for (const std::string& part : text.find(';') == std::string::npos ? words(text) : split(text, ';')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      fault(where, fmt::format("set: '{}' is not of the form name=value; ';' stands between them where a value holds "
                               "blanks",
                               quoted_value(part)));
    else
      settings.emplace_back(trimmed(part.substr(0, equals)), trimmed(part.substr(equals + 1)));
  }
  return settings;
}

std::vector<Settings> expand(const Study& study, const FaultSink& fault) {
  constexpr std::size_t most = 100'000;
  if (study.combine == Combine::latin_hypercube) return latin_hypercube(study);
  double count = 1;
  for (const Vary& vary : study.vary) {
    if (vary.values.empty())
      return fault(vary.where,
                   fmt::format("{} varies over a range, which needs count", fmt::join(vary.variables, " "))),
             std::vector<Settings>{};
    count *= static_cast<double>(vary.values.size());
  }
  if (study.combine == Combine::zip) return zip(study, fault);
  if (count > most)
    return fault(study.where, fmt::format("study '{}' asks for {:.0f} runs, more than {}", study.id, count, most)),
           std::vector<Settings>{};
  return product(study);
}

}  // namespace msml
