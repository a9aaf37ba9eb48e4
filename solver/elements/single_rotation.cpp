// SPDX-License-Identifier: GPL-3.0-or-later
// Energy, force and tangent of tet10 elements with one rotation.
#include "solver/elements/single_rotation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "solver/elements/simplex_elements.hpp"
#include "solver/elements/single_rotation_batch.hpp"

namespace msml::fe {
namespace {

class SingleRotationElements final : public Elements {
 public:
  explicit SingleRotationElements(const Model& model) : standard_(model) {
    const auto& batches = standard_.batches();
    batches_.resize(batches.size());
    stored_beside_.assign(batches.size(), 0);
    tbb::parallel_for(std::size_t(0), batches.size(), [&](std::size_t b) {
      batches_[b] = make_rotation_batch(
          batches[b], [&](int q, SimplexGradients<3, 10>& g) { standard_.shape_gradients(batches[b], q, g); });
      batches_[b].exact = batches[b].laws.laws.front()->exact_tangent();
      for (int lane = 0; lane < lanes; ++lane)
        for (int a = 0; a < 10; ++a)
          for (int i = 0; i < 3; ++i)
            batches_[b].X[a][i][lane] =
                model.mesh->points(numbering().node_of[static_cast<std::size_t>(batches[b].node[lane][a])], i);
      move_corner(batches_[b]);
      remember(model, batches[b], batches_[b]);
    });
    if (std::ranges::all_of(batches_, [](const RotationBatch& batch) { return batch.kept.empty(); }))
      kept_.emplace(*this, batches, standard_.colours());
  }

  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override {
    const bool keep = kept_ && want == Want::single_tangent && matrix == nullptr;
    if (keep) kept_->begin(u);
    if (matrix) matrix->set_zero();
    return add_chunks(standard_.colours(), [&](const Chunk& chunk) {
      Notes notes;
      for (int b = chunk.first; b < chunk.last; ++b)
        add_batch(static_cast<std::size_t>(b), u, want, force, matrix, keep, notes);
      return notes.tell(numbering().elements);
    });
  }

  const KeptTangent* kept_tangent() const override { return kept_ ? &*kept_ : nullptr; }
  void add_mass(bool lumped, ScalarMatrix& mass) const override { standard_.add_mass(lumped, mass); }
  void visit_points(const Vector& u, const PointsVisitor& visit) const override { standard_.visit_points(u, visit); }
  void begin_step(double dt) override {
    standard_.begin_step(dt);
    tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) { fe::begin_step(dt, batches_[b]); });
  }
  /// The standard elements remember the stress at points, for results.
  void end_step(const Vector& u) override {
    standard_.end_step(u);
    tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) { end_step(b, u); });
  }
  std::shared_ptr<const std::vector<double>> history_stress() const override { return standard_.history_stress(); }
  std::shared_ptr<const std::vector<double>> history_energy() const override { return standard_.history_energy(); }
  double stored_beside() const override {
    double sum = 0;
    for (const double beside : stored_beside_) sum += beside;
    return sum;
  }
  std::size_t bytes() const override {
    std::size_t sum = standard_.bytes() + (kept_ ? kept_->bytes() : 0);
    for (const RotationBatch& batch : batches_) sum += batch.bytes();
    return sum;
  }
  const Numbering& numbering() const override { return standard_.numbering(); }
  const PatternPtr& pattern() const override { return standard_.pattern(); }

 private:
  using Batch = SimplexBatch<3, 10, 4>;

  void remember(const Model& model, const Batch& batch, RotationBatch& own) const {
    const Region& region = model.regions[static_cast<std::size_t>(batch.region)];
    if (region.prony.g.empty()) return;
    const std::span<const int> elements(numbering().elements.data() + batch.first,
                                        static_cast<std::size_t>(batch.count));
    std::vector<Vec3> middles(elements.size(), Vec3::Zero());
    for (std::size_t k = 0; k < elements.size(); ++k)
      for (int a = 0; a < 4; ++a)
        middles[k] += 0.25 * model.mesh->points.row(model.mesh->cell(elements[k])[a]).transpose();
    own.history.emplace_back(series_of(region, elements, {&middles, 1}).front());
  }

  void end_step(std::size_t b, const Vector& u) {
    Lanes moved[10][3];
    gather_vectors(standard_.batches()[b], u.data(), moved);
    fe::end_step(moved, batches_[b]);
    SimplexResult<3, 10> unused;
    const RotationState state = evaluate_rotation(batches_[b], moved, unused);
    stored_beside_[b] = 0;
    for (const RotationHistory& history : batches_[b].history)
      for (int lane = 0; lane < standard_.batches()[b].count; ++lane)
        stored_beside_[b] += history.stored[lane] - state.energy[lane];
  }

  /// The tangent goes to a matrix, is kept, or neither.
  void add_batch(std::size_t b, const Vector& u, Want want, Vector& force, BlockMatrix* matrix, bool keep,
                 Notes& notes) const {
    const auto& batch = standard_.batches()[b];
    const RotationBatch& own = batches_[b];
    if (matrix) fetch_blocks(batch, *matrix);
    Lanes moved[10][3];
    gather_vectors(batch, u.data(), moved);
    SimplexResult<3, 10> result;
    const RotationState state = evaluate_rotation(own, moved, result);
    notes.add(state.energy, state.J, batch.first);
    scatter_force<3, 10>(batch, result, force);
    if (keep) kept_->at(b) = {turned_hooke(own, state)};
    if (!matrix) return;
    rotation_tangent(own, state, want == Want::tangent && own.exact, result);
    scatter_stiffness<3, 10>(batch, result, *matrix);
  }

  SimplexElements<3, 10> standard_;
  std::vector<RotationBatch> batches_;
  std::vector<double> stored_beside_;         ///< of each batch
  mutable std::optional<KeptHooke<1>> kept_;  ///< null unless all elements are straight
};

}  // namespace

std::unique_ptr<Elements> make_single_rotation_elements(const Model& model) {
  return std::make_unique<SingleRotationElements>(model);
}

}  // namespace msml::fe
