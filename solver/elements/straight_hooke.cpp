// SPDX-License-Identifier: GPL-3.0-or-later
// Products with the stiffness of straight quadratic tetrahedra, and its blocks.
#include "solver/elements/straight_hooke.hpp"

#include "solver/elements/gradient_products.hpp"
#include "solver/elements/quadrature.hpp"
#include "solver/materials/corotation.hpp"

namespace msml::fe {

StraightHooke StraightHooke::turned(const Tensor<Lanes>& R) const {
  StraightHooke out{.inverse = {}, .shear = shear, .ratio = ratio};
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 3; ++i) out.inverse[3 * c + i] = inner<3>(R.c + 3 * i, inverse + 3 * c);
  return out;
}

StraightHooke StraightHooke::lane(int k) const {
  StraightHooke out;
  for (int i = 0; i < 9; ++i) out.inverse[i] = lanes_of(inverse[i][k]);
  out.shear = lanes_of(shear[k]);
  out.ratio = lanes_of(ratio[k]);
  return out;
}

[[gnu::flatten]] void apply(const StraightHooke& hooke, const NodeValues<3, 10>& d, SimplexResult<3, 10>& result) {
  static const auto points = stiffness_rule<3, 10>();
  static const auto barycentric = [] {
    std::array<Barycentric<3>, 4> L;
    for (std::size_t p = 0; p < 4; ++p) L[p] = Tetrahedron<10>::barycentric(points[p].xi);
    return L;
  }();
  const Slopes<3, 10> moved = slopes(d);
  PointWork<3> work[4];
  for (std::size_t p = 0; p < 4; ++p) {
    Gradients H;
    displacement_gradient<3, 10>(moved, hooke.inverse, barycentric[p], H);
    const Lanes pressure = hooke.ratio * trace(H);
    Tensor<Lanes> stress;  // over mu
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < i; ++j) stress(i, j) = stress(j, i) = H(i, j) + H(j, i);
      stress(i, i) = 2.0 * H(i, i) + pressure;
    }
    work[p] = work_at<3>(stress, 6 * points[p].weight * hooke.shear, hooke.inverse);
  }
  set_forces(work, barycentric, result);
}

void make_stiffness(const StraightHooke& hooke, Lanes (&block)[55][9]) {
  Lanes G[10][3];
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c) G[c + 1][i] = hooke.inverse[3 * c + i];
    G[0][i] = -(G[1][i] + G[2][i] + G[3][i]);
  }
  set_mid_gradients(G);
  for (int b = 0; b < 10; ++b)
    for (int a = 0; a <= b; ++a) {
      const GradientProduct& product = gradient_products[static_cast<std::size_t>(16 * a + b)];
      Tensor<Lanes> D;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          Lanes sum = product.first * (G[a][i] * G[b][j]);
          for (std::size_t n = 0; n < static_cast<std::size_t>(product.count); ++n)
            sum += product.second * (G[product.pairs[n][0]][i] * G[product.pairs[n][1]][j]);
          D(i, j) = hooke.shear * sum;
        }
      Lanes* K = block[packed(b, a)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) K[3 * i + j] = D(j, i) + hooke.ratio * D(i, j);
      for (int i = 0; i < 3; ++i) K[4 * i] += trace(D);
    }
}

}  // namespace msml::fe
