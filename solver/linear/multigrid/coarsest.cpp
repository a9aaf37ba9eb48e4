// SPDX-License-Identifier: GPL-3.0-or-later
// Dense inverses of small matrices.
#include "solver/linear/multigrid/coarsest.hpp"

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
  inverse_.resize(full.rows(), full.cols());
  constexpr Eigen::Index piece = 64;  // columns at a time: a second matrix in double precision would take room
  for (Eigen::Index first = 0; first < full.cols(); first += piece) {
    const Eigen::Index count = std::min(piece, full.cols() - first);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(full.rows(), count);
    columns.middleRows(first, count).setIdentity();
    factor.solveInPlace(columns);
    inverse_.middleCols(first, count) = columns.cast<float>();
  }
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
