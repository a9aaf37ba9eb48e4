// SPDX-License-Identifier: GPL-3.0-or-later
// Energy, force and tangent of tet10 elements with one rotation.
#include "solver/elements/single_rotation.hpp"

#include <tbb/parallel_for.h>

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
    });
  }

  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override {
    Assembled sum;
    for (const auto& chunks : standard_.colours()) {
      std::vector<Assembled> parts(chunks.size());
      tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t c) {
        for (int b = chunks[c].first; b < chunks[c].last; ++b)
          merge(parts[c], add_batch(static_cast<std::size_t>(b), u, want, force, matrix));
      });
      for (const Assembled& part : parts) merge(sum, part);
    }
    return sum;
  }

  void add_mass(bool lumped, ScalarMatrix& mass) const override { standard_.add_mass(lumped, mass); }
  void visit_points(const Vector& u, const PointsVisitor& visit) const override { standard_.visit_points(u, visit); }
  std::size_t bytes() const override { return standard_.bytes() + batches_.size() * sizeof(RotationBatch); }
  const Numbering& numbering() const override { return standard_.numbering(); }
  const PatternPtr& pattern() const override { return standard_.pattern(); }

 private:
  Assembled add_batch(std::size_t b, const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const {
    const auto& batch = standard_.batches()[b];
    const RotationBatch& own = batches_[b];
    Lanes moved[10][3];
    for (int a = 0; a < 10; ++a)
      for (int i = 0; i < 3; ++i) moved[a][i] = gather(batch, a, u.data() + i);
    SimplexResult<3, 10> result;
    const RotationState state = evaluate_rotation(own, moved, result);
    Assembled found;
    for (int lane = 0; lane < batch.count; ++lane) {
      found.energy += state.energy[lane];
      if (!std::isfinite(state.energy[lane]) || !std::isfinite(state.J[lane])) found.finite = false;
      if (state.J[lane] < found.smallest_J) {
        found.smallest_J = state.J[lane];
        found.smallest_J_element = numbering().elements[static_cast<std::size_t>(batch.first + lane)];
      }
    }
    scatter_force<3, 10>(batch, result, force);
    if (!matrix) return found;
    rotation_tangent(own, state, want == Want::tangent && own.exact, result);
    scatter_stiffness<3, 10>(batch, result, *matrix);
    return found;
  }

  SimplexElements<3, 10> standard_;
  std::vector<RotationBatch> batches_;
};

}  // namespace

std::unique_ptr<Elements> make_single_rotation_elements(const Model& model) {
  return std::make_unique<SingleRotationElements>(model);
}

}  // namespace msml::fe
