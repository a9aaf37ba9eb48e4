// SPDX-License-Identifier: GPL-3.0-or-later
// Where a thing stands in a scene, and the one exception type of the project.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace msml {

/// A place in a text file; line 0 means "the file as a whole", an empty file "no place known".
struct Location {
  std::string file;
  int line = 0;
  /// "file:line", "file", or "".
  std::string str() const;
  bool operator==(const Location&) const = default;
};

/// What went wrong decides the exit code: bad input 2, not converged 3, internal 4, interrupted 130.
enum class Failure { input = 2, not_converged = 3, internal = 4, interrupted = 130 };

/// The one exception type. The message names the thing, its value, what is allowed and the nearest name.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, Location where = {}, Failure failure = Failure::input);
  const Location& where() const { return where_; }
  Failure failure() const { return failure_; }
  /// "file:line: message", or the message alone where no place is known.
  std::string str() const;

 private:
  Location where_;
  Failure failure_;
};

/// A text of the scene made fit for a message: one line without control characters, at most `most` bytes, cut between
/// characters of UTF-8.
std::string shortened(const std::string& text, std::size_t most = 60);

/// The candidate nearest to `name` by edit distance (letters added, removed, changed or swapped; case ignored), or ""
/// if none is within a third of its length, at least one letter.
std::string nearest(const std::string& name, const std::vector<std::string>& candidates);

/// " (did you mean 'x'?)" for the nearest candidate, or "".
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace msml
