// SPDX-License-Identifier: GPL-3.0-or-later
// Products with the stiffness of quadratic tetrahedra, and its blocks.
#include "solver/elements/hooke_points.hpp"

#include "solver/elements/gradient_products.hpp"
#include "solver/elements/quadrature.hpp"
#include "solver/materials/corotation.hpp"

namespace msml::fe {

HookePoint HookePoint::turned(const Tensor<Lanes>& R) const {
  HookePoint out{.inverse = {}, .weight = weight, .ratio = ratio};
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 3; ++i) out.inverse[3 * c + i] = inner<3>(R.c + 3 * i, inverse + 3 * c);
  return out;
}

HookePoint HookePoint::lane(int k) const {
  HookePoint out;
  for (int i = 0; i < 9; ++i) out.inverse[i] = lanes_of(inverse[i][k]);
  out.weight = lanes_of(weight[k]);
  out.ratio = lanes_of(ratio[k]);
  return out;
}

template <std::size_t distinct>
[[gnu::flatten]] void apply(const std::array<HookePoint, distinct>& points, const NodeValues<3, 10>& d,
                            SimplexResult<3, 10>& result) {
  static const auto barycentric = [] {
    const auto rule = stiffness_rule<3, 10>();
    std::array<Barycentric<3>, 4> L;
    for (std::size_t q = 0; q < 4; ++q) L[q] = Tetrahedron<10>::barycentric(rule[q].xi);
    return L;
  }();
  const Slopes<3, 10> moved = slopes(d);
  PointWork<3> work[4];
  for (std::size_t q = 0; q < 4; ++q) {
    const HookePoint& point = points[q % distinct];
    Gradients H;
    displacement_gradient<3, 10>(moved, point.inverse, barycentric[q], H);
    const Lanes pressure = point.ratio * trace(H);
    Tensor<Lanes> stress;  // over mu
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < i; ++j) stress(i, j) = stress(j, i) = H(i, j) + H(j, i);
      stress(i, i) = 2.0 * H(i, i) + pressure;
    }
    work[q] = work_at<3>(stress, point.weight, point.inverse);
  }
  set_forces(work, barycentric, result);
}

template void apply(const std::array<HookePoint, 1>&, const NodeValues<3, 10>&, SimplexResult<3, 10>&);
template void apply(const std::array<HookePoint, 4>&, const NodeValues<3, 10>&, SimplexResult<3, 10>&);

void make_stiffness(const HookePoint& all, Lanes (&block)[55][9]) {
  Lanes G[10][3];
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c) G[c + 1][i] = all.inverse[3 * c + i];
    G[0][i] = -(G[1][i] + G[2][i] + G[3][i]);
    for (std::size_t k = 0; k < 6; ++k)
      G[4 + k][i] = G[Tetrahedron<10>::edges[k][0]][i] + G[Tetrahedron<10>::edges[k][1]][i];
  }
  for (int b = 0; b < 10; ++b)
    for (int a = 0; a <= b; ++a) {
      const GradientProduct& product = gradient_products[static_cast<std::size_t>(16 * a + b)];
      Tensor<Lanes> D;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          Lanes sum = product.first * (G[a][i] * G[b][j]);
          for (std::size_t n = 0; n < static_cast<std::size_t>(product.count); ++n)
            sum += product.second * (G[product.pairs[n][0]][i] * G[product.pairs[n][1]][j]);
          D(i, j) = 4.0 * all.weight * sum;
        }
      Lanes* K = block[packed(b, a)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) K[3 * i + j] = D(j, i) + all.ratio * D(i, j);
      for (int i = 0; i < 3; ++i) K[4 * i] += trace(D);
    }
}

}  // namespace msml::fe
