// SPDX-License-Identifier: GPL-3.0-or-later
// Rotation, local displacement, force and Hessian of eight elements at once.
#include "solver/elements/single_rotation_batch.hpp"

#include <Eigen/Eigenvalues>
#include <cstring>

#include "solver/materials/corotation.hpp"

namespace msml::fe {
namespace {

using Vector3 = Lanes[3];

void cross(const Lanes* a, const Lanes* b, Lanes* c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/// c = m a, or m^T a.
void times(const Tensor<Lanes>& m, const Lanes* a, Lanes* c) {
  for (int i = 0; i < 3; ++i) c[i] = m(i, 0) * a[0] + m(i, 1) * a[1] + m(i, 2) * a[2];
}
void transposed_times(const Tensor<Lanes>& m, const Lanes* a, Lanes* c) {
  for (int i = 0; i < 3; ++i) c[i] = m(0, i) * a[0] + m(1, i) * a[1] + m(2, i) * a[2];
}

/// The inverse of the symmetric D, its eigenvalues kept away from zero where the rotation is not unique.
Tensor<Lanes> inverse_of(const Tensor<Lanes>& D, const Tensor<Lanes>& U) {
  const Tensor<Lanes> cof = cofactor(D);
  const Lanes det = determinant(D, cof), size = root(square_sum(U));
  Tensor<Lanes> inverse;
  for (int k = 0; k < 9; ++k) inverse.c[k] = cof.c[k] / det;
  for (int lane = 0; lane < lanes; ++lane) {
    const double s = size[lane];
    if (det[lane] > 1e-3 * s * s * s) continue;
    Mat3 d;
    for (int k = 0; k < 9; ++k) d(k / 3, k % 3) = D.c[k][lane];
    if (!d.allFinite()) continue;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(d);
    const Vec3 bounded = solver.eigenvalues().cwiseMax(1e-3 * std::max(s, 1e-3));
    const Mat3 fixed = solver.eigenvectors() * bounded.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
    for (int k = 0; k < 9; ++k) inverse.c[k][lane] = fixed(k / 3, k % 3);
  }
  return inverse;
}

/// Of straight elements of one law, the same at all points, whose weights are equal.
HookePoint hooke_of(const RotationBatch& batch) {
  HookePoint point{.inverse = {}, .weight = 0.25 * batch.shear, .ratio = batch.ratio};
  std::memcpy(point.inverse, batch.g[1], sizeof point.inverse);
  return point;
}

/// The stiffness at rest; `room` is used where it has to be made.
const RestStiffness& stiffness_of(const RotationBatch& batch, RestStiffness& room) {
  if (!batch.kept.empty()) return batch.kept.front();
  make_stiffness(hooke_of(batch), room.block);
  return room;
}

/// q = K d and d . q / 2.
template <class Displacements, class Forces>
Lanes apply_stiffness(const RestStiffness& stiffness, const Displacements& d, Forces& q) {
  for (auto& row : q)
    for (Lanes& entry : row) entry = Lanes{};
  for (int b = 0; b < 10; ++b)
    for (int a = 0; a <= b; ++a) {
      const Lanes* K = stiffness.block[packed(b, a)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          q[a][i] += K[3 * i + j] * d[b][j];
          if (a != b) q[b][j] += K[3 * i + j] * d[a][i];
        }
    }
  Lanes energy{};
  for (int a = 0; a < 10; ++a) energy += 0.5 * inner<3>(d[a], q[a]);
  return energy;
}

/// q = factor K d + fixed, with its energy.
void relax(const RotationHistory& history, RotationState& state) {
  const Lanes& factor = history.series.factor();
  state.energy *= factor;
  for (std::size_t a = 0; a < 10; ++a)
    for (int i = 0; i < 3; ++i) {
      state.q[a][i] = factor * state.q[a][i] + history.fixed[a][i];
      state.energy += state.d[a][i] * history.fixed[a][i];
    }
}

/// factor Y^T K, 3 x 3 for each node: column 3 b + j of row r is sum_a (e_r x d_a) . (-K_ab)_j; rows are rotations
/// about axes.
void rotate_stiffness(const RestStiffness& stiffness, const Lanes& factor, const Lanes (&d)[10][3], Lanes (&N)[10][9]) {
  for (auto& row : N)
    for (Lanes& entry : row) entry = Lanes{};
  // Column r of Y_a is d_a x e_r.
  const auto add = [](const Lanes* y, const Lanes* K, bool transpose, Lanes* out) {
    // out(r, j) += sum_i y_r,i K(i, j), with y_r = d x e_r written out
    for (int j = 0; j < 3; ++j) {
      const auto k = [&](int i) { return transpose ? K[3 * j + i] : K[3 * i + j]; };
      out[j] += y[2] * k(1) - y[1] * k(2);
      out[3 + j] += y[0] * k(2) - y[2] * k(0);
      out[6 + j] += y[1] * k(0) - y[0] * k(1);
    }
  };
  for (int b = 0; b < 10; ++b)
    for (int a = 0; a <= b; ++a) {
      const Lanes* K = stiffness.block[packed(b, a)];
      add(d[a], K, false, N[b]);
      if (a != b) add(d[b], K, true, N[a]);
    }
  for (auto& row : N)
    for (Lanes& entry : row) entry *= factor;
}

/// S' = Y^T K Y + sym(sum_a y_a q_a^T - (y_a . q_a) I - [w] U), y = X + d.
Tensor<Lanes> rotation_curvature(const RotationBatch& batch, const RotationState& state, const Lanes (&N)[10][9]) {
  Tensor<Lanes> S{};
  Lanes trace{};
  for (int a = 0; a < 10; ++a) {
    Vector3 y;
    for (int i = 0; i < 3; ++i) y[i] = batch.X[a][i] + state.d[a][i];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) S(i, j) += y[i] * state.q[a][j];
    trace += inner<3>(y, state.q[a]);
    const Lanes* d = state.d[a];
    for (int r = 0; r < 3; ++r) {
      const Lanes* n = N[a] + 3 * r;
      S(r, 0) += d[2] * n[1] - d[1] * n[2];
      S(r, 1) += d[0] * n[2] - d[2] * n[0];
      S(r, 2) += d[1] * n[0] - d[0] * n[1];
    }
  }
  for (int j = 0; j < 3; ++j) {
    const Lanes column[3] = {state.U(0, j), state.U(1, j), state.U(2, j)};
    Vector3 turned;
    cross(state.w, column, turned);
    for (int i = 0; i < 3; ++i) S(i, j) -= turned[i];
    S(j, j) -= trace;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) S(i, j) = S(j, i) = 0.5 * (S(i, j) + S(j, i));
  return S;
}

/// out += [v]x.
void add_cross(const Lanes* v, double sign, Lanes* out) {
  out[1] -= sign * v[2];
  out[2] += sign * v[1];
  out[3] += sign * v[2];
  out[5] -= sign * v[0];
  out[6] -= sign * v[1];
  out[7] += sign * v[0];
}

/// The local Hessian K + G^T N' + N'^T G with G_a = D^-1 [g_a]x at corners, N' = Y^T K + C - Z + S' G / 2,
/// C_a = [g_a x w]x and Z_a = -[q_a]x.
void add_rotation_terms(const RotationBatch& batch, const RestStiffness& stiffness, const Lanes& factor,
                        const RotationState& state, Lanes (&H)[55][9]) {
  Lanes N[10][9];
  rotate_stiffness(stiffness, factor, state.d, N);
  const Tensor<Lanes> S = rotation_curvature(batch, state, N);
  Tensor<Lanes> G[4];
  for (int a = 0; a < 10; ++a) add_cross(state.q[a], 1, N[a]);
  for (int a = 0; a < 4; ++a) {
    Vector3 turned;
    cross(batch.g[a], state.w, turned);
    add_cross(turned, 1, N[a]);
    Lanes gx[9] = {};
    add_cross(batch.g[a], 1, gx);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        G[a](i, j) = state.inverse(i, 0) * gx[j] + state.inverse(i, 1) * gx[3 + j] + state.inverse(i, 2) * gx[6 + j];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        N[a][3 * i + j] += 0.5 * (S(i, 0) * G[a](0, j) + S(i, 1) * G[a](1, j) + S(i, 2) * G[a](2, j));
  }
  for (int b = 0; b < 10; ++b)
    for (int a = 0; a <= b && a < 4; ++a)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          Lanes sum = G[a](0, i) * N[b][j] + G[a](1, i) * N[b][3 + j] + G[a](2, i) * N[b][6 + j];
          if (b < 4) sum += N[a][i] * G[b](0, j) + N[a][3 + i] * G[b](1, j) + N[a][6 + i] * G[b](2, j);
          H[packed(b, a)][3 * i + j] += sum;
        }
}

}  // namespace

