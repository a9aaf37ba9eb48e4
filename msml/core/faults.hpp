// SPDX-License-Identifier: GPL-3.0-or-later
// Several faults of one tag, found before it is built and told together.
#pragma once
#include <string>
#include <vector>

#include "msml/core/describe.hpp"

namespace msml {

/// What is wrong with the attributes of a tag beside each other.
class Faults {
 public:
  /// `record` is that of the tag; it must outlive this.
  explicit Faults(const Record& record) : record_(record) {}
  /// `text` is one line, which names the tag.
  void add(const std::string& text) { text_ += (text_.empty() ? "" : "\n") + text; }
  bool none() const { return text_.empty(); }
  /// Throws one Error at the tag's place, with a line for each fault, if there is any.
  void raise() const {
    if (!text_.empty()) throw Error(text_, record_.where);
  }

 private:
  const Record& record_;
  std::string text_;
};

/// An Error for each line of one.
inline std::vector<Error> lines_of(const Error& error) {
  std::vector<Error> lines;
  const std::string text = error.what();
  for (std::size_t start = 0, end = 0; end != std::string::npos; start = end + 1) {
    end = text.find('\n', start);
    lines.emplace_back(text.substr(start, end == std::string::npos ? end : end - start), error.where(),
                       error.failure());
  }
  return lines;
}

}  // namespace msml
