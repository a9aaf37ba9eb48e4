// SPDX-License-Identifier: GPL-3.0-or-later
// Dense inverses of small matrices.
#include "solver/linear/multigrid/coarsest.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>

namespace msml::fe {

template <int B>
bool Coarsest::set(const Blocks<double, B, B>& A) {
  const int rows = A.sparsity.rows();
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(B * rows, B * rows);
  for (int r = 0; r < rows; ++r)
    for (int p = A.sparsity.offsets[static_cast<std::size_t>(r)];
         p < A.sparsity.offsets[static_cast<std::size_t>(r) + 1]; ++p)
      full.block<B, B>(B * r, B * A.sparsity.columns[static_cast<std::size_t>(p)]) =
          Eigen::Map<const Eigen::Matrix<double, B, B>>(A.block(p));
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(full);  // in the place of the matrix
  if (factor.info() != Eigen::Success) return false;
  const Eigen::Index size = full.rows();
  inverse_.resize(size, size);
  // With A = L L^T the last rows and columns of A^-1 are those of L22^-T L22^-1, L22 the last ones of L.
  constexpr Eigen::Index piece = 64;  // columns of one task; all at once would take room
  tbb::parallel_for(Eigen::Index(0), (size + piece - 1) / piece, [&](Eigen::Index k) {
    const Eigen::Index first = k * piece, rest = size - first, count = std::min(piece, rest);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(rest, count);
    const auto L = full.bottomRightCorner(rest, rest).template triangularView<Eigen::Lower>();
    L.solveInPlace(columns);
    L.transpose().solveInPlace(columns);
    inverse_.block(first, first, rest, count) = columns.cast<float>();
    inverse_.block(first, first, count, rest) = columns.transpose().cast<float>();
  });
  return inverse_.allFinite();
}

void Coarsest::solve(const std::vector<float>& b, std::vector<float>& x) const {
  const Eigen::Map<const Eigen::VectorXf> right(b.data(), inverse_.cols());
  constexpr Eigen::Index piece = 96;  // rows of one task
  tbb::parallel_for(Eigen::Index(0), (inverse_.rows() + piece - 1) / piece, [&](Eigen::Index k) {
    const Eigen::Index first = k * piece, count = std::min(piece, inverse_.rows() - first);
    Eigen::Map<Eigen::VectorXf>(x.data() + first, count).noalias() = inverse_.middleRows(first, count) * right;
  });
}

template bool Coarsest::set(const Blocks<double, 3, 3>&);
template bool Coarsest::set(const Blocks<double, 6, 6>&);

}  // namespace msml::fe
