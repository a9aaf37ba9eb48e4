// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions by muParser, which enters here alone.
#include "msml/core/formula.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <numbers>
#include <random>

#include "msml/core/braces.hpp"

namespace msml {
namespace {

/// The four variables of an expression.
struct Place {
  double X = 0, Y = 0, Z = 0, t = 0;
};

void define(mu::Parser& parser, Place& place) {
  parser.ClearConst();
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineConst("e", std::numbers::e);
  parser.DefineVar("X", &place.X);
  parser.DefineVar("Y", &place.Y);
  parser.DefineVar("Z", &place.Z);
  parser.DefineVar("t", &place.t);
}

/// The name that starts at a position of a text, or one character.
std::string token_at(const std::string& text, std::size_t position) {
  std::size_t end = position;
  while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
  return text.substr(position, std::max<std::size_t>(1, end - position));
}

/// Position of an assignment, which muParser would carry out; npos if there is none.
std::size_t assignment(const std::string& text) {
  for (std::size_t i = text.find('='); i != std::string::npos; i = text.find('=', i + 1)) {
    const bool joined = i > 0 && std::string("<>!=").find(text[i - 1]) != std::string::npos;
    const bool followed = i + 1 < text.size() && text[i + 1] == '=';
    if (!joined && !followed) return i;
    if (followed) ++i;
  }
  return std::string::npos;
}

std::string words_for(const std::string& text, const mu::Parser::exception_type& fault) {
  const auto at = static_cast<std::size_t>(std::max(0, fault.GetPos()));
  const std::string place =
      at < text.size() ? fmt::format("'{}' at position {}", shortened(token_at(text, at)), at + 1) : "the end";
  if (fault.GetCode() == mu::ecUNASSIGNABLE_TOKEN) return place + " is unknown";
  if (fault.GetCode() == mu::ecMISSING_PARENS) return "a closing parenthesis is missing";
  if (at >= text.size()) return "it ends too early";
  switch (fault.GetCode()) {
    case mu::ecTOO_FEW_PARAMS:
      return "a function before " + place + " has too few arguments";
    case mu::ecTOO_MANY_PARAMS:
      return "a function before " + place + " has too many arguments";
    default:
      return place + " does not fit there";
  }
}

}  // namespace

std::string formula_language() {
  return "X, Y, Z (reference position), t (time), pi, e, numbers, + - * / ^ ( ) < > <= >= == != && || ?: and sin, cos, "
         "tan, asin, acos, atan, atan2, sinh, cosh, tanh, asinh, acosh, atanh, exp, ln, log2, log10, sqrt, abs, sign, "
         "rint, min, max, sum, avg";
}

FormulaFacts examine(const std::string& expression) {
  FormulaFacts facts;
  const auto fault = [&](const std::string& what) {
    facts.problem = what + "; an expression may use " + formula_language();
    return facts;
  };
  if (expression.find_first_not_of(" \t\r\n") == std::string::npos) return fault("it is empty");
  if (const std::size_t at = assignment(expression); at != std::string::npos)
    return fault(fmt::format("'=' at position {} does not fit there (to compare, ==)", at + 1));
  mu::Parser parser;
  Place place;
  define(parser, place);
  try {
    parser.SetExpr(expression);
    int count = 0;
    facts.value = *parser.Eval(count);
    if (count != 1) return fault(fmt::format("it gives {} values instead of one", count));
    for (const auto& [name, variable] : parser.GetUsedVar()) (name == "t" ? facts.of_time : facts.of_position) = true;
  } catch (const mu::Parser::exception_type& error) {
    return fault(words_for(expression, error));
  }
  return facts;
}

namespace {

/// Numbers that an expression holds, without exponents' signs; 0 and 1 are among them.
std::vector<double> numbers_in(const std::string& expression) {
  std::vector<double> found{0, 1};
  for (std::size_t i = 0; i < expression.size(); ++i) {
    if (!std::isdigit(static_cast<unsigned char>(expression[i]))) continue;
    double number = 0;
    const char* start = expression.data() + i;
    const auto [end, error] = std::from_chars(start, expression.data() + expression.size(), number);
    if (error == std::errc() && std::isfinite(number)) found.push_back(number);
    i += static_cast<std::size_t>(std::max<std::ptrdiff_t>(end - start, 1)) - 1;
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Where an expression may turn in one variable: (a +- b) / c of the numbers a, b, c that it holds, and their
/// negatives.
std::vector<double> turning_points(const std::vector<double>& numbers) {
  std::vector<double> found;
  for (const double a : numbers)
    for (const double b : numbers)
      for (const double c : numbers)
        for (const double sign : {-1.0, 1.0})
          for (const double divisor : {c, 2.0})
            if (divisor != 0)
              for (const double x : {(a + sign * b) / divisor, -(a + sign * b) / divisor}) found.push_back(x);
  std::sort(found.begin(), found.end());
  const auto same = [](double x, double y) { return std::abs(x - y) <= 1e-12 * std::abs(x); };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

/// Uniform in [-1, 1), the same on every machine.
double draw(std::mt19937& random) { return 2 * (random() / 4294967296.0) - 1; }

/// An expression at places of choice. Throws muParser's exceptions.
class Trials {
 public:
  Trials(const std::string& expression, const Range& range) : range_(range) {
    define(parser_, place_);
    parser_.SetExpr(expression);
    for (const auto& [name, variable] : parser_.GetUsedVar()) used_.push_back(variable);
  }
  /// True if it suits at one of several thousand places of all scales and signs.
  bool at_random() {
    std::mt19937 random(1);
    for (int n = 0; n < 4000; ++n) {
      const double scale = std::pow(10.0, n % 13 - 6);
      for (double* x : {&place_.X, &place_.Y, &place_.Z, &place_.t}) *x = scale * draw(random);
      if (suits()) return true;
      if (n == 0) first_ = value_, there_ = place_;
    }
    return false;
  }
  /// The same where each variable has a value of a list and a little beside; true too where these are too many.
  bool among(const std::vector<double>& values) {
    constexpr double most = 2e5;
    if (std::pow(2.0 * static_cast<double>(values.size()), static_cast<double>(used_.size())) > most) return true;
    return among(values, 0);
  }
  std::string words() const {
    return fmt::format("is {} at X = {:.3g}, Y = {:.3g}, Z = {:.3g}, t = {:.3g}, and {} at no place and time at all",
                       std::isnan(first_) ? "nan" : fmt::format("{:.4g}", first_), there_.X, there_.Y, there_.Z,
                       there_.t, range_.bounded() ? range_.str() : "finite");
  }

 private:
  bool suits() {
    place_.t = std::abs(place_.t);
    value_ = parser_.Eval();
    return range_.contains(value_);
  }
  bool among(const std::vector<double>& values, std::size_t variable) {
    if (variable == used_.size()) return suits();
    for (const double value : values)
      for (const double beside : {0.0, 1e-3 * std::max(1e-3, std::abs(value))}) {
        *used_[variable] = value + beside;
        if (among(values, variable + 1)) return true;
      }
    return false;
  }

  const Range& range_;
  mu::Parser parser_;
  Place place_, there_;
  std::vector<double*> used_;
  double value_ = 0, first_ = 0;
};

}  // namespace

std::string never_allowed(const std::string& expression, const Range& range) {
  try {
    Trials trials(expression, range);
    if (trials.at_random()) return "";
    const std::vector<double> numbers = numbers_in(expression);
    constexpr std::size_t few = 12;
    return numbers.size() > few || trials.among(turning_points(numbers)) ? "" : trials.words();
  } catch (const mu::Parser::exception_type&) {
    return "";
  }
}

std::vector<std::string> expression_parts(const std::string& text) {
  const std::string inner = without_braces(text);
  std::vector<std::string> by_comma{""}, by_blank{""};
  int depth = 0;
  for (const char c : inner) {
    depth += (c == '(') - (c == ')');
    if (c == ',' && depth <= 0)
      by_comma.emplace_back();
    else
      by_comma.back() += c;
    if (std::string(" \t\r\n").find(c) != std::string::npos && depth <= 0)
      by_blank.emplace_back();
    else
      by_blank.back() += c;
  }
  if (by_comma.size() == 1) {
    std::erase(by_blank, "");
    return by_blank;
  }
  for (std::string& part : by_comma) part = trimmed(part);
  return by_comma;
}

struct Function::Parsed {
  Formula formula;
  std::string name;
  Range range;
  Location where;
  bool of_position = false, of_time = false;
  std::mutex turn;  ///< muParser evaluates on a stack of its own
  Place place;
  mu::Parser parser;

  Parsed(const Formula& f, std::string n, const Range& r, const Location& w)
      : formula(f), name(std::move(n)), range(r), where(w) {
    const FormulaFacts facts = examine(formula.text);
    if (!facts.problem.empty())
      throw Error(fmt::format("{} = {}: {}", name, shortened(formula.text), facts.problem), where);
    of_position = facts.of_position;
    of_time = facts.of_time;
    define(parser, place);
    parser.SetExpr(formula.text);
  }
  double at(const Eigen::Vector3d& X, double t) {
    const std::lock_guard lock(turn);
    place = {X[0], X[1], X[2], t};
    return parser.Eval();
  }
};

Function::Function(const Formula& formula, std::string name, const Range& range, const Location& where)
    : number_(formula.number),
      parsed_(formula.constant() ? nullptr : std::make_shared<Parsed>(formula, std::move(name), range, where)) {}

double Function::operator()(const Eigen::Vector3d& X, double t) const {
  if (!parsed_) return number_;
  const double value = parsed_->at(X, t);
  if (!parsed_->range.contains(value))
    throw Error(fmt::format("{} = {} is {} at X = {:g}, Y = {:g}, Z = {:g}, t = {:g}, which is not {}", parsed_->name,
                            shortened(parsed_->formula.text), std::isnan(value) ? "nan" : fmt::format("{}", value),
                            X[0], X[1], X[2], t, std::isfinite(value) ? parsed_->range.str() : "finite"),
                parsed_->where);
  return value;
}

bool Function::of_position() const { return parsed_ && parsed_->of_position; }
bool Function::of_time() const { return parsed_ && parsed_->of_time; }

Function function(const Record& record, Key<Formula> key) {
  const Slot& slot = record.description->slots()[static_cast<std::size_t>(key.slot)];
  return Function(record[key], slot.name, slot.range, record.where);
}

std::vector<Function> functions(const Record& record, Key<Formulas> key) {
  const Slot& slot = record.description->slots()[static_cast<std::size_t>(key.slot)];
  std::vector<Function> list;
  for (const Formula& formula : record[key]) list.emplace_back(formula, slot.name, slot.range, record.where);
  return list;
}

}  // namespace msml
