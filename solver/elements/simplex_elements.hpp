// SPDX-License-Identifier: GPL-3.0-or-later
// Lines, triangles and tetrahedra with linear or quadratic shapes, eight at a time.
#pragma once
#include "solver/elements/assembly.hpp"
#include "solver/elements/chunks.hpp"
#include "solver/elements/kept_hooke.hpp"
#include "solver/elements/mass.hpp"
#include "solver/elements/rotated_rows.hpp"
#include "solver/elements/shapes.hpp"
#include "solver/elements/simplex_batch.hpp"

namespace msml::fe {

/// Lines lie along x (uniaxial strain: F = diag(F_11, 1, 1)), triangles in a plane of constant z. The gradient has
/// `dimension` rows and columns, the rest is zero (plane strain) or the law's own (plane stress).
template <int dimension, int nodes, int count = stiffness_points<dimension, nodes>>
class SimplexElements final : public Elements {
 public:
  explicit SimplexElements(const Model& model);
  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override;
  void add_mass(bool lumped, ScalarMatrix& mass) const override;
  void visit_points(const Vector& u, const PointsVisitor& visit) const override;
  void begin_step(double dt) override;
  void end_step(const Vector& u) override;
  std::shared_ptr<const std::vector<double>> history_stress() const override;
  std::size_t bytes() const override;
  std::shared_ptr<const std::vector<double>> history_energy() const override;
  double stored_beside() const override;
  /// Of quadratic tetrahedra whose tangents are those of RotatedResponse.
  const KeptTangent* kept_tangent() const override { return kept_.get(); }
  const Numbering& numbering() const override { return numbering_; }
  const PatternPtr& pattern() const override { return pattern_; }

  using Batch = SimplexBatch<dimension, nodes, count>;
  using ShapeGradients = SimplexGradients<dimension, nodes>;
  const std::vector<Batch>& batches() const { return batches_; }
  const std::vector<std::vector<Chunk>>& colours() const { return colours_; }  ///< of batches
  /// dN/dX at quadrature point q of a batch.
  void shape_gradients(const Batch& batch, int q, ShapeGradients& g) const;

 private:
  static constexpr bool keeps = dimension == 3 && nodes == 10 && count == 4;  ///< tangents, see KeptHooke
  static constexpr int strip_batches = std::max(1, 8 / count), strip_points = strip_batches * count;
  const Points& positions() const { return numbering_.mesh->points; }  ///< at rest
  static Rule<dimension> rule();
  void end_step(Batch& batch, const Vector& u) const;
  void make_batches(const Model& model);
  void fill(Batch& batch, typename Batch::Positions* position, const Model& model) const;
  void set_gradients(const Batch& batch, const Vector& u, Gradients* H) const;
  /// Calls evaluate(laws, gradients, responses) and then add(batch, gradients, responses, notes) for all batches, some
  /// at a time: eight points in a row keep the processor busy where those of one batch wait for each other.
  template <class Response, class Evaluate, class Add>
  Assembled add_strips(const Vector& u, bool positions, const Evaluate& evaluate, const Add& add) const;
  template <class Response>
  void add_force(const Batch& batch, const Gradients* H, const Response* response, Vector& force, Notes& notes) const;
  void add_tangent(const Batch& batch, const Response* response, BlockMatrix& matrix) const;
  bool all_rotated(Want want) const;
  /// The forces; and calls keep(batch, responses), from which tangents are made.
  template <class Keep>
  Assembled add_rotated(const Vector& u, Want want, Vector& force, const Keep& keep) const;
  Assembled add_by_rows(const Vector& u, Want want, Vector& force, BlockMatrix& matrix) const;
  Assembled add_kept(const Vector& u, Vector& force) const;

  Numbering numbering_;
  PatternPtr pattern_;
  Densities densities_;
  double thickness_ = 1;
  bool stored_energies_ = true, remembers_ = false;
  std::array<bool, 4> rotated_{};  ///< by Want: all tangents are those of RotatedResponse, and the elements linear
  std::vector<Batch> batches_;
  std::vector<typename Batch::Positions> block_positions_;  ///< of the lanes of all batches
  std::vector<std::vector<Chunk>> colours_;
  mutable int matrices_ = 0;                 ///< asked for so far
  mutable std::optional<RotatedRows> rows_;  ///< of linear tetrahedra with such tangents; made for the third matrix
  std::unique_ptr<KeptHooke<4>> kept_;       ///< null where none is kept
  std::array<ReferenceGradients<dimension, nodes>, count> reference_gradients_;
  std::array<Barycentric<dimension>, count> barycentric_;  ///< of the quadrature points
};

}  // namespace msml::fe
