// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers with which a function is continued along each of three variables by its tangent.
#pragma once
#include <array>
#include <cmath>

#include "solver/materials/jet.hpp"

namespace msml::fe {

/// A number c0 + c1 e1 + c2 e2 + c3 e1 e2 + c4 e3 + … with e_i^2 = 0: bit i of the index stands for e_(i+1). A function
/// of x_i + e_i holds all its mixed derivatives that are of first order in each variable.
struct Nilpotent {
  double c[8] = {};

  Nilpotent() = default;
  Nilpotent(double x) : c{x} {}  // NOLINT: numbers mix freely, as with any other scalar

  /// The value with e_i = d[i].
  double at(const std::array<double, 3>& d) const {
    double sum = 0;
    for (unsigned k = 0; k < 8; ++k) {
      double term = c[k];
      for (unsigned i = 0; i < 3; ++i)
        if (k >> i & 1U) term *= d[i];
      sum += term;
    }
    return sum;
  }
  Nilpotent& operator+=(const Nilpotent& y) {
    for (int k = 0; k < 8; ++k) c[k] += y.c[k];
    return *this;
  }
  Nilpotent& operator-=(const Nilpotent& y) {
    for (int k = 0; k < 8; ++k) c[k] -= y.c[k];
    return *this;
  }
  Nilpotent& operator*=(const Nilpotent& y);
};

inline Nilpotent operator+(Nilpotent x, const Nilpotent& y) { return x += y; }
inline Nilpotent operator-(Nilpotent x, const Nilpotent& y) { return x -= y; }
inline Nilpotent operator-(const Nilpotent& x) { return Nilpotent() -= x; }
inline Nilpotent operator*(const Nilpotent& x, const Nilpotent& y) {
  Nilpotent z;
  for (unsigned i = 0; i < 8; ++i)
    for (unsigned j = 0; j < 8; ++j)
      if ((i & j) == 0) z.c[i | j] += x.c[i] * y.c[j];
  return z;
}
inline Nilpotent& Nilpotent::operator*=(const Nilpotent& y) { return *this = *this * y; }

/// f(x) from f and its three derivatives at x.c[0].
inline Nilpotent taylor(const Nilpotent& x, double f, double first, double second, double third) {
  Nilpotent n = x;
  n.c[0] = 0;
  return f + n * (first + n * (0.5 * second + n * (third / 6)));
}
inline Nilpotent operator/(const Nilpotent& x, const Nilpotent& y) {
  const double r = 1 / y.c[0];
  return x * taylor(y, r, -r * r, 2 * r * r * r, -6 * r * r * r * r);
}
inline Nilpotent ln1p(const Nilpotent& x) {
  const double r = 1 / (1 + x.c[0]);
  return taylor(x, std::log1p(x.c[0]), r, -r * r, 2 * r * r * r);
}
inline Nilpotent exp1m(const Nilpotent& x) {
  const double f = std::expm1(x.c[0]);
  return taylor(x, f, f + 1, f + 1, f + 1);
}
inline bool operator<(const Nilpotent& x, double y) { return x.c[0] < y; }

/// An energy as a function of the principal stretches alone.
class StretchLaw {
 public:
  virtual ~StretchLaw() = default;
  /// Energy with derivatives at stretches s, with the parameters of one lane.
  virtual Jet<Nilpotent, 3> of_stretches(const Nilpotent (&s)[3], int lane) const = 0;
};

/// a, j and b of Invariants from the stretches.
std::array<Jet<Nilpotent, 3>, 3> invariants_of_stretches(const Nilpotent (&s)[3]);

}  // namespace msml::fe
