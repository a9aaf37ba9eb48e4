// SPDX-License-Identifier: GPL-3.0-or-later
// The exponential update of viscoelastic stresses.
#include "solver/elements/prony_history.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
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

/// S = F^-1 P, made symmetric against round-off.
SymmetricLanes second_piola(const Gradients& H, const Tensor<Lanes>& P) {
  const Tensor<Lanes> F = deformation_gradient(H), cof = cofactor(F);
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
    const Mat3& V = solver.eigenvectors();
    const Mat3 part = V * solver.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
    for (int k = 0; k < 9; ++k) result.c[k][lane] = part(k / 3, k % 3);
  }
  return result;
}

/// Energy and stress of Q: Q : E and F Q, or Q : e and Q.
void add_fixed(const Tensor<Lanes>& Q, const Gradients& H, bool small_strain, Response& response) {
  const Tensor<Lanes> F = deformation_gradient(H);
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

using Six = Eigen::Matrix<double, 6, 1>;

/// A symmetric tensor with its scalar product: off-diagonal entries times sqrt(2).
Six vector_of(const Mat3& S) {
  const double root = std::sqrt(0.5);
  Six v;
  for (int k = 0; k < 6; ++k) v[k] = (k < 3 ? 0.5 : root) * (S(row_of[k], column_of[k]) + S(column_of[k], row_of[k]));
  return v;
}

/// dS/dE of a lane: dE = sym(F^T dF) makes dP = A : dF and dS = F^-1 (dP - dF S).
Eigen::Matrix<double, 6, 6> stiffness(const Gradients& H, const Response& response, int lane, bool small_strain) {
  Mat3 F = Mat3::Identity(), P;
  for (int k = 0; k < 9; ++k) {
    if (!small_strain) F(k / 3, k % 3) += H.c[k][lane];
    P(k / 3, k % 3) = response.P.c[k][lane];
  }
  const Mat3 inverse = F.inverse(), S = small_strain ? Mat3(Mat3::Zero()) : Mat3(inverse * P);
  Eigen::Matrix<double, 6, 6> C;
  for (int m = 0; m < 6; ++m) {
    Mat3 dE = Mat3::Zero(), dP = Mat3::Zero();
    dE(row_of[m], column_of[m]) = dE(column_of[m], row_of[m]) = m < 3 ? 1 : std::sqrt(0.5);
    const Mat3 dF = inverse.transpose() * dE;
    for (int I = 0; I < 9; ++I)
      for (int J = 0; J < 9; ++J)
        dP(I / 3, I % 3) += response.tangent[I >= J ? packed(I, J) : packed(J, I)][lane] * dF(J / 3, J % 3);
    C.col(m) = vector_of(inverse * (dP - dF * S));
  }
  // Plane stress: the condensed tangent has no row of E_33, and S_33 = 0 takes nothing from this place.
  if (std::abs(C(2, 2)) < 1e-9 * std::abs(C(0, 0))) {
    C.row(2).setZero();
    C.col(2).setZero();
    C(2, 2) = C(0, 0);
  }
  return 0.5 * (C + C.transpose());
}

}  // namespace

PronyHistory::PronyHistory(std::vector<PronySeries> series, int points, bool small_strain)
    : series_(std::move(series)), small_strain_(small_strain) {
  const std::size_t count = static_cast<std::size_t>(points);
  elastic_.resize(count);
  fixed_.resize(count);
  stress_.resize(count);
  energy_.resize(count);
  parts_.assign(series_.front().terms().size(), std::vector<SymmetricLanes>(count));
  begin_step(0);
}

void PronyHistory::begin_step(double dt) {
  for (PronySeries& series : series_) series.begin_step(dt);
  fixed_.assign(fixed_.size(), {});
  for (std::size_t i = 0; i < parts_.size(); ++i)
    for (std::size_t q = 0; q < fixed_.size(); ++q)
      for (int k = 0; k < 6; ++k) fixed_[q].c[k] += of(q).fixed(i, parts_[i][q].c[k], elastic_[q].c[k]);
}

void PronyHistory::apply(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const {
  for (std::size_t q = 0; q < responses.size(); ++q) {
    Response& response = responses[q];
    const Lanes& factor = of(q).factor();
    response.energy *= factor;
    for (Lanes& entry : response.P.c) entry *= factor;
    const Tensor<Lanes> Q = full(fixed_[q]);
    add_fixed(Q, gradients[q], small_strain_, response);
    if (want == Want::stress) continue;
    for (Lanes& entry : response.tangent) entry *= factor;
    if (small_strain_) continue;
    const Tensor<Lanes> geometric = want == Want::definite_tangent ? positive_part(Q) : Q;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l <= k; ++l) response.tangent[packed(3 * i + k, 3 * i + l)] += geometric(k, l);
  }
}

void PronyHistory::end_step(std::span<const Gradients> gradients, std::span<const Response> responses, bool stored) {
  for (std::size_t q = 0; q < responses.size(); ++q) {
    const PronySeries& series = of(q);
    SymmetricLanes now = small_strain_ ? symmetric(responses[q].P) : second_piola(gradients[q], responses[q].P);
    for (int k = 0; k < 6; ++k) {
      now.c[k] *= series.scale();
      stress_[q].c[k] = series.rest() * now.c[k];
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        series.advance(i, now.c[k] - elastic_[q].c[k], parts_[i][q].c[k]);
        stress_[q].c[k] += parts_[i][q].c[k];
      }
      elastic_[q].c[k] = now.c[k];
    }
    if (stored) store(q, gradients[q], responses[q]);
  }
}

void PronyHistory::store(std::size_t point, const Gradients& gradient, const Response& response) {
  const PronySeries& series = of(point);
  energy_[point] = series.rest() * series.scale() * response.energy;
  for (int lane = 0; lane < lanes; ++lane) {
    const double scale = series.scale()[lane];
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> C(scale * stiffness(gradient, response, lane, small_strain_));
    if (C.info() != Eigen::Success) continue;
    const auto spring = [&](const SymmetricLanes& S) {
      Mat3 full;
      for (int k = 0; k < 9; ++k) full(k / 3, k % 3) = S.c[place_of[k]][lane];
      return 0.5 * C.matrixL().solve(vector_of(full)).squaredNorm();
    };
    const double elastic = spring(elastic_[point]), energy = scale * response.energy[lane];
    const double ratio = elastic > 0 && energy > 0 ? energy / elastic : 1;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (series.terms()[i].g[lane] > 0)
        energy_[point][lane] += ratio / series.terms()[i].g[lane] * spring(parts_[i][point]);
  }
}

std::size_t PronyHistory::bytes() const {
  const std::size_t points = elastic_.size() + fixed_.size() + stress_.size() + parts_.size() * elastic_.size();
  std::size_t sum = points * sizeof(SymmetricLanes) + energy_.size() * sizeof(Lanes);
  for (const PronySeries& series : series_) sum += series.bytes();
  return sum;
}

}  // namespace msml::fe