Lanes factor_of(const RotationBatch& batch) {
  return batch.history.empty() ? lanes_of(1) : batch.history.front().series.factor();
}

RotationBatch make_rotation_batch(const SimplexBatch<3, 10, 4>& batch,
                                  const std::function<void(int, SimplexGradients<3, 10>&)>& gradients) {
  const Gradients rest[4] = {};
  Response response[4];
  batch.laws.evaluate(Want::tangent, rest, response);
  const bool kept = !batch.straight || batch.laws.laws.size() > 1;
  SimplexResult<3, 10> stiffness{};
  RotationBatch own{};
  for (int q = 0; q < 4; ++q) {
    SimplexGradients<3, 10> g;
    gradients(q, g);
    if (kept) add_stiffness<3, 10>(response[q].tangent, batch.points[q].weight, g, stiffness);
    own.shear += batch.points[q].weight * response[q].tangent[packed_at(1, 1)];  // dP_01/dF_01 = mu
    // A corner's linear shape function is its quadratic one plus half of those of its three mid nodes.
    for (int a = 0; a < 4 && q == 0; ++a)
      for (int i = 0; i < 3; ++i) {
        own.g[a][i] = g.g[a][i];
        for (int k = 0; k < 6; ++k)
          if (Tetrahedron<10>::edges[static_cast<std::size_t>(k)][0] == a ||
              Tetrahedron<10>::edges[static_cast<std::size_t>(k)][1] == a)
            own.g[a][i] += 0.5 * g.g[4 + k][i];
      }
  }
  own.ratio = response[0].tangent[packed_at(4, 0)] / response[0].tangent[packed_at(1, 1)];  // dP_11/dF_00 = lambda
  if (!kept) return own;
  own.kept.emplace_back();
  std::memcpy(own.kept.front().block, stiffness.block, sizeof stiffness.block);
  return own;
}

