// SPDX-License-Identifier: GPL-3.0-or-later
// Energy, force and tangent of tet10 elements with one rotation.
#include "solver/elements/single_rotation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "solver/elements/node_parts.hpp"
#include "solver/elements/simplex_elements.hpp"
#include "solver/elements/single_rotation_batch.hpp"

namespace msml::fe {
namespace {

class SingleRotationElements final : public Elements, public KeptTangent {
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
    straight_ = std::ranges::all_of(batches_, [](const RotationBatch& batch) { return batch.kept.empty(); });
  }

  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override {
    const bool keep = straight_ && want == Want::single_tangent && matrix == nullptr;
    if (keep) turned_.resize(batches_.size());
    if (matrix) matrix->set_zero();
    return add_chunks(standard_.colours(), [&](const Chunk& chunk) {
      Notes notes;
      for (int b = chunk.first; b < chunk.last; ++b)
        add_batch(static_cast<std::size_t>(b), u, want, force, matrix, keep, notes);
      return notes.tell(numbering().elements);
    });
  }

  const KeptTangent* kept_tangent() const override { return straight_ ? this : nullptr; }
  /// Elements write what nodes gather: two loops in parallel, where colours would be one each.
  void multiply(double s, const ScalarMatrix& M, const Vector& x, Vector& y) const override {
    if (!parts_) parts_.emplace(numbering());
    y.resize(x.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batches_.size(), 16), [&](const auto& range) {
      for (std::size_t b = range.begin(); b < range.end(); ++b) {
        SimplexResult<3, 10> result;
        apply(turned_[b], gather_nodes<3, 10>(standard_.batches()[b], x), result);
        parts_->set(standard_.batches()[b], result.force);
      }
    });
    tbb::parallel_for(tbb::blocked_range<int>(0, numbering().nodes(), 128), [&](const auto& range) {
      fe::multiply(M, range.begin(), range.end(), x, y, s);
      parts_->add(range.begin(), range.end(), y);
    });
  }
  /// One element after the other, as eight vectors fill the lanes.
  void multiply(double s, const ScalarMatrix& M, const std::vector<Eight>& X, std::vector<Eight>& Y) const override {
    fe::multiply(M, X, Y, s);
    for_batches(standard_.colours(), [&](std::size_t b) {
      const Batch& batch = standard_.batches()[b];
      for (int lane = 0; lane < batch.count; ++lane) add_eight(turned_[b].lane(lane), batch.node[lane], X, Y);
    });
  }
  void assemble(BlockMatrix& matrix) const override {
    matrix.set_zero();
    for_batches(standard_.colours(), [&](std::size_t b) {
      const Batch& batch = standard_.batches()[b];
      fetch_blocks(batch, matrix);
      SimplexResult<3, 10> result;
      make_stiffness(turned_[b], result.block);
      scatter_stiffness<3, 10>(batch, result, matrix);
    });
  }

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
    std::size_t sum = standard_.bytes() + turned_.size() * sizeof(StraightHooke) + (parts_ ? parts_->bytes() : 0);
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

  static void add_eight(const StraightHooke& hooke, const int (&node)[10], const std::vector<Eight>& X,
                        std::vector<Eight>& Y) {
    NodeValues<3, 10> x;
    SimplexResult<3, 10> result;
    for (int a = 0; a < 10; ++a) std::memcpy(x.u[a], &X[3 * static_cast<std::size_t>(node[a])], sizeof x.u[a]);
    apply(hooke, x, result);
    for (int a = 0; a < 10; ++a) {
      Eight* out = &Y[3 * static_cast<std::size_t>(node[a])];
      Lanes sum[3];
      std::memcpy(sum, out, sizeof sum);
      for (int i = 0; i < 3; ++i) sum[i] += result.force[a][i];
      std::memcpy(out, sum, sizeof sum);
    }
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
    if (keep) turned_[b] = turned_hooke(own, state);
    if (!matrix) return;
    rotation_tangent(own, state, want == Want::tangent && own.exact, result);
    scatter_stiffness<3, 10>(batch, result, *matrix);
  }

  SimplexElements<3, 10> standard_;
  std::vector<RotationBatch> batches_;
  std::vector<double> stored_beside_;           ///< of each batch
  bool straight_ = false;                       ///< no batch keeps its stiffness
  mutable std::optional<NodeParts<10>> parts_;  ///< of products
  mutable std::vector<StraightHooke> turned_;   ///< of each batch, the tangent that is kept
};

}  // namespace

std::unique_ptr<Elements> make_single_rotation_elements(const Model& model) {
  return std::make_unique<SingleRotationElements>(model);
}

}  // namespace msml::fe
