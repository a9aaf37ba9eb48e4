// SPDX-License-Identifier: GPL-3.0-or-later
// The exponential update of viscoelastic stresses.
#include "solver/elements/prony_history.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace msml::fe {
namespace {

constexpr int row_of[6] = {0, 1, 2, 0, 1, 0}, column_of[6] = {0, 1, 2, 1, 2, 2};
constexpr int place_of[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};  // of entry 3 i + j among the six
constexpr int packed(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }

Tensor<Lanes> full(const SymmetricLanes& s) {
  Tensor<Lanes> t;
  for (int k = 0; k < 9; ++k) t.c[k] = s.c[place_of[k]];
  return t;
}

Tensor<Lanes> deformation(const Gradients& H) {
  Tensor<Lanes> F = H;
  for (int i = 0; i < 3; ++i) F(i, i) += 1.0;
  return F;
}

/// S = F^-1 P, made symmetric against round-off.
SymmetricLanes second_piola(const Gradients& H, const Tensor<Lanes>& P) {
  const Tensor<Lanes> F = deformation(H), cof = cofactor(F);
  const Lanes J = determinant(F, cof);
  SymmetricLanes S;
  for (int k = 0; k < 6; ++k) {
    const int i = row_of[k], j = column_of[k];
    Lanes sum{};
    for (int l = 0; l < 3; ++l) sum += cof(l, i) * P(l, j) + cof(l, j) * P(l, i);
    S.c[k] = 0.5 * sum / J;
  }
  return S;
}

SymmetricLanes symmetric(const Tensor<Lanes>& P) {
  SymmetricLanes S;
  for (int k = 0; k < 6; ++k) S.c[k] = 0.5 * (P(row_of[k], column_of[k]) + P(column_of[k], row_of[k]));
  return S;
}

/// Without the negative principal values.
Tensor<Lanes> positive_part(const Tensor<Lanes>& Q) {
  Tensor<Lanes> result;
  for (int lane = 0; lane < lanes; ++lane) {
    Mat3 q;
    for (int k = 0; k < 9; ++k) q(k / 3, k % 3) = Q.c[k][lane];
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(q);
    const Mat3 V = solver.eigenvectors();
    const Mat3 part = V * solver.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
    for (int k = 0; k < 9; ++k) result.c[k][lane] = part(k / 3, k % 3);
  }
  return result;
}

/// Energy and stress of Q: Q : E and F Q, or Q : e and Q.
void add_fixed(const Tensor<Lanes>& Q, const Gradients& H, bool small_strain, Response& response) {
  const Tensor<Lanes> F = deformation(H);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      Lanes quadratic{}, stress = small_strain ? Q(i, j) : Lanes{};
      for (int k = 0; k < 3; ++k) {
        quadratic += H(k, i) * H(k, j);
        if (!small_strain) stress += F(i, k) * Q(k, j);
      }
      response.P(i, j) += stress;
      response.energy += Q(i, j) * (small_strain ? H(i, j) : H(i, j) + 0.5 * quadratic);
    }
}

}  // namespace

PronyHistory::PronyHistory(const Prony& prony, int points, bool small_strain)
    : prony_(prony), small_strain_(small_strain) {
  double sum = 0;
  for (const double g : prony.g) sum += g;
  if (prony.long_term) scale_ = 1 / (1 - sum);
  const std::size_t count = static_cast<std::size_t>(points);
  decay_.resize(prony.g.size());
  share_.resize(prony.g.size());
  elastic_.resize(count);
  fixed_.resize(count);
  stress_.resize(count);
  parts_.assign(prony.g.size(), std::vector<SymmetricLanes>(count));
  begin_step(0);
}

void PronyHistory::begin_step(double dt) {
  double factor = 1;
  fixed_.assign(fixed_.size(), {});
  for (std::size_t i = 0; i < prony_.g.size(); ++i) {
    const double g = prony_.g[i], x = dt / prony_.tau[i];
    decay_[i] = std::exp(-x);
    share_[i] = x > 0 ? -std::expm1(-x) / x : 1;
    factor += g * (share_[i] - 1);
    for (std::size_t q = 0; q < fixed_.size(); ++q)
      for (int k = 0; k < 6; ++k) fixed_[q].c[k] += decay_[i] * parts_[i][q].c[k] - g * share_[i] * elastic_[q].c[k];
  }
  factor_ = factor * scale_;
}

void PronyHistory::apply(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const {
  for (std::size_t q = 0; q < responses.size(); ++q) {
    Response& response = responses[q];
    response.energy *= factor_;
    for (Lanes& entry : response.P.c) entry *= factor_;
    const Tensor<Lanes> Q = full(fixed_[q]);
    add_fixed(Q, gradients[q], small_strain_, response);
    if (want == Want::stress) continue;
    for (Lanes& entry : response.tangent) entry *= factor_;
    if (small_strain_) continue;
    const Tensor<Lanes> geometric = want == Want::definite_tangent ? positive_part(Q) : Q;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l <= k; ++l) response.tangent[packed(3 * i + k, 3 * i + l)] += geometric(k, l);
  }
}

void PronyHistory::end_step(std::span<const Gradients> gradients, std::span<const Response> responses) {
  double rest = 1;
  for (const double g : prony_.g) rest -= g;
  for (std::size_t q = 0; q < responses.size(); ++q) {
    SymmetricLanes now = small_strain_ ? symmetric(responses[q].P) : second_piola(gradients[q], responses[q].P);
    for (int k = 0; k < 6; ++k) {
      now.c[k] *= scale_;
      stress_[q].c[k] = rest * now.c[k];
      for (std::size_t i = 0; i < prony_.g.size(); ++i) {
        Lanes& part = parts_[i][q].c[k];
        part = decay_[i] * part + prony_.g[i] * share_[i] * (now.c[k] - elastic_[q].c[k]);
        stress_[q].c[k] += part;
      }
      elastic_[q].c[k] = now.c[k];
    }
  }
}

std::size_t PronyHistory::bytes() const {
  const std::size_t points = elastic_.size() + fixed_.size() + stress_.size() + parts_.size() * elastic_.size();
  return points * sizeof(SymmetricLanes) + (prony_.g.size() + prony_.tau.size() + 2 * decay_.size()) * sizeof(double);
}

}  // namespace msml::fe
