// SPDX-License-Identifier: GPL-3.0-or-later
// The last grid of a hierarchy, solved exactly.
#pragma once
#include <Eigen/Core>

#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {

/// The inverse of a small positive definite matrix.
class Coarsest {
 public:
  /// False if the matrix is not positive definite.
  template <int B>
  bool set(const Blocks<double, B, B>& A);
  /// x = A^-1 b.
  void solve(const std::vector<float>& b, std::vector<float>& x) const;
  std::size_t bytes() const { return static_cast<std::size_t>(inverse_.size()) * sizeof(float); }

 private:
  Eigen::MatrixXf inverse_;
};

}  // namespace msml::fe
