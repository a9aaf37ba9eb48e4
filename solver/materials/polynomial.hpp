// SPDX-License-Identifier: GPL-3.0-or-later
// Polynomials in the isochoric invariants x = J^(-2/3) I1 - 3 and y = J^(-4/3) I2 - 3.
#pragma once
#include <vector>

#include "solver/materials/isochoric.hpp"
#include "solver/materials/volumetric.hpp"

namespace msml::fe {

/// c1 x + c2 y (Mooney 1940, doi 10.1063/1.1712836; Rivlin 1948, doi 10.1098/rsta.1948.0024).
template <class T>
struct MooneyRivlin {
  using Variables = ThreeInvariants<T>;
  T c1, c2;

  Jet<T, 3> operator()(const Variables& v) const {
    return scale<T>(c1, isochoric_first(v.a, v.j)) + scale<T>(c2, isochoric_second(v.b, v.j));
  }
  template <class U, class F>
  MooneyRivlin<U> map(F&& f) const {
    return {f(c1), f(c2)};
  }
};

/// sum of c[k] x^(k + 1); three terms are Yeoh's law (Yeoh 1993, doi 10.5254/1.3538343).
template <class T>
struct ReducedPolynomial {
  using Variables = TwoInvariants<T>;
  std::vector<T> c;

  Jet<T, 2> operator()(const Variables& v) const {
    const Jet<T, 2> first = isochoric_first(v.a, v.j);
    const T x = first.value;
    T value{}, slope{}, half_curvature{};  // Horner's scheme with derivatives; the polynomial has no constant
    for (std::size_t k = c.size() + 1; k-- > 0;) {
      half_curvature = half_curvature * x + slope;
      slope = slope * x + value;
      value = k > 0 ? T(value * x + c[k - 1]) : T(value * x);
    }
    return chain<T, 2>(first, value, slope, 2.0 * half_curvature);
  }
  template <class U, class F>
  ReducedPolynomial<U> map(F&& f) const {
    ReducedPolynomial<U> other;
    for (const T& coefficient : c) other.c.push_back(f(coefficient));
    return other;
  }
};

/// sum of c x^i y^j (Rivlin and Saunders 1951, doi 10.1098/rsta.1951.0004).
template <class T>
struct Polynomial {
  using Variables = ThreeInvariants<T>;
  struct Term {
    int i = 0, j = 0;
    T c{};
  };
  std::vector<Term> terms;

  Jet<T, 3> operator()(const Variables& v) const {
    const Jet<T, 3> of[2] = {isochoric_first(v.a, v.j), isochoric_second(v.b, v.j)};
    Jet<T, 2> p;
    for (const auto& [i, j, c] : terms) {
      const Function<T> f = power(of[0].value, i), g = power(of[1].value, j);
      p.value += c * f.value * g.value;
      p.first[0] += c * f.slope * g.value;
      p.first[1] += c * f.value * g.slope;
      p.second[0] += c * f.curvature * g.value;
      p.second[1] += c * f.slope * g.slope;
      p.second[2] += c * f.value * g.curvature;
    }
    return compose(p, of);
  }
  template <class U, class F>
  Polynomial<U> map(F&& f) const {
    Polynomial<U> other;
    for (const Term& term : terms) other.terms.push_back({term.i, term.j, f(term.c)});
    return other;
  }

 private:
  static Function<T> power(const T& x, int n) {
    Function<T> f{T{} + 1.0, T{}, T{}};
    for (int k = 0; k < n; ++k) f = {f.value * x, f.slope * x + f.value, f.curvature * x + 2.0 * f.slope};
    return f;
  }
};

}  // namespace msml::fe
