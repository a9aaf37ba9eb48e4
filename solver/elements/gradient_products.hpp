// SPDX-License-Identifier: GPL-3.0-or-later
// What the stiffness of straight quadratic tetrahedra is made of.
#pragma once
#include <array>

#include "solver/elements/shapes.hpp"

namespace msml::fe {

/// The mean of (grad N_a)(grad N_b)^T over a straight tetrahedron: first G_a G_b^T + second sum_k G_x G_y^T over
/// `count` pairs (x, y) of corners, where G is the gradient of a corner's linear shape function and, at mid nodes, the
/// sum of those of the edge's two corners. From the means of L_i L_j: 1/20, of L_i^2: 1/10, of L_i: 1/4.
struct GradientProduct {
  double first = 1, second = 0;
  int count = 0;
  std::array<std::array<int, 2>, 2> pairs{};
  constexpr void add(int x, int y) { pairs[static_cast<std::size_t>(count++)] = {x, y}; }
};

namespace detail {

constexpr GradientProduct quadratic_product(int a, int b) {
  constexpr double apart = -0.2, equal = 0.6, mid = 0.8;
  const auto ends = [](int node) { return Tetrahedron<10>::edges[static_cast<std::size_t>(node - 4)]; };
  const auto other = [&](int node, int corner) { return ends(node)[0] == corner ? ends(node)[1] : ends(node)[0]; };
  const auto holds = [&](int node, int corner) { return ends(node)[0] == corner || ends(node)[1] == corner; };
  if (a < 4 && b < 4) return {.first = a == b ? equal : apart, .second = mid};
  GradientProduct product{.first = a < 4 || b < 4 ? apart : mid, .second = mid};
  if (a < 4) {
    if (holds(b, a)) product.add(a, other(b, a));
  } else if (b < 4) {
    if (holds(a, b)) product.add(other(a, b), b);
  } else {
    for (const int corner : ends(a))
      if (holds(b, corner)) product.add(other(a, corner), other(b, corner));
  }
  return product;
}

constexpr std::array<GradientProduct, 160> make_products() {
  std::array<GradientProduct, 160> products;
  for (int a = 0; a < 10; ++a)
    for (int b = 0; b < 10; ++b) products[static_cast<std::size_t>(16 * a + b)] = quadratic_product(a, b);
  return products;
}

}  // namespace detail

/// Of nodes a and b at 16 a + b.
inline constexpr std::array<GradientProduct, 160> gradient_products = detail::make_products();

}  // namespace msml::fe
