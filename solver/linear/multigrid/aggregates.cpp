// SPDX-License-Identifier: GPL-3.0-or-later
// Groups nodes, and makes prolongations and coarse matrices of them.
#include "solver/linear/multigrid/aggregates.hpp"

#include <Eigen/QR>
#include <cmath>

#include "solver/linear/multigrid/free_blocks.hpp"

namespace msml::fe {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Frobenius norm of each block.
template <int B, class Matrix>
std::vector<float> strengths(const Matrix& A) {
  const SparsityView view = A.view();
  std::vector<float> norms(view.columns.size());
  for_rows(view.rows(), 1024, [&](int r) {
    for (int p = view.offsets[at(r)]; p < view.offsets[at(r + 1)]; ++p) {
      double block[B * B], sum = 0;
      A.copy(p, r, block);
      for (const double entry : block) sum += entry * entry;
      norms[at(p)] = static_cast<float>(std::sqrt(sum));
    }
  });
  return norms;
}

/// Calls body(neighbour, strength) for the strong neighbours of a node.
template <class Body>
void for_strong(const SparsityView& A, const std::vector<float>& norms, const std::vector<float>& own, int n,
                const Body& body) {
  constexpr float threshold = 0.02f;
  for (int p = A.offsets[at(n)]; p < A.offsets[at(n + 1)]; ++p) {
    const int m = A.columns[at(p)];
    if (m != n && norms[at(p)] > threshold * std::sqrt(own[at(n)] * own[at(m)])) body(m, norms[at(p)]);
  }
}

}  // namespace

template <int B, class Matrix>
Aggregates aggregate(const Matrix& A, const std::vector<char>& skip) {
  const SparsityView sparsity = A.view();
  const int nodes = sparsity.rows();
  const std::vector<float> norms = strengths<B>(A);
  std::vector<float> own(at(nodes), 0);
  for (int r = 0; r < nodes; ++r)
    for (int p = sparsity.offsets[at(r)]; p < sparsity.offsets[at(r + 1)]; ++p)
      if (sparsity.columns[at(p)] == r) own[at(r)] = norms[at(p)];
  Aggregates groups{std::vector<int>(at(nodes), -1), 0};
  for (int n = 0; n < nodes; ++n) {
    if (skip[at(n)] || groups.of[at(n)] >= 0) continue;
    bool free = true, any = false;
    for_strong(sparsity, norms, own, n, [&](int m, float) {
      free = free && groups.of[at(m)] < 0;
      any = any || !skip[at(m)];
    });
    if (!free || !any) continue;
    groups.of[at(n)] = groups.count;
    for_strong(sparsity, norms, own, n, [&](int m, float) {
      if (!skip[at(m)]) groups.of[at(m)] = groups.count;
    });
    ++groups.count;
  }
  const std::vector<int> first = groups.of;
  for (int n = 0; n < nodes; ++n) {
    if (skip[at(n)] || first[at(n)] >= 0) continue;
    float best = 0;
    for_strong(sparsity, norms, own, n, [&](int m, float strength) {
      if (first[at(m)] < 0 || strength <= best) return;
      best = strength;
      groups.of[at(n)] = first[at(m)];
    });
    if (groups.of[at(n)] < 0) groups.of[at(n)] = groups.count++;
  }
  return groups;
}

