// SPDX-License-Identifier: GPL-3.0-or-later
// The sparsity of products and transposes.
#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {

Sparsity product_sparsity(const SparsityView& A, const Sparsity& B) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  Sparsity C;
  C.width = B.width;
  C.offsets.reserve(at(A.rows()) + 1);
  std::vector<int> seen(at(B.width), -1), row;
  for (int r = 0; r < A.rows(); ++r) {
    row.clear();
    for (int p = A.offsets[at(r)]; p < A.offsets[at(r + 1)]; ++p) {
      const int k = A.columns[at(p)];
      for (int q = B.offsets[at(k)]; q < B.offsets[at(k + 1)]; ++q) {
        const int c = B.columns[at(q)];
        if (seen[at(c)] == r) continue;
        seen[at(c)] = r;
        row.push_back(c);
      }
    }
    std::sort(row.begin(), row.end());
    C.columns.insert(C.columns.end(), row.begin(), row.end());
    C.offsets.push_back(static_cast<int>(C.columns.size()));
  }
  return C;
}

Sparsity transposed(const Sparsity& A) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  Sparsity B;
  B.width = A.rows();
  B.offsets.assign(at(A.width) + 1, 0);
  for (const int c : A.columns) ++B.offsets[at(c) + 1];
  for (std::size_t i = 1; i < B.offsets.size(); ++i) B.offsets[i] += B.offsets[i - 1];
  B.columns.resize(A.columns.size());
  std::vector<int> next(B.offsets.begin(), B.offsets.end() - 1);
  for (int r = 0; r < A.rows(); ++r)
    for (int p = A.offsets[at(r)]; p < A.offsets[at(r + 1)]; ++p) B.columns[at(next[at(A.columns[at(p)])]++)] = r;
  return B;
}

}  // namespace msml::fe
