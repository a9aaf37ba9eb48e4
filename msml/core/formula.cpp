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

/// Numbers that an expression holds, those between any two of them, and the same with the other sign.
std::vector<double> turning_points(const std::string& expression) {
  std::vector<double> found{0, 1};
  for (std::size_t i = 0; i < expression.size() && found.size() < 12; ++i) {
    if (!std::isdigit(static_cast<unsigned char>(expression[i]))) continue;
    double number = 0;
    const char* start = expression.data() + i;
    const auto [end, error] = std::from_chars(start, expression.data() + expression.size(), number);
    if (error == std::errc() && std::isfinite(number)) found.push_back(number);
    i += static_cast<std::size_t>(std::max<std::ptrdiff_t>(end - start, 1)) - 1;
  }
  const std::size_t count = found.size();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < i; ++k) found.push_back(0.5 * (found[i] + found[k]));
  for (std::size_t i = found.size(); i-- > 0;) found.push_back(-found[i]);
  return found;
}

/// Uniform in [-1, 1), the same on every machine.
double draw(std::mt19937& random) { return 2 * (random() / 4294967296.0) - 1; }

}  // namespace

std::string never_allowed(const std::string& expression, const Range& range) {
  constexpr int fifty = 50, most = 4000;  // nearly every expression suits at the first places
  mu::Parser parser;
  Place place;
  define(parser, place);
  std::mt19937 random(1);
  const std::vector<double> turns = turning_points(expression);
  double first = 0;
  Place there;
  try {
    parser.SetExpr(expression);
    for (int n = 0; n < most; ++n) {
      const double scale = std::pow(10.0, n % 13 - 6);
      for (double* x : {&place.X, &place.Y, &place.Z, &place.t})
        *x = n % 2 == 0 || n < fifty / 2 ? scale * draw(random)
                                         : turns[random() % turns.size()] + 1e-3 * scale * draw(random);
      place.t = std::abs(place.t);
      const double value = parser.Eval();
      if (range.contains(value)) return "";
      if (n == 0) first = value, there = place;
    }
  } catch (const mu::Parser::exception_type&) {
    return "";
  }
  return fmt::format("is {} at X = {:.3g}, Y = {:.3g}, Z = {:.3g}, t = {:.3g}, and {} at no place and time at all",
                     std::isnan(first) ? "nan" : fmt::format("{:.4g}", first), there.X, there.Y, there.Z, there.t,
                     range.bounded() ? range.str() : "finite");
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
