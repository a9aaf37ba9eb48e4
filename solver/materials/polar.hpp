// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation in a deformation gradient, also where the element is flat or inverted.
#pragma once
#include "msml/core/mesh.hpp"
#include "solver/materials/lanes.hpp"

namespace msml::fe {

/// The rotation nearest to F: R maximises tr(R^T F) over all rotations, so det R = +1 for every F. For det F > 0 this
/// is the polar decomposition F = R U; for det F < 0 the smallest principal stretch of U = R^T F counts negative. Where
/// R is not unique (F = 0, or the two smallest signed stretches add up to 0) one of the nearest rotations is returned.
/// Accurate to about 1e-15 relative to |F|. F must be finite. Method: singular values; Kabsch 1976,
/// doi 10.1107/S0567739476001873.
Mat3 polar_rotation(const Mat3& F);

/// The same for eight points. Well-conditioned points with det F > 0 by the trace of U, for which Halley's method
/// solves the quartic equation of optimal rotations (Theobald 2005, doi 10.1107/S0108767305015266), the others one by
/// one.
Tensor<Lanes> polar_rotation(const Tensor<Lanes>& F);

inline Tensor<double> polar_rotation(const Tensor<double>& F) {
  Tensor<double> R;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.c) =
      polar_rotation(Mat3(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(F.c)));
  return R;
}

}  // namespace msml::fe
