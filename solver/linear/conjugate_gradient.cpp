// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients with the preconditioners that need a matrix alone.
#include <tbb/parallel_for.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "solver/linear/cg.hpp"

namespace msml::fe {
namespace {

using Lower = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

template <class Body>
void for_nodes(Eigen::Index nodes, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, nodes, 1024), [&](const auto& range) {
    for (Eigen::Index n = range.begin(); n < range.end(); ++n) body(n);
  });
}

class ConjugateGradient final : public LinearSystem {
 public:
  ConjugateGradient(Preconditioner kind, std::function<void()> pulse)
      : kind_(kind == Preconditioner::automatic ? Preconditioner::block_jacobi : kind), pulse_(std::move(pulse)) {}

  LinearStatus factor(const BlockMatrix& A, const Mask& fixed) override {
    matrix_ = &A;
    if (fixed != fixed_) {
      fixed_ = fixed;
      if (kind_ == Preconditioner::incomplete_cholesky) lower_ = lower_triangle(*A.pattern, fixed);
    }
    if (kind_ == Preconditioner::incomplete_cholesky) return factor_incomplete(A);
    return kind_ == Preconditioner::none ? LinearStatus::done : invert_diagonal(A);
  }

  LinearStatus solve(const Vector& right, double tolerance, Vector& x) override {
    Vector b = right;
    zero_fixed(fixed_, b);
    Vector r;
    guesses_.start({matrix_}, fixed_, b, r, x);
    const double target = tolerance * std::sqrt(dot(b, b));
    long limit = std::clamp<long>(10 * b.size(), 1000, 50000);
    double size = std::sqrt(dot(r, r));
    // The recurrence drifts from the true residual: measure it, and start again from it where needed.
    while (size > target) {
      long taken = 0;
      const auto prepare = [this](const Vector& residual, double, Vector& z) { precondition(residual, z); };
      const LinearStatus status = conjugate_gradients({matrix_}, fixed_, prepare, target, limit, space_, r, x, taken);
      limit -= taken, iterations += taken;
      multiply(*matrix_, x, r);
      r = b - r;
      zero_fixed(fixed_, r);
      const double before = size;
      size = std::sqrt(dot(r, r));
      if (status != LinearStatus::done) return size <= target ? LinearStatus::done : status;
      if (!std::isfinite(size)) return LinearStatus::not_positive_definite;
      if (size > target && size > 0.5 * before) return LinearStatus::limit;
    }
    guesses_.keep(x);
    return LinearStatus::done;
  }

  void expect(const Vector& solution) override { guesses_.expect(solution); }
  bool iterative() const override { return true; }
  std::size_t factor_bytes() const override {
    return guesses_.bytes() + inverse_.size() * sizeof(double) +
           static_cast<std::size_t>(incomplete_.matrixL().nonZeros()) * (sizeof(double) + sizeof(int));
  }

 private:
  void precondition(const Vector& r, Vector& z) const {
    if (pulse_) pulse_();
    if (kind_ == Preconditioner::none) {
      z = r;
    } else if (kind_ == Preconditioner::incomplete_cholesky) {
      Vector compact(lower_.size());
      for (int k = 0; k < lower_.size(); ++k) compact[k] = r[lower_.unknown_of[static_cast<std::size_t>(k)]];
      const Vector solved = incomplete_.solve(compact);
      z = Vector::Zero(r.size());
      for (int k = 0; k < lower_.size(); ++k) z[lower_.unknown_of[static_cast<std::size_t>(k)]] = solved[k];
    } else {
      z.resize(r.size());
      for_nodes(r.size() / 3, [&](Eigen::Index n) {
        const double* m = inverse_.data() + 9 * n;
        const double* v = r.data() + 3 * n;
        for (int i = 0; i < 3; ++i) z[3 * n + i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
      });
    }
  }

  LinearStatus factor_incomplete(const BlockMatrix& A) {
    std::vector<double> values(lower_.source.size());
    lower_.gather(A, values.data());
    const Eigen::Map<const Lower> lower(lower_.size(), lower_.size(), static_cast<Eigen::Index>(values.size()),
                                        lower_.starts.data(), lower_.rows.data(), values.data());
    incomplete_.compute(Lower(lower));
    return incomplete_.info() == Eigen::Success ? LinearStatus::done : LinearStatus::not_positive_definite;
  }

  /// Inverts the diagonal blocks (or their diagonals); fixed unknowns keep a unit row.
  LinearStatus invert_diagonal(const BlockMatrix& A) {
    using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Pattern& pattern = *A.pattern;
    inverse_.resize(9 * pattern.diagonal.size());
    bool good = true;
    for (std::size_t n = 0; n < pattern.diagonal.size(); ++n) {
      Block block = Eigen::Map<const Block>(A.values.data() + 9 * static_cast<std::size_t>(pattern.diagonal[n]));
      if (kind_ == Preconditioner::jacobi) block = Block(block.diagonal().asDiagonal());
      for (int i = 0; i < 3; ++i)
        if (fixed_[3 * n + static_cast<std::size_t>(i)]) {
          block.row(i).setZero();
          block.col(i).setZero();
          block(i, i) = 1;
        }
      good = good && block(0, 0) > 0 && block.determinant() > 0;
      Eigen::Map<Block>(inverse_.data() + 9 * n) = block.inverse();
    }
    return good ? LinearStatus::done : LinearStatus::not_positive_definite;
  }

  Preconditioner kind_;
  std::function<void()> pulse_;
  const BlockMatrix* matrix_ = nullptr;
  Mask fixed_;
  LowerTriangle lower_;
  CgSpace space_;
  Guesses guesses_;
  std::vector<double> inverse_;  ///< 9 per node
  Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>> incomplete_;
};

}  // namespace

std::unique_ptr<LinearSystem> make_conjugate_gradient(Preconditioner preconditioner, std::function<void()> pulse) {
  return std::make_unique<ConjugateGradient>(preconditioner, std::move(pulse));
}

}  // namespace msml::fe
