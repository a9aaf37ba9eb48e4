// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of volume changes, modulus/2 g(J)^2.
#pragma once
#include "solver/materials/lanes.hpp"

namespace msml::fe {

/// The measure g of a volume change: none = 0; logarithm = ln J; change = J - 1; square = I3 - 1 = J^2 - 1;
/// cubic = r(J) = (J - 1) - (J - 1)^2/2 + (J - 1)^3/3, the Taylor polynomial of ln J at 1.
enum class VolumeMeasure { none, logarithm, change, square, cubic };

/// Whether the measure is smooth for J <= 0.
constexpr bool survives_inversion(VolumeMeasure measure) { return measure != VolumeMeasure::logarithm; }

/// A function of one variable with its derivatives.
template <class T>
struct Function {
  T value, slope, curvature;
};

/// g at J = 1 + j.
template <class T>
Function<T> volume_measure(VolumeMeasure measure, const T& j) {
  const T zero{}, J = j + 1.0;
  switch (measure) {
    case VolumeMeasure::logarithm:
      return {ln1p(j), 1.0 / J, -1.0 / (J * J)};
    case VolumeMeasure::change:
      return {j, zero + 1.0, zero};
    case VolumeMeasure::square:
      return {j * (j + 2.0), 2.0 * J, zero + 2.0};
    case VolumeMeasure::cubic:
      return {j * (1.0 + j * (j / 3.0 - 0.5)), 1.0 + j * (j - 1.0), 2.0 * j - 1.0};
    case VolumeMeasure::none:
      break;
  }
  return {zero, zero, zero};
}

/// modulus/2 g^2.
template <class T>
struct Volumetric {
  VolumeMeasure measure = VolumeMeasure::none;
  T modulus{};  ///< stress; the bulk modulus that it adds at rest is modulus g'(1)^2

  Function<T> at(const T& j) const {
    const Function<T> g = volume_measure(measure, j);
    return {0.5 * modulus * g.value * g.value, modulus * g.value * g.slope,
            modulus * (g.slope * g.slope + g.value * g.curvature)};
  }
};

}  // namespace msml::fe
