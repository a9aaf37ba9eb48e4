// SPDX-License-Identifier: GPL-3.0-or-later
// References, patterns and natural order.
#include "msml/compile/scope.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "msml/compile/literal.hpp"

namespace msml {

std::vector<Piece> pieces(const std::string& text, std::string& problem) {
  std::vector<Piece> parts;
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t start = text.find("${", i);
    if (start != i) parts.push_back({false, text.substr(i, std::min(start, text.size()) - i)});
    if (start == std::string::npos) break;
    const std::size_t end = text.find('}', start);
    if (end == std::string::npos) {
      problem = "'${' is not closed by '}'";
      return parts;
    }
    const std::string name = trimmed(text.substr(start + 2, end - start - 2));
    if (name.empty()) problem = "'${}' names nothing";
    parts.push_back({true, name});
    i = end + 1;
  }
  return parts;
}

Indexed indexed_by(const std::string& logical, Indexed fallback) {
  if (logical == "NodeSet") return Indexed::nodes;
  if (logical == "FaceSet") return Indexed::faces;
  if (logical == "ElementSet") return Indexed::elements;
  return fallback;
}

bool matches(const std::string& pattern, const std::string& name, std::string* star) {
  const std::size_t first = pattern.find('*');
  if (first == std::string::npos) return pattern == name;
  const std::size_t last = pattern.rfind('*'), tail = pattern.size() - last - 1;
  if (name.size() < first + tail || name.compare(0, first, pattern, 0, first) != 0 ||
      name.compare(name.size() - tail, tail, pattern, last + 1, tail) != 0)
    return false;
  // Each part between two stars is taken at its first place: no later place could let more of the rest match.
  const std::size_t end = name.size() - tail;
  std::size_t from = first, star_end = end;
  for (std::size_t at = first; at != last;) {
    const std::size_t next = pattern.find('*', at + 1);
    const std::string part = pattern.substr(at + 1, next - at - 1);
    const std::size_t found = name.find(part, from);
    if (found == std::string::npos || found + part.size() > end) return false;
    if (at == first) star_end = found;
    from = found + part.size();
    at = next;
  }
  if (star) *star = name.substr(first, star_end - first);
  return true;
}

std::string same_file(const std::string& file) { return std::filesystem::path(file).lexically_normal().string(); }

bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      std::size_t end_a = i, end_b = j;
      while (end_a < a.size() && digit(a[end_a])) ++end_a;
      while (end_b < b.size() && digit(b[end_b])) ++end_b;
      while (i + 1 < end_a && a[i] == '0') ++i;
      while (j + 1 < end_b && b[j] == '0') ++j;
      if (end_a - i != end_b - j) return end_a - i < end_b - j;
      const int order = a.compare(i, end_a - i, b, j, end_b - j);
      if (order != 0) return order < 0;
      i = end_a;
      j = end_b;
    } else {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i, ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

std::string with_star(std::string text, const std::string& star) {
  for (std::size_t i = 0; (i = text.find('*', i)) != std::string::npos; i += star.size()) text.replace(i, 1, star);
  return text;
}

}  // namespace msml
