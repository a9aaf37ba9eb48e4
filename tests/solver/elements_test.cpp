// SPDX-License-Identifier: GPL-3.0-or-later
// What every element and every quadrature rule must satisfy.
#include <gtest/gtest.h>

#include "solver/elements/assembly.hpp"
#include "solver/elements/chunks.hpp"
#include "solver/elements/mass.hpp"
#include "tests/solver/element_points.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// int x^a y^b z^c over the reference simplex = a! b! c! / (a + b + c + dimension)!.
template <int dimension>
void expect_degree(const Rule<dimension>& rule, int degree) {
  for (int a = 0; a <= degree; ++a)
    for (int b = 0; a + b <= (dimension >= 2 ? degree : a); ++b)
      for (int c = 0; a + b + c <= (dimension == 3 ? degree : a + b); ++c) {
        double sum = 0;
        for (const auto& q : rule)
          sum += q.weight * std::pow(q.xi[0], a) *
                 (dimension >= 2 ? std::pow(q.xi[std::min(dimension - 1, 1)], b) : 1) *
                 (dimension == 3 ? std::pow(q.xi[dimension - 1], c) : 1);
        const double exact = factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + dimension);
        EXPECT_NEAR(sum, exact, 1e-14) << a << " " << b << " " << c;
      }
}

TEST(Quadrature, RulesAreExactToTheirDegree) {
  expect_degree(one_point_rule(), 1);
  expect_degree(four_point_rule(), 2);
  expect_degree(triangle_rule(1), 1);
  expect_degree(triangle_rule(3), 2);
  for (int n = 1; n <= 5; ++n) {
    expect_degree(collapsed_tetrahedron_rule(n), 2 * n - 1);
    expect_degree(collapsed_triangle_rule(n), 2 * n - 1);
    expect_degree(line_rule(n), 2 * n - 1);
  }
}

template <int dimension, int nodes>
struct ElementCase {
  static std::array<double, dimension> node_place(int a) {
    using Element = Simplex<dimension, nodes>;
    std::array<double, dimension> x{};
    const auto corner = [](int c, int d) { return c == d + 1 ? 1.0 : 0.0; };
    for (int d = 0; d < dimension; ++d)
      x[d] = a < Element::corners ? corner(a, d)
                                  : 0.5 * (corner(Element::edges[a - Element::corners][0], d) +
                                           corner(Element::edges[a - Element::corners][1], d));
    return x;
  }

  static void check() {
    using Element = Simplex<dimension, nodes>;
    for (int a = 0; a < nodes; ++a) {
      const auto N = Element::values(node_place(a));
      for (int b = 0; b < nodes; ++b) EXPECT_NEAR(N[b], a == b ? 1 : 0, 1e-15) << a << " " << b;
    }
    const typename Element::Point places[2] = {make(0.2), make(0.11)};
    for (const auto& x : places) {
      double sum = 0, h = 1e-6;
      for (const double N : Element::values(x)) sum += N;
      EXPECT_NEAR(sum, 1, 1e-15);
      for (int d = 0; d < dimension; ++d) {
        auto up = x, down = x;
        up[d] += h;
        down[d] -= h;
        double total = 0;
        for (int a = 0; a < nodes; ++a) {
          total += Element::gradients(x)[a][d];
          // Central differences are exact for quadratics but for round-off 1e-16 / h.
          EXPECT_NEAR(Element::gradients(x)[a][d], (Element::values(up)[a] - Element::values(down)[a]) / (2 * h), 1e-9);
        }
        EXPECT_NEAR(total, 0, 1e-14);
      }
    }
  }
  static std::array<double, dimension> make(double s) {
    std::array<double, dimension> x;
    for (int d = 0; d < dimension; ++d) x[d] = s * (d + 1);
    return x;
  }
};

TEST(EveryElement, SumsToOneAndIsOneAtItsOwnNodeOnly) {
  ElementCase<3, 4>::check();
  ElementCase<3, 10>::check();
  ElementCase<2, 3>::check();
  ElementCase<2, 6>::check();
  ElementCase<1, 2>::check();
  ElementCase<1, 3>::check();
}

// rho V / 20 (1 + delta_ab), V = 1/6 * |det| of the three edges.
TEST(Tet4, MassIsTheClosedForm) {
  Points points(4, 3);
  points << 0, 0, 0, 2, 0, 0, 0.5, 3, 0, 0.3, 0.2, 1.5;
  const int ids[4] = {0, 1, 2, 3};
  const double rho = 7, V = 2 * 3 * 1.5 / 6;
  const auto M = consistent_mass<3, 4>(points, ids, rho);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) EXPECT_NEAR(M(a, b), rho * V / 20 * (a == b ? 2 : 1), 1e-13);
  const auto L = lumped_mass<4>(M);
  for (int a = 0; a < 4; ++a) EXPECT_NEAR(L(a, a), rho * V / 4, 1e-13);
}

