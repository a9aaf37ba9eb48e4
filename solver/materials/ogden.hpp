// SPDX-License-Identifier: GPL-3.0-or-later
// Ogden's energy in the principal stretches.
#pragma once
#include <vector>

#include "solver/materials/stretches.hpp"
#include "solver/materials/volumetric.hpp"

namespace msml::fe {

/// sum over p of mu_p/alpha_p (x_1^alpha_p + x_2^alpha_p + x_3^alpha_p - 3), x_i = J^(-1/3) s_i with the principal
/// stretches s_i (Ogden 1972, doi 10.1098/rspa.1972.0026). At rest the shear modulus is sum of mu_p alpha_p / 2.
template <class T>
struct Ogden {
  std::vector<T> mu, alpha;

  /// The energy with that of volume changes. Not finite where J <= 0.
  StretchEnergy<T> operator()(const T (&s)[3], const T& j, const Volumetric<T>& volumetric) const {
    const Function<T> U = volumetric.at(j);
    const T J = 1.0 + j, volume_slope = J * U.slope, volume_curvature = J * (U.slope + J * U.curvature);
    T ln[3], ratio[3], quotient[3] = {};  // ratio = (s_i - s_j)/s_j, never 0
    for (int i = 0; i < 3; ++i) ln[i] = ln1p(T(s[i] - 1.0));
    const T mean_ln = ln1p(j) / 3.0;
    for (int pair = 0; pair < 3; ++pair) ratio[pair] = apart(s[first(pair)], s[second(pair)]);
    StretchEnergy<T> out;
    T slope[3], curvature[6];  // by ln s_i
    for (int i = 0; i < 3; ++i) slope[i] = volume_slope;
    for (int k = 0; k < 6; ++k) curvature[k] = volume_curvature;
    out.w.value = U.value;
    for (std::size_t p = 0; p < mu.size(); ++p) {
      T excess[3];  // x_i^alpha - 1
      for (int i = 0; i < 3; ++i) excess[i] = exp1m(T(alpha[p] * (ln[i] - mean_ln)));
      const T mean = (excess[0] + excess[1] + excess[2]) / 3.0, rate = mu[p] * alpha[p];
      out.w.value += mu[p] / alpha[p] * 3.0 * mean;
      for (int i = 0; i < 3; ++i) {
        slope[i] += mu[p] * (excess[i] - mean);
        for (int k = 0; k <= i; ++k) curvature[packed_at(i, k)] -= rate / 3.0 * (1.0 + excess[i] + excess[k] - mean);
        curvature[packed_at(i, i)] += rate * (1.0 + excess[i]);
      }
      for (int pair = 0; pair < 3; ++pair)
        quotient[pair] += mu[p] * (1.0 + excess[second(pair)]) * exp1m(T(alpha[p] * ln1p(ratio[pair]))) / ratio[pair];
    }
    for (int i = 0; i < 3; ++i) {
      out.w.first[i] = slope[i] / s[i];
      for (int k = 0; k <= i; ++k)
        out.w.second[packed_at(i, k)] =
            (i == k ? T(curvature[packed_at(i, k)] - slope[i]) : curvature[packed_at(i, k)]) / (s[i] * s[k]);
    }
    for (int pair = 0; pair < 3; ++pair) {
      const int a = first(pair), b = second(pair);
      out.difference[pair] =
          (0.5 * (s[a] + s[b]) * quotient[pair] / s[b] - 0.5 * (slope[a] + slope[b])) / (s[a] * s[b]);
      out.sum[pair] = (out.w.first[a] + out.w.first[b]) / (s[a] + s[b]);
    }
    return out;
  }
  template <class U, class F>
  Ogden<U> map(F&& f) const {
    Ogden<U> other;
    for (const T& m : mu) other.mu.push_back(f(m));
    for (const T& a : alpha) other.alpha.push_back(f(a));
    return other;
  }

 private:
  static constexpr int first(int pair) { return pair == 0 ? 1 : 2; }
  static constexpr int second(int pair) { return pair == 2 ? 1 : 0; }
  static T apart(const T& x, const T& y) {
    const T d = (x - y) / y, size = d < 0.0 ? T(-d) : d;
    return size < 1e-30 ? T(T{} + 1e-30) : d;
  }
};

}  // namespace msml::fe
