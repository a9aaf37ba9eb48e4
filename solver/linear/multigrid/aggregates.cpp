// SPDX-License-Identifier: GPL-3.0-or-later
// Groups nodes, and makes prolongations and coarse matrices of them.
#include "solver/linear/multigrid/aggregates.hpp"

#include <Eigen/QR>
#include <cmath>

namespace msml::fe {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Frobenius norm of each block.
template <int B>
std::vector<float> strengths(const Blocks<double, B, B>& A) {
  std::vector<float> norms(A.sparsity.columns.size());
  for_rows(A.sparsity.rows(), 1024, [&](int r) {
    for (int p = A.sparsity.offsets[at(r)]; p < A.sparsity.offsets[at(r + 1)]; ++p) {
      double sum = 0;
      for (std::size_t k = 0; k < B * B; ++k) sum += A.block(p)[k] * A.block(p)[k];
      norms[at(p)] = static_cast<float>(std::sqrt(sum));
    }
  });
  return norms;
}

/// Calls body(neighbour, strength) for the strong neighbours of a node.
template <class Body>
void for_strong(const Sparsity& A, const std::vector<float>& norms, const std::vector<float>& own, int n,
                const Body& body) {
  constexpr float threshold = 0.02f;
  for (int p = A.offsets[at(n)]; p < A.offsets[at(n + 1)]; ++p) {
    const int m = A.columns[at(p)];
    if (m != n && norms[at(p)] > threshold * std::sqrt(own[at(n)] * own[at(m)])) body(m, norms[at(p)]);
  }
}

}  // namespace

template <int B>
Aggregates aggregate(const Blocks<double, B, B>& A, const std::vector<char>& skip) {
  const Sparsity& sparsity = A.sparsity;
  const int nodes = sparsity.rows();
  const std::vector<float> norms = strengths(A);
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

template <int B>
Blocks<double, B, 6> prolongation(const Blocks<double, B, B>& A, const std::vector<double>& inverse, double radius,
                                  const Aggregates& groups, const Modes& modes, Modes& coarse) {
  const int nodes = A.sparsity.rows();
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
  Blocks<double, B, 6> P;
  P.sparsity = product_sparsity(A.sparsity, tentative.sparsity);
  P.allocate();
  multiply(A, tentative, P);
  const double omega = 4.0 / 3 / radius;
  for_rows(nodes, 256, [&](int n) {
    const Eigen::Map<const Eigen::Matrix<double, B, B>> D(inverse.data() + B * B * at(n));
    for (int p = P.sparsity.offsets[at(n)]; p < P.sparsity.offsets[at(n + 1)]; ++p) {
      Eigen::Map<Eigen::Matrix<double, B, 6>> block(P.block(p));
      block = -omega * (D * block).eval();
      if (P.sparsity.columns[at(p)] == groups.of[at(n)])
        block += Eigen::Map<const Eigen::Matrix<double, B, 6>>(tentative.block(tentative.sparsity.offsets[at(n)]));
    }
  });
  return P;
}

template <int B>
void galerkin(const Blocks<double, B, B>& A, const Blocks<double, B, 6>& P, const Blocks<double, 6, B>& P_transposed,
              Blocks<double, 6, 6>& coarse) {
  Blocks<double, B, 6> AP;
  AP.sparsity = product_sparsity(A.sparsity, P.sparsity);
  AP.allocate();
  multiply(A, P, AP);
  if (coarse.sparsity.rows() == 0) coarse.sparsity = product_sparsity(P_transposed.sparsity, AP.sparsity);
  coarse.allocate();
  multiply(P_transposed, AP, coarse);
  for_rows(coarse.sparsity.rows(), 256, [&](int r) {
    for (int p = coarse.sparsity.offsets[at(r)]; p < coarse.sparsity.offsets[at(r + 1)]; ++p)
      for (int i = 0; i < 6 && coarse.sparsity.columns[at(p)] == r; ++i)
        if (coarse.block(p)[7 * i] == 0) coarse.block(p)[7 * i] = 1;
  });
}

template Aggregates aggregate(const Blocks<double, 3, 3>&, const std::vector<char>&);
template Aggregates aggregate(const Blocks<double, 6, 6>&, const std::vector<char>&);
template Blocks<double, 3, 6> prolongation(const Blocks<double, 3, 3>&, const std::vector<double>&, double,
                                           const Aggregates&, const Modes&, Modes&);
template Blocks<double, 6, 6> prolongation(const Blocks<double, 6, 6>&, const std::vector<double>&, double,
                                           const Aggregates&, const Modes&, Modes&);
template void galerkin(const Blocks<double, 3, 3>&, const Blocks<double, 3, 6>&, const Blocks<double, 6, 3>&,
                       Blocks<double, 6, 6>&);
template void galerkin(const Blocks<double, 6, 6>&, const Blocks<double, 6, 6>&, const Blocks<double, 6, 6>&,
                       Blocks<double, 6, 6>&);

}  // namespace msml::fe
