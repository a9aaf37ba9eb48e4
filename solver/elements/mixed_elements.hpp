// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra with quadratic displacement and linear pressure (Taylor and Hood), eight at a time.
#pragma once
#include "solver/elements/assembly.hpp"
#include "solver/elements/chunks.hpp"
#include "solver/elements/mass.hpp"
#include "solver/elements/pressure_history.hpp"
#include "solver/elements/prony_history.hpp"
#include "solver/elements/shapes.hpp"
#include "solver/elements/split_laws.hpp"

namespace msml::fe {

/// Eight elements of one region side by side, with that many quadrature points. Unused lanes of the last batch repeat
/// an element with weight 0.
template <int rule_points>
struct MixedBatch {
  static constexpr int body = 10, corners = 4, nodes = body + corners, points = rule_points;
  struct Point {
    Tensor<Lanes> inverse;  ///< dxi/dX
    Lanes weight;           ///< reference volume of the point
  };
  int region = 0, count = 0;
  int first = 0;                       ///< place in Numbering::elements of lane 0; the lanes follow
  int node[lanes][nodes];              ///< ten nodes of the body, then the pressure nodes of the corners
  int position[lanes][nodes * nodes];  ///< of block (a, b) in the pattern, at a * nodes + b
  Point point[points];
  BatchSplit law;
  PronyHistory history;      ///< empty where elastic
  double stored_beside = 0;  ///< see Elements::stored_beside
};

/// Stationary points of int rest(F) + p g(F) - p^2/(2 k) with the pressure p linear in each element and continuous in
/// each region: the perturbed Lagrangian, for k = infinity that of the constraint g = 0 (Sussman and Bathe 1987,
/// doi 10.1016/0045-7949(87)90265-3; stable pair: Taylor and Hood 1973, doi 10.1016/0045-7930(73)90027-3).
/// p = Numbering::pressure_scale times the first component of the additional node of each corner. The tangent is
/// symmetric and indefinite. Want::definite_tangent leaves out p d2g/dF2.
/// With a history (see PronyHistory) p stays the pressure of the elastic law: all of S_e = d(rest + p g)/dE relaxes, so
/// that the elements agree with the standard ones where the law is compressible. Stationary is then, with the factor of
/// the step, int factor (rest + p g - p^2/(2 k)) + Q : E, which is symmetric too. What acts of the pressure is the
/// convolution of p, see Elements::acting. Four points integrate straight elements (degree 2), eight also the forces of
/// curved ones at a constant stress (degree 3).
template <int points>
class MixedElements final : public Elements {
 public:
  explicit MixedElements(const Model& model);
  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override;
  void add_mass(bool lumped, ScalarMatrix& mass) const override;
  void visit_points(const Vector& u, const PointsVisitor& visit) const override;
  void begin_step(double dt) override;
  void end_step(const Vector& u) override;
  std::shared_ptr<const std::vector<double>> history_stress() const override;
  std::shared_ptr<const std::vector<double>> history_energy() const override;
  double stored_beside() const override;
  Vector acting(const Vector& u) const override { return pressures_.acting(u); }
  std::size_t bytes() const override;
  const Numbering& numbering() const override { return numbering_; }
  const PatternPtr& pattern() const override { return pattern_; }

 private:
  using Batch = MixedBatch<points>;
  const Points& positions() const { return numbering_.mesh->points; }  ///< at rest
  struct Values;
  static Rule<3> rule();
  void make_batches(const Model& model, const std::vector<int>& element_nodes);
  void fill(Batch& batch, const Model& model, const std::vector<int>& element_nodes) const;
  void set_scale(const Model& model);
  Values values(const Batch& batch, int q, const Vector& u) const;
  void end_step(Batch& batch, const Vector& u) const;
  Assembled add_batch(const Batch& batch, const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const;

  Numbering numbering_;
  PressureHistory pressures_;
  bool stored_energies_ = true;
  PatternPtr pattern_;
  std::vector<int> cells_;  ///< mesh points of the ten nodes of each element of numbering()
  Densities densities_;
  std::vector<Batch> batches_;
  std::vector<std::vector<Chunk>> colours_;
  std::array<std::array<std::array<double, 3>, Batch::body>, points> reference_gradients_;
  std::array<std::array<double, Batch::corners>, points> barycentric_;
};

}  // namespace msml::fe
