// SPDX-License-Identifier: GPL-3.0-or-later
// One grid of a multigrid hierarchy: its matrix and its smoother.
#pragma once
#include "solver/linear/multigrid/halves.hpp"

namespace msml::fe {

/// A matrix with B unknowns per node in single precision, smoothed by Chebyshev polynomials in the inverse of its
/// diagonal blocks times itself (Adams, Brezina, Hu and Tuminaro 2003, doi 10.1016/S0021-9991(03)00194-3). Vectors have
/// a few numbers more than B per node.
template <int B>
class Level {
 public:
  using Singles = std::vector<float>;

  /// Takes the matrix, Blocks or a view; false if a diagonal block is not positive definite.
  template <class Matrix>
  bool set(const Matrix& A) {
    const SparsityView view = A.view();
    matrix_.sparsity = {view.rows(), view.offsets, view.columns};
    halves_.clear();
    if (halved && B == 3) halves_.allocate(matrix_.sparsity);
    if (halves_.empty())
      matrix_.allocate();
    else
      matrix_.forget_values();
    std::vector<double> diagonals(B * B * static_cast<std::size_t>(nodes()));
    for_rows(nodes(), 512, [&](int r) {
      const int begin = view.offsets[static_cast<std::size_t>(r)], end = view.offsets[static_cast<std::size_t>(r) + 1];
      std::vector<float> row(halves_.empty() ? 0 : B * B * static_cast<std::size_t>(end - begin));
      float* out = halves_.empty() ? matrix_.block(begin) : row.data();
      double block[B * B];
      for (int p = begin; p < end; ++p, out += B * B) {
        A.copy(p, r, block);
        std::copy(block, block + B * B, out);
        if (view.columns[static_cast<std::size_t>(p)] == r)
          std::copy(block, block + B * B, diagonals.data() + B * B * static_cast<std::size_t>(r));
      }
      if (!halves_.empty()) halves_.set_row(matrix_.sparsity, r, row.data());
    });
    return invert(diagonals);
  }
  /// Goes over to half precision, where there is one; matrix() is empty then. B = 3.
  void halve() {
    halves_.allocate(matrix_.sparsity);
    if (halves_.empty()) return;
    for_rows(nodes(), 512, [&](int r) {
      halves_.set_row(matrix_.sparsity, r, matrix_.block(matrix_.sparsity.offsets[static_cast<std::size_t>(r)]));
    });
    matrix_.forget_values();
  }
  int nodes() const { return matrix_.sparsity.rows(); }
  Singles vector() const { return Singles(B * static_cast<std::size_t>(nodes()) + 8, 0.0f); }
  /// x = S b: `degree` steps from zero.
  void smooth_from_zero(const Singles& b, Singles& x);
  /// x += S (b - A x).
  void smooth(const Singles& b, Singles& x);
  /// r = b - A x.
  void residual(const Singles& b, const Singles& x, Singles& r) const;
  const Blocks<float, B, B>& matrix() const { return matrix_; }
  double radius() const { return radius_; }                        ///< largest eigenvalue of inverse(diagonal) A
  const std::vector<double>& inverse() const { return inverse_; }  ///< B x B for each node, column by column
  /// The inverse is not asked for any more.
  void forget_inverse() { std::vector<double>().swap(inverse_); }
  std::size_t bytes() const {
    return matrix_.bytes() + halves_.bytes() + inverse_.size() * sizeof(double) +
           (inverse_single_.size() + direction_.size() + other_.size()) * sizeof(float);
  }

  /// The matrix is there in half precision.
  bool in_halves() const { return !halves_.empty(); }
  bool halved = false;  ///< set() takes the matrix in half precision, where there is one; B = 3
  int degree = 2;       ///< of the smoother
  double lowest = 0.1;  ///< of the radius: errors below are left to the coarser grid

 private:
  bool invert(const std::vector<double>& diagonals);
  Column<B> row_product(int n, const float* x) const;
  void estimate_radius();
  void step(const Singles& b, const Singles& x, float keep, float add, Singles& next);

  Blocks<float, B, B> matrix_;
  Halves halves_;  ///< instead of the numbers of matrix_, unless empty
  std::vector<double> inverse_;
  std::vector<float> inverse_single_;
  double radius_ = 1;
  Singles direction_, other_;
};

}  // namespace msml::fe
