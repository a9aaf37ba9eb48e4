// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions in X, Y, Z and t: checked when a scene is compiled, evaluated while it runs.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "msml/core/describe.hpp"

namespace msml {

/// What an expression is, found without a position or a time.
struct FormulaFacts {
  std::string problem;  ///< "" or what is wrong, with the position in the text and what is allowed
  bool of_position = false, of_time = false;
  double value = 0;  ///< where it depends on neither; may be infinite or NaN
};
FormulaFacts examine(const std::string& expression);

/// Why an expression is of no use wherever and whenever it is evaluated: it is not finite, or not in the range, at any
/// of several thousand places X, Y, Z and times t >= 0, of all scales and signs, nor where each variable is one of what
/// the numbers in the expression give by (a +- b) / c. "" where one of them suits, where these are too many to try, and
/// for a faulty expression: better not refused than wrongly. The places are always the same.
std::string never_allowed(const std::string& expression, const Range& range);

/// Parts of a list outside parentheses: at commas if there are any, else at blanks. One pair of braces is dropped.
std::vector<std::string> expression_parts(const std::string& text);

/// One line that says what an expression may use, for messages and help.
std::string formula_language();

/// A formula that can be evaluated, by any thread. Copies share the parsed expression.
class Function {
 public:
  Function(double constant = 0) : number_(constant) {}
  /// `name`, `range` and `where` are those of the attribute, for messages. Throws Error for a faulty expression.
  Function(const Formula& formula, std::string name, const Range& range, const Location& where);
  /// The value at the reference position X and time t. Throws Error if it is not finite or not in the range.
  double operator()(const Eigen::Vector3d& X, double t) const;
  bool constant() const { return parsed_ == nullptr; }
  bool of_position() const;
  bool of_time() const;

 private:
  struct Parsed;
  double number_ = 0;
  std::shared_ptr<Parsed> parsed_;
};

/// The function of an attribute that is a number or an expression.
Function function(const Record& record, Key<Formula> key);
/// The functions of a list of them.
std::vector<Function> functions(const Record& record, Key<Formulas> key);

}  // namespace msml
