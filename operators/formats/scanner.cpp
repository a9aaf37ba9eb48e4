// SPDX-License-Identifier: GPL-3.0-or-later
// Reads words and numbers from a text; independent of the locale.
#include "operators/formats/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

template <class T>
bool parse(std::string_view word, T& value) {
  if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc() && end == word.data() + word.size();
}

}  // namespace

void Scanner::skip_blanks() {
  while (at_ < text_.size()) {
    if (blank(text_[at_]))
      ++at_;
    else if (comments_ && text_[at_] == '#')
      at_ = std::min(text_.find('\n', at_), text_.size());
    else
      break;
  }
}

bool Scanner::at_end() {
  skip_blanks();
  return at_ >= text_.size();
}

std::string_view Scanner::word() {
  if (at_end()) throw Error(fmt::format("line {}: the file ends too early", line_number()));
  const std::size_t start = at_;
  while (at_ < text_.size() && !blank(text_[at_])) ++at_;
  return text_.substr(start, at_ - start);
}

long long Scanner::integer() {
  const std::string_view found = word();
  long long value = 0;
  if (!parse(found, value)) fail(found, "a whole number");
  return value;
}

double Scanner::number() {
  const std::string_view found = word();
  double value = 0;
  if (!parse(found, value) || !std::isfinite(value)) fail(found, "a finite number");
  return value;
}

int Scanner::count() {
  const long long value = integer();
  const auto most =
      std::min<long long>(static_cast<long long>(text_.size() - at_) / 2 + 1, std::numeric_limits<int>::max());
  if (value < 0 || value > most)
    throw Error(fmt::format("line {}: a count of {} does not fit the {} bytes that follow", line_number(), value,
                            text_.size() - at_));
  return static_cast<int>(value);
}

std::string_view Scanner::line() {
  const std::size_t start = at_, end = std::min(text_.find('\n', at_), text_.size());
  at_ = std::min(end + 1, text_.size());
  return text_.substr(start, end - start);
}

std::string_view Scanner::raw(std::size_t n) {
  if (n > text_.size() - at_) throw Error(fmt::format("is cut off: {} bytes are missing", n - (text_.size() - at_)));
  at_ += n;
  return text_.substr(at_ - n, n);
}

int Scanner::line_number() const {
  return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
}

void Scanner::fail(std::string_view found, const char* wanted) const {
  throw Error(fmt::format("line {}: '{}' is not {}", line_number(), found.substr(0, 40), wanted));
}

}  // namespace msml::operators
