// SPDX-License-Identifier: GPL-3.0-or-later
// Dual numbers: a value and its derivative along a line, exact to round-off.
#pragma once
#include <cmath>

namespace msml::fe::testing {

struct Dual {
  double value = 0, slope = 0;
  Dual() = default;
  Dual(double x, double s = 0) : value(x), slope(s) {}  // NOLINT: numbers mix freely
  Dual& operator+=(const Dual& y) { return value += y.value, slope += y.slope, *this; }
  Dual& operator-=(const Dual& y) { return value -= y.value, slope -= y.slope, *this; }
  Dual& operator*=(const Dual& y) { return *this = {value * y.value, value * y.slope + slope * y.value}; }
};

inline Dual operator+(Dual x, const Dual& y) { return x += y; }
inline Dual operator-(Dual x, const Dual& y) { return x -= y; }
inline Dual operator*(Dual x, const Dual& y) { return x *= y; }
inline Dual operator-(const Dual& x) { return {-x.value, -x.slope}; }
inline Dual operator/(const Dual& x, const Dual& y) {
  return {x.value / y.value, (x.slope - x.value / y.value * y.slope) / y.value};
}
inline bool operator<(const Dual& x, double y) { return x.value < y; }
inline bool operator>(const Dual& x, double y) { return x.value > y; }
inline Dual root(const Dual& x) { return {std::sqrt(x.value), x.slope / (2 * std::sqrt(x.value))}; }
inline Dual ln1p(const Dual& x) { return {std::log1p(x.value), x.slope / (1 + x.value)}; }
inline Dual exp1m(const Dual& x) { return {std::expm1(x.value), x.slope * std::exp(x.value)}; }

}  // namespace msml::fe::testing