void move_corner(RotationBatch& batch) {
  const Lanes corner[3] = {batch.X[0][0], batch.X[0][1], batch.X[0][2]};
  for (auto& X : batch.X)
    for (int i = 0; i < 3; ++i) X[i] -= corner[i];
}

void begin_step(double dt, RotationBatch& batch) {
  for (RotationHistory& history : batch.history) {
    history.series.begin_step(dt);
    RotationHistory::Displacements sum = {};
    for (std::size_t k = 0; k < history.parts.size(); ++k)
      for (std::size_t a = 0; a < 10; ++a)
        for (int i = 0; i < 3; ++i) sum[a][i] += history.series.fixed(k, history.parts[k][a][i], history.elastic[a][i]);
    RestStiffness room;
    apply_stiffness(stiffness_of(batch, room), sum, history.fixed);
  }
}

void end_step(const Lanes (&u)[10][3], RotationBatch& batch) {
  if (batch.history.empty()) return;
  SimplexResult<3, 10> unused;
  const RotationState state = evaluate_rotation(batch, u, unused);
  RotationHistory& history = batch.history.front();
  const PronySeries& series = history.series;
  RotationHistory::Displacements force;
  RestStiffness room;
  const RestStiffness& K = stiffness_of(batch, room);
  history.stored = series.rest() * series.scale() * apply_stiffness(K, state.d, force);
  for (std::size_t k = 0; k < history.parts.size(); ++k) {
    for (std::size_t a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i)
        series.advance(k, series.scale() * state.d[a][i] - history.elastic[a][i], history.parts[k][a][i]);
    const Lanes g = series.terms()[k].g, stored = apply_stiffness(K, history.parts[k], force);
    history.stored += g > 0.0 ? stored / (g * series.scale()) : Lanes{};  // a term of 0 stores nothing
  }
  for (std::size_t a = 0; a < 10; ++a)
    for (int i = 0; i < 3; ++i) history.elastic[a][i] = series.scale() * state.d[a][i];
}

