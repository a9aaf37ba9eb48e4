// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra with 4 or 10 nodes, eight at a time.
#pragma once
#include "solver/elements/assembly.hpp"
#include "solver/elements/chunks.hpp"
#include "solver/elements/shapes.hpp"

namespace msml::fe {

/// Eight elements of one region side by side. Unused lanes of the last batch repeat an element with weight 0.
template <int nodes>
struct TetBatch {
  struct Point {
    Tensor<Lanes> inverse;  ///< dxi/dX
    Lanes weight;           ///< reference volume of the point
  };
  int region = 0, count = 0;
  int first = 0;                       ///< place in Numbering::elements of lane 0; the lanes follow
  int node[lanes][nodes];              ///< numbered nodes
  int position[lanes][nodes * nodes];  ///< of block (a, b) in the pattern, at a * nodes + b
  Point points[stiffness_points<nodes>];
};

/// dN_a/dX of eight elements at one point.
template <int nodes>
struct TetGradients {
  Lanes g[nodes][3];
};

/// Internal force and stiffness of eight elements. Blocks (a, b), a <= b, at b(b+1)/2 + a.
template <int nodes>
struct TetResult {
  Lanes force[nodes][3];
  Lanes block[nodes * (nodes + 1) / 2][9];
};

template <int nodes>
class TetElements final : public Elements {
 public:
  explicit TetElements(const Model& model);
  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override;
  void add_mass(bool lumped, ScalarMatrix& mass) const override;
  std::vector<ElementPoints> points(const Vector& u) const override;
  const Numbering& numbering() const override { return numbering_; }
  const PatternPtr& pattern() const override { return pattern_; }

 private:
  using Batch = TetBatch<nodes>;
  void make_batches();
  void fill(Batch& batch, const Points& points) const;
  Gradients gradient(const Batch& batch, int q, const Vector& u, TetGradients<nodes>& g) const;
  Assembled add_batch(const Batch& batch, const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const;

  Numbering numbering_;
  PatternPtr pattern_;
  Points points_;  ///< reference positions of the mesh
  std::vector<std::shared_ptr<const Law>> laws_;
  std::vector<double> densities_;
  std::vector<Batch> batches_;
  std::vector<std::vector<Chunk>> colours_;
  std::array<std::array<std::array<double, 3>, nodes>, stiffness_points<nodes>> reference_gradients_;
};

extern template class TetElements<4>;
extern template class TetElements<10>;

}  // namespace msml::fe