template <int B, class Matrix>
Blocks<float, B, 6> prolongation(const Matrix& A, const std::vector<double>& inverse, double radius,
                                 const Aggregates& groups, const Modes& modes, Modes& coarse) {
  const int nodes = A.view().rows();
  std::vector<std::vector<int>> members(at(groups.count));
  Blocks<double, B, 6> tentative;
  tentative.sparsity.width = groups.count;
  for (int n = 0; n < nodes; ++n) {
    const int g = groups.of[at(n)];
    if (g >= 0) {
      members[at(g)].push_back(n);
      tentative.sparsity.columns.push_back(g);
    }
    tentative.sparsity.offsets.push_back(static_cast<int>(tentative.sparsity.columns.size()));
  }
  tentative.allocate();
  coarse.assign(36 * at(groups.count), 0);
  for_rows(groups.count, 32, [&](int g) {
    const int rows = B * static_cast<int>(members[at(g)].size());
    Eigen::MatrixXd local(rows, 6);
    for (int k = 0; k * B < rows; ++k)
      for (int m = 0; m < 6; ++m)
        for (int i = 0; i < B; ++i)
          local(B * k + i, m) = modes[6 * B * at(members[at(g)][at(k)]) + static_cast<std::size_t>(B * m + i)];
    // With column pivots the basis of a small group ends where its rank does: local = Q R with zero columns behind.
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(local.rows(), 6);
    qr.setThreshold(1e-8);
    qr.compute(local);
    const int rank = static_cast<int>(qr.rank());
    Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(rows, 6);
    Q.leftCols(rank) = qr.householderQ() * Eigen::MatrixXd::Identity(rows, rank);
    const Eigen::Matrix<double, 6, 6> R = Q.transpose() * local;
    for (int k = 0; k * B < rows; ++k) {
      double* block = tentative.block(tentative.sparsity.offsets[at(members[at(g)][at(k)])]);
      for (int m = 0; m < 6; ++m)
        for (int i = 0; i < B; ++i) block[B * m + i] = Q(B * k + i, m);
    }
    for (int m = 0; m < 6; ++m)
      for (int i = 0; i < 6; ++i) coarse[36 * at(g) + static_cast<std::size_t>(6 * m + i)] = R(i, m);
  });
  Blocks<float, B, 6> P;
  P.sparsity = product_sparsity(A.view(), tentative.sparsity);
  P.allocate();
  const double omega = 4.0 / 3 / radius;
  Places places = places_of(P.sparsity);
  tbb::enumerable_thread_specific<std::vector<double>> buffers;
  for_rows(nodes, 256, [&](int n) {
    const Eigen::Map<const Eigen::Matrix<double, B, B>> D(inverse.data() + B * B * at(n));
    std::vector<int>& place = places.local();
    std::vector<double>& row = buffers.local();
    const int first = P.sparsity.offsets[at(n)], count = P.sparsity.offsets[at(n + 1)] - first;
    note_places(P.sparsity, n, 0, place);
    row.assign(6 * B * at(count), 0.0);
    add_row<B>(A, n, tentative, place, row.data());
    for (int p = 0; p < count; ++p) {
      Eigen::Matrix<double, B, 6> block = -omega * (D * Eigen::Map<Eigen::Matrix<double, B, 6>>(&row[6 * B * at(p)]));
      if (P.sparsity.columns[at(first + p)] == groups.of[at(n)])
        block += Eigen::Map<const Eigen::Matrix<double, B, 6>>(tentative.block(tentative.sparsity.offsets[at(n)]));
      Eigen::Map<Eigen::Matrix<float, B, 6>>(P.block(first + p)) = block.template cast<float>();
    }
  });
  return P;
}

namespace {

/// coarse += the share of the rows [first, last) of A P in P^T (A P), whose blocks lie at `rows`.
template <int B, int C>
void add_strip(const Blocks<float, C, B>& P_transposed, const Sparsity& AP, int first, int last,
               const std::vector<double>& rows, Places& places, Blocks<double, C, C>& coarse) {
  const int base = AP.offsets[at(first)];
  const Sparsity& PT = P_transposed.sparsity;
  for_rows(PT.rows(), 64, [&](int c) {
    const auto begin = PT.columns.begin() + PT.offsets[at(c)], end = PT.columns.begin() + PT.offsets[at(c + 1)];
    const auto from = std::lower_bound(begin, end, first), to = std::lower_bound(from, end, last);
    if (from == to) return;
    std::vector<int>& place = places.local();
    note_places(coarse.sparsity, c, coarse.sparsity.offsets[at(c)], place);
    for (auto n = from; n != to; ++n) {
      double a[C * B];
      P_transposed.copy(static_cast<int>(n - PT.columns.begin()), c, a);
      for (int q = AP.offsets[at(*n)]; q < AP.offsets[at(*n + 1)]; ++q) {
        const double* b = &rows[C * B * at(q - base)];
        double* out = coarse.block(place[at(AP.columns[at(q)])]);
        for (int j = 0; j < C; ++j)
          for (int m = 0; m < B; ++m)
            for (int i = 0; i < C; ++i) out[C * j + i] += a[C * m + i] * b[B * j + m];
      }
    }
  });
}

}  // namespace