RotationState evaluate_rotation(const RotationBatch& batch, const Lanes (&u)[10][3], SimplexResult<3, 10>& result) {
  RotationState state;
  state.energy = Lanes{};
  Tensor<Lanes> F{};
  for (int i = 0; i < 3; ++i) {
    for (int a = 0; a < 4; ++a)
      for (int k = 0; k < 3; ++k) F(i, k) += u[a][i] * batch.g[a][k];
    F(i, i) += 1.0;
  }
  state.R = polar_rotation(F);
  state.J = determinant(F);
  Tensor<Lanes> D{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      state.U(i, j) = state.R(0, i) * F(0, j) + state.R(1, i) * F(1, j) + state.R(2, i) * F(2, j);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) state.U(i, j) = state.U(j, i) = 0.5 * (state.U(i, j) + state.U(j, i));
  const Lanes trace = state.U(0, 0) + state.U(1, 1) + state.U(2, 2);
  for (int k = 0; k < 9; ++k) D.c[k] = -state.U.c[k];
  for (int i = 0; i < 3; ++i) D(i, i) += trace;
  state.inverse = inverse_of(D, state.U);

  Lanes m[3] = {};
  for (int a = 0; a < 10; ++a) {
    // d = R^T (X + u) - X, all relative to corner 0, so that a far origin costs no digits.
    Vector3 x;
    for (int i = 0; i < 3; ++i) x[i] = batch.X[a][i] + (u[a][i] - u[0][i]);
    transposed_times(state.R, x, state.d[a]);
    for (int i = 0; i < 3; ++i) state.d[a][i] -= batch.X[a][i];
  }
  if (batch.kept.empty()) {
    NodeValues<3, 10> d;
    std::memcpy(d.u, state.d, sizeof d.u);
    apply(std::array{hooke_of(batch)}, d, result);
    std::memcpy(state.q, result.force, sizeof state.q);
    for (int a = 0; a < 10; ++a) state.energy += 0.5 * inner<3>(state.d[a], state.q[a]);
  } else {
    state.energy = apply_stiffness(batch.kept.front(), state.d, state.q);
  }
  for (const RotationHistory& history : batch.history) relax(history, state);
  for (int a = 0; a < 10; ++a) {
    Vector3 moment;
    cross(state.d[a], state.q[a], moment);
    for (int i = 0; i < 3; ++i) m[i] += moment[i];
  }
  times(state.inverse, m, state.w);
  for (int a = 0; a < 10; ++a) {
    Vector3 local = {state.q[a][0], state.q[a][1], state.q[a][2]}, turned;
    if (a < 4) {
      cross(state.w, batch.g[a], turned);
      for (int i = 0; i < 3; ++i) local[i] -= turned[i];
    }
    times(state.R, local, result.force[a]);
  }
  return state;
}

namespace {

/// R H_ab R^T for all blocks.
void turn(const Tensor<Lanes>& R, const Lanes (&H)[55][9], SimplexResult<3, 10>& result) {
  for (int k = 0; k < 55; ++k) {
    Tensor<Lanes> half;  // R H
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) half(i, j) = R(i, 0) * H[k][j] + R(i, 1) * H[k][3 + j] + R(i, 2) * H[k][6 + j];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) result.block[k][3 * i + j] = inner<3>(half.c + 3 * i, R.c + 3 * j);
  }
}

}  // namespace

HookePoint turned_hooke(const RotationBatch& batch, const RotationState& state) {
  HookePoint turned = hooke_of(batch).turned(state.R);
  turned.weight *= factor_of(batch);
  return turned;
}

void rotation_tangent(const RotationBatch& batch, const RotationState& state, bool exact,
                      SimplexResult<3, 10>& result) {
  if (!exact && batch.kept.empty()) return make_stiffness(turned_hooke(batch, state), result.block);
  RestStiffness room;
  const RestStiffness& K = stiffness_of(batch, room);
  const Lanes factor = factor_of(batch);
  Lanes H[55][9];
  for (int k = 0; k < 55; ++k)
    for (int i = 0; i < 9; ++i) H[k][i] = factor * K.block[k][i];
  if (exact) add_rotation_terms(batch, K, factor, state, H);
  turn(state.R, H, result);
}

}  // namespace msml::fe
