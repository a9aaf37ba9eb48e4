// SPDX-License-Identifier: GPL-3.0-or-later
// Transfers between quadratic and linear elements.
#include "solver/linear/multigrid/corners.hpp"

namespace msml::fe {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Corners::Corners(const NodeGeometry& geometry, const std::vector<char>& fixed) : fixed_(fixed) {
  const int nodes = static_cast<int>(geometry.ends.size());
  std::vector<int> corner_of(at(nodes), -1);
  for (int n = 0; n < nodes; ++n)
    if (geometry.ends[at(n)][0] < 0) {
      corner_of[at(n)] = count();
      node_of_.push_back(n);
      for (int i = 0; i < 3; ++i) fixed_coarse_.push_back(fixed[at(3 * n + i)]);
    }
  for (int n = 0; n < nodes; ++n) {
    const auto [a, b] = geometry.ends[at(n)];
    parents_.push_back(a < 0 ? Parents{corner_of[at(n)], corner_of[at(n)]}
                             : Parents{corner_of[at(a)], corner_of[at(b)]});
  }
  child_offsets_.assign(at(count()) + 1, 0);
  const auto for_parents = [&](int n, const auto& body) {
    body(parents_[at(n)].first);
    if (parents_[at(n)].second != parents_[at(n)].first) body(parents_[at(n)].second);
  };
  for (int n = 0; n < nodes; ++n) for_parents(n, [&](int c) { ++child_offsets_[at(c) + 1]; });
  for (std::size_t i = 1; i < child_offsets_.size(); ++i) child_offsets_[i] += child_offsets_[i - 1];
  children_.resize(at(child_offsets_.back()));
  std::vector<int> next(child_offsets_.begin(), child_offsets_.end() - 1);
  for (int n = 0; n < nodes; ++n) for_parents(n, [&](int c) { children_[at(next[at(c)]++)] = n; });
}

void Corners::restrict_matrix(const FreeBlocks& A, Blocks<double, 3, 3>& coarse) const {
  const SparsityView pattern = A.view();
  const auto for_columns = [&](int c, const auto& body) {
    for (int k = child_offsets_[at(c)]; k < child_offsets_[at(c) + 1]; ++k) {
      const int n = children_[at(k)];
      const double share = parents_[at(n)].first == parents_[at(n)].second ? 1 : 0.5;
      for (int p = pattern.offsets[at(n)]; p < pattern.offsets[at(n + 1)]; ++p) {
        const auto [a, b] = parents_[at(pattern.columns[at(p)])];
        body(a, p, n, a == b ? share : 0.5 * share);
        if (a != b) body(b, p, n, 0.5 * share);
      }
    }
  };
  if (coarse.sparsity.rows() == 0) {
    coarse.sparsity.width = count();
    std::vector<int> seen(at(count()), -1), row;
    for (int c = 0; c < count(); ++c) {
      row.clear();
      for_columns(c, [&](int other, int, int, double) {
        if (seen[at(other)] == c) return;
        seen[at(other)] = c;
        row.push_back(other);
      });
      std::sort(row.begin(), row.end());
      coarse.sparsity.columns.insert(coarse.sparsity.columns.end(), row.begin(), row.end());
      coarse.sparsity.offsets.push_back(static_cast<int>(coarse.sparsity.columns.size()));
    }
  }
  coarse.allocate();
  tbb::enumerable_thread_specific<std::vector<int>> places(std::vector<int>(at(count()), -1));
  for_rows(count(), 64, [&](int c) {
    std::vector<int>& place = places.local();
    for (int p = coarse.sparsity.offsets[at(c)]; p < coarse.sparsity.offsets[at(c + 1)]; ++p)
      place[at(coarse.sparsity.columns[at(p)])] = p;
    for_columns(c, [&](int other, int p, int n, double share) {
      const int m = pattern.columns[at(p)];
      double a[9];
      A.copy(p, n, a);
      double* out = coarse.block(place[at(other)]);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          if (!fixed_[at(3 * n + i)] && !fixed_[at(3 * m + j)] && !fixed_coarse_[at(3 * c + i)] &&
              !fixed_coarse_[at(3 * other + j)])
            out[3 * j + i] += share * a[3 * j + i];
    });
    for (int i = 0; i < 3; ++i)
      if (fixed_coarse_[at(3 * c + i)]) coarse.block(place[at(c)])[4 * i] = 1;
  });
}

Blocks<float, 3, 3> Corners::wide(const SparsityView& A) const {
  Blocks<float, 3, 3> P;
  P.sparsity.width = count();
  const auto is_corner = [&](int n) { return parents_[at(n)].first == parents_[at(n)].second; };
  for (int n = 0; n < A.rows(); ++n) {
    for (int p = A.offsets[at(n)]; p < A.offsets[at(n + 1)]; ++p) {
      const int m = A.columns[at(p)];
      if (m == n ? is_corner(n) : is_corner(m) && !is_corner(n)) P.sparsity.columns.push_back(parents_[at(m)].first);
    }
    P.sparsity.offsets.push_back(static_cast<int>(P.sparsity.columns.size()));
  }
  P.allocate();
  for_rows(A.rows(), 1024, [&](int n) {
    const auto [a, b] = parents_[at(n)];
    for (int p = P.sparsity.offsets[at(n)]; p < P.sparsity.offsets[at(n + 1)]; ++p) {
      const int c = P.sparsity.columns[at(p)];
      for (int i = 0; i < 3 && (c == a || c == b); ++i)
        if (!fixed_[at(3 * n + i)] && !fixed_coarse_[at(3 * c + i)]) P.block(p)[4 * i] = a == b ? 1.0f : 0.5f;
    }
  });
  return P;
}

void Corners::restrict_vector(const std::vector<float>& fine, std::vector<float>& coarse) const {
  for_rows(count(), 512, [&](int c) {
    float sum[3] = {};
    for (int k = child_offsets_[at(c)]; k < child_offsets_[at(c) + 1]; ++k) {
      const int n = children_[at(k)];
      const float share = parents_[at(n)].first == parents_[at(n)].second ? 1.0f : 0.5f;
      for (int i = 0; i < 3; ++i)
        if (!fixed_[at(3 * n + i)]) sum[i] += share * fine[at(3 * n + i)];
    }
    for (int i = 0; i < 3; ++i) coarse[at(3 * c + i)] = fixed_coarse_[at(3 * c + i)] ? 0 : sum[i];
  });
}

void Corners::add_prolonged(const std::vector<float>& coarse, std::vector<float>& fine) const {
  for_rows(static_cast<int>(parents_.size()), 1024, [&](int n) {
    const auto [a, b] = parents_[at(n)];
    for (int i = 0; i < 3; ++i)
      if (!fixed_[at(3 * n + i)]) fine[at(3 * n + i)] += 0.5f * (coarse[at(3 * a + i)] + coarse[at(3 * b + i)]);
  });
}

}  // namespace msml::fe
