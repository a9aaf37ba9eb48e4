// SPDX-License-Identifier: GPL-3.0-or-later
// Chebyshev smoothing.
#include "solver/linear/multigrid/level.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <atomic>
#include <cmath>
#include <random>

namespace msml::fe {
namespace {

constexpr double highest = 1.05;  // above the estimated radius: Lanczos' method comes from below

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <int B, class V>
void put(float* to, const V& values) {
  std::memcpy(to, &values, B * sizeof(float));
}

template <class V>
V get(const float* from) {
  V values;
  std::memcpy(&values, from, sizeof values);
  return values;
}

}  // namespace

template <int B>
bool Level<B>::invert(const std::vector<double>& diagonals) {
  inverse_.resize(diagonals.size());
  std::atomic<bool> good = true;
  for_rows(nodes(), 1024, [&](int r) {
    using Block = Eigen::Matrix<double, B, B>;
    const Eigen::LLT<Block> factor{Eigen::Map<const Block>(diagonals.data() + B * B * at(r))};
    if (factor.info() != Eigen::Success) good = false;
    Eigen::Map<Block>(inverse_.data() + B * B * at(r)) = factor.solve(Block::Identity());
  });
  if (!good) return false;
  inverse_single_.assign(inverse_.begin(), inverse_.end());
  inverse_single_.resize(inverse_.size() + 8);
  direction_ = other_ = vector();
  estimate_radius();
  return std::isfinite(radius_);
}

template <int B>
Column<B> Level<B>::row_product(int n, const float* x) const {
  if constexpr (B == 3)
    if (!halves_.empty()) return halves_.row_product(matrix_.sparsity, n, x);
  return fe::row_product(matrix_, n, x);
}

template <int B>
void Level<B>::estimate_radius() {
  // Lanczos' method with the inner product of the diagonal blocks, as conjugate gradients see it (Saad 2003, 6.7.3).
  using V = Column<B>;
  constexpr int steps = 12;
  Singles r = vector(), z = vector(), p = vector(), q = vector();
  std::mt19937 random(1);
  for (int k = 0; k < B * nodes(); ++k) r[at(k)] = static_cast<float>(random() % 2001) / 1000.0f - 1.0f;
  const auto dot = [&](const Singles& a, const Singles& b) {
    double sum = 0;
    for (int k = 0; k < B * nodes(); ++k) sum += static_cast<double>(a[at(k)]) * b[at(k)];
    return sum;
  };
  std::vector<double> alphas, betas;
  double rho = 0;
  for (int s = 0; s < steps; ++s) {
    for_rows(nodes(), matrix_.piece(), [&](int n) {
      put<B>(&z[at(B * n)], block_product<B>(&inverse_single_[B * B * at(n)], get<V>(&r[at(B * n)])));
    });
    const double before = rho;
    rho = dot(r, z);
    if (!(rho > 1e-30)) break;
    const double beta = s > 0 ? rho / before : 0;
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = z[k] + static_cast<float>(beta) * p[k];
    for_rows(nodes(), matrix_.piece(), [&](int n) { put<B>(&q[at(B * n)], row_product(n, p.data())); });
    const double alpha = rho / dot(p, q);
    for (int k = 0; k < B * nodes(); ++k) r[at(k)] -= static_cast<float>(alpha) * q[at(k)];
    alphas.push_back(alpha);
    betas.push_back(beta);
  }
  const auto count = static_cast<Eigen::Index>(alphas.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    T(k, k) = 1 / alphas[i] + (k > 0 ? betas[i] / alphas[i - 1] : 0);
    if (k + 1 < count) T(k, k + 1) = T(k + 1, k) = std::sqrt(betas[i + 1]) / alphas[i];
  }
  radius_ = count > 0
                ? Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff()
                : 1;
}

template <int B>
void Level<B>::step(const Singles& b, const Singles& x, float keep, float add, Singles& next) {
  using V = Column<B>;
  for_rows(nodes(), matrix_.piece(), [&](int n) {
    const V r = get<V>(&b[at(B * n)]) - row_product(n, x.data());
    const V d = keep * get<V>(&direction_[at(B * n)]) + add * block_product<B>(&inverse_single_[B * B * at(n)], r);
    put<B>(&direction_[at(B * n)], d);
    put<B>(&next[at(B * n)], V(get<V>(&x[at(B * n)]) + d));
  });
}

// The three-term recurrence on [lowest, highest] radius: Saad 2003, algorithm 12.1.
template <int B>
void Level<B>::smooth_from_zero(const Singles& b, Singles& x) {
  using V = Column<B>;
  const double a = lowest * radius_, c = highest * radius_, theta = (c + a) / 2, delta = (c - a) / 2;
  const float first = static_cast<float>(1 / theta);
  for_rows(nodes(), matrix_.piece(), [&](int n) {
    const V d = first * block_product<B>(&inverse_single_[B * B * at(n)], get<V>(&b[at(B * n)]));
    put<B>(&direction_[at(B * n)], d);
    put<B>(&x[at(B * n)], d);
  });
  double rho = delta / theta;
  for (int k = 1; k < degree; ++k) {
    const double next = 1 / (2 * theta / delta - rho);
    step(b, x, static_cast<float>(next * rho), static_cast<float>(2 * next / delta), other_);
    std::swap(x, other_);
    rho = next;
  }
}

template <int B>
void Level<B>::smooth(const Singles& b, Singles& x) {
  const double a = lowest * radius_, c = highest * radius_, theta = (c + a) / 2, delta = (c - a) / 2;
  double rho = delta / theta;
  for (int k = 0; k < degree; ++k) {
    const double next = 1 / (2 * theta / delta - rho);
    if (k == 0)
      step(b, x, 0, static_cast<float>(1 / theta), other_);
    else
      step(b, x, static_cast<float>(next * rho), static_cast<float>(2 * next / delta), other_);
    std::swap(x, other_);
    if (k > 0) rho = next;
  }
}

template <int B>
void Level<B>::residual(const Singles& b, const Singles& x, Singles& r) const {
  using V = Column<B>;
  for_rows(nodes(), matrix_.piece(),
           [&](int n) { put<B>(&r[at(B * n)], V(get<V>(&b[at(B * n)]) - row_product(n, x.data()))); });
}

template class Level<3>;
template class Level<6>;

}  // namespace msml::fe