template <int B, class Matrix, int C>
void galerkin(const Matrix& A, const Blocks<float, B, C>& P, const Blocks<float, C, B>& P_transposed,
              Blocks<double, C, C>& coarse) {
  constexpr int strip = 512;  // rows of A P that are held at once
  const int nodes = A.view().rows();
  const Sparsity AP = product_sparsity(A.view(), P.sparsity);
  if (coarse.sparsity.rows() == 0) coarse.sparsity = product_sparsity(P_transposed.view(), AP);
  coarse.allocate();
  int most = 0;
  for (int first = 0; first < nodes; first += strip)
    most = std::max(most, AP.offsets[at(std::min(nodes, first + strip))] - AP.offsets[at(first)]);
  std::vector<double> rows(C * B * at(most));
  Places places = places_of(AP);
  for (int first = 0; first < nodes; first += strip) {
    const int last = std::min(nodes, first + strip), base = AP.offsets[at(first)];
    for_rows(last - first, 64, [&](int r) {
      std::vector<int>& place = places.local();
      const int begin = AP.offsets[at(first + r)] - base, end = AP.offsets[at(first + r + 1)] - base;
      std::fill(rows.begin() + C * B * begin, rows.begin() + C * B * end, 0.0);
      note_places(AP, first + r, begin, place);
      add_row<B>(A, first + r, P, place, rows.data());
    });
    add_strip(P_transposed, AP, first, last, rows, places, coarse);
  }
  for_rows(coarse.sparsity.rows(), 256, [&](int r) {
    for (int p = coarse.sparsity.offsets[at(r)]; p < coarse.sparsity.offsets[at(r + 1)]; ++p)
      for (int i = 0; i < C && coarse.sparsity.columns[at(p)] == r; ++i)
        if (coarse.block(p)[(C + 1) * i] == 0) coarse.block(p)[(C + 1) * i] = 1;
  });
}

using Thin = Blocks<double, 3, 3>;
using Thick = Blocks<double, 6, 6>;

template Aggregates aggregate<3>(const FreeBlocks&, const std::vector<char>&);
template Aggregates aggregate<3>(const Thin&, const std::vector<char>&);
template Aggregates aggregate<6>(const Thick&, const std::vector<char>&);
template Blocks<float, 3, 6> prolongation<3>(const FreeBlocks&, const std::vector<double>&, double, const Aggregates&,
                                             const Modes&, Modes&);
template Blocks<float, 3, 6> prolongation<3>(const Thin&, const std::vector<double>&, double, const Aggregates&,
                                             const Modes&, Modes&);
template Blocks<float, 6, 6> prolongation<6>(const Thick&, const std::vector<double>&, double, const Aggregates&,
                                             const Modes&, Modes&);
template void galerkin<3>(const FreeBlocks&, const Blocks<float, 3, 3>&, const Blocks<float, 3, 3>&, Thin&);
template void galerkin<3>(const FreeBlocks&, const Blocks<float, 3, 6>&, const Blocks<float, 6, 3>&, Thick&);
template void galerkin<3>(const Thin&, const Blocks<float, 3, 6>&, const Blocks<float, 6, 3>&, Thick&);
template void galerkin<6>(const Thick&, const Blocks<float, 6, 6>&, const Blocks<float, 6, 6>&, Thick&);

}  // namespace msml::fe
