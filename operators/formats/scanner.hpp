// SPDX-License-Identifier: GPL-3.0-or-later
// Reads words and numbers from a text, and says where one is missing.
#pragma once
#include <string>
#include <string_view>

namespace msml::operators {

/// A cursor over a text that outlives it. Blanks and line ends separate words; '#' starts a comment if asked for.
class Scanner {
 public:
  explicit Scanner(std::string_view text, bool comments = false) : text_(text), comments_(comments) {}
  explicit Scanner(std::string&& text, bool comments = false) = delete;  ///< the text must outlive the cursor
  /// True if only blanks and comments are left.
  bool at_end();
  /// The next word; throws Error at the end.
  std::string_view word();
  /// The next word as a whole or a finite number; throws Error with the line otherwise.
  long long integer();
  double number();
  /// A count: an integer >= 0 that the rest of the text can hold, at two bytes or more each; throws Error otherwise.
  int count();
  /// The rest of the current line.
  std::string_view line();
  /// The next n bytes as they are; throws Error where fewer are left.
  std::string_view raw(std::size_t n);
  /// The line of the cursor, from 1.
  int line_number() const;

 private:
  [[noreturn]] void fail(std::string_view found, const char* wanted) const;
  void skip_blanks();
  std::string_view text_;
  std::size_t at_ = 0;
  bool comments_;
};

}  // namespace msml::operators