TEST(EveryElement, MassAddsUpToDensityTimesVolume) {
  for (const CellKind kind : every_kind)
    for (const bool lumped : {false, true}) {
      const Model model = [&] {
        if (dimension(kind) == 3) return make_model(box_mesh(3, 2, 1, {3, 1, 0.5}, kind), {}, 11);
        Model flat = dimension(kind) == 2 ? make_model(rectangle_mesh(3, 2, 3, 1, kind), {}, 11)
                                          : make_model(segment_mesh(4, 3, kind), {}, 11);
        flat.thickness = 0.5;  // or the cross-section of a line
        return flat;
      }();
      const auto elements = make_elements(model);
      ScalarMatrix mass(elements->pattern());
      elements->add_mass(lumped, mass);
      double sum = 0;
      for (const double m : mass.values) sum += m;
      EXPECT_NEAR(sum, 11 * 1.5, 1e-12);
      if (!lumped) continue;
      for (const int p : mass.pattern->diagonal) EXPECT_GT(mass.values[static_cast<std::size_t>(p)], 0);
    }
}

// The volume of a curved tet10 mesh of a ball's octant tends to pi/6 with the square of the square of the size.
TEST(Tet10, CurvedElementsFillTheBall) {
  double before = 0;
  for (const int n : {2, 4}) {
    const Model model = make_model(sphere_octant(n, 1, 2, CellKind::tet10), {});
    const auto elements = make_elements(model);
    double volume = 0;
    for (const ElementPoints& e : points_of(*elements, Vector::Zero(3 * elements->numbering().nodes())))
      for (int q = 0; q < e.count; ++q) volume += e.weight[q];
    const double error = std::abs(volume - M_PI / 6 * 7);
    if (n == 4) {
      EXPECT_LT(error, before / 10);
    }
    before = error;
  }
}

TEST(Numbering, SkipsPointsOutsideElements) {
  Mesh mesh = box_mesh(1, 1, 1, {1, 1, 1}, CellKind::tet4);
  mesh.points.conservativeResize(10, 3);
  mesh.points.row(8) = Eigen::RowVector3d(5, 5, 5);
  mesh.points.row(9) = Eigen::RowVector3d(-5, 5, 5);
  const Numbering numbering = number(make_model(std::move(mesh), {}));
  EXPECT_EQ(numbering.nodes(), 8);
  EXPECT_EQ(numbering.number_of[8], -1);
  Vector values = Vector::Ones(24);
  EXPECT_EQ(to_points(numbering, values).row(9).norm(), 0);
  EXPECT_EQ(to_vector(numbering, to_points(numbering, values)), values);
}

std::vector<std::vector<int>> batches_of(const Numbering& numbering) {
  std::vector<std::vector<int>> batches;
  for (std::size_t e = 0; e < numbering.element_nodes.size(); e += 32)
    batches.emplace_back(numbering.element_nodes.begin() + static_cast<long>(e),
                         numbering.element_nodes.begin() + static_cast<long>(e) + 32);
  return batches;
}

TEST(Chunks, OfOneColourShareNoNode) {
  const Model model = make_model(box_mesh(10, 10, 10, {1, 1, 1}, CellKind::tet4), {});
  const Numbering numbering = number(model);
  const auto batches = batches_of(numbering);
  std::size_t seen = 0;
  for (const auto& chunks : colour_chunks(batches, numbering.nodes())) {
    std::map<int, int> owner;
    for (const Chunk& chunk : chunks)
      for (int b = chunk.first; b < chunk.last; ++b, ++seen)
        for (const int node : batches[static_cast<std::size_t>(b)]) {
          const auto [it, fresh] = owner.emplace(node, chunk.first);
          EXPECT_TRUE(fresh || it->second == chunk.first) << "node " << node;
        }
  }
  EXPECT_EQ(seen, batches.size());
}

// Two threads wait for each other at the end of each colour: nothing much is lost where each has enough to do.
TEST(Chunks, OfAllColoursAreAboutAsMany) {
  for (const int n : {6, 10, 16}) {
    const Model model = make_model(box_mesh(n, n, n, {1, 1, 1}, CellKind::tet4), {});
    const Numbering numbering = number(model);
    const auto colours = colour_chunks(batches_of(numbering), numbering.nodes());
    std::size_t least = 1000000, all = 0;
    for (const auto& chunks : colours) least = std::min(least, chunks.size()), all += chunks.size();
    EXPECT_GE(least, 4u) << n;
    EXPECT_GE(static_cast<double>(least), 0.6 * static_cast<double>(all) / static_cast<double>(colours.size())) << n;
  }
}

}  // namespace
}  // namespace msml::fe
