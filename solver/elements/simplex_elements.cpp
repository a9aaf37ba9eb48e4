// SPDX-License-Identifier: GPL-3.0-or-later
// The element loops: gather, law, force and stiffness, scatter.
#include "solver/elements/simplex_elements.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "solver/elements/history_values.hpp"
#include "solver/elements/simplex_kernels.hpp"

namespace msml::fe {
namespace {

template <class Batch>
std::size_t element_of(const Batch& batch, int lane) {
  return static_cast<std::size_t>(batch.first + lane);
}

}  // namespace

template <int dimension, int nodes, int count>
SimplexElements<dimension, nodes, count>::SimplexElements(const Model& model)
    : numbering_(number(model)),
      pattern_(make_pattern(numbering_.nodes(), numbering_.element_nodes, nodes, numbering_.links)),
      densities_(model),
      thickness_(dimension < 3 ? model.thickness : 1),
      stored_energies_(model.stored_energies) {
  const Rule<dimension> places = rule();
  for (std::size_t q = 0; q < count; ++q) {
    reference_gradients_[q] = Simplex<dimension, nodes>::gradients(places[q].xi);
    barycentric_[q] = Simplex<dimension, nodes>::barycentric(places[q].xi);
  }
  make_batches(model);
  std::vector<std::vector<int>> batch_nodes;
  for (const Batch& batch : batches_) {
    batch_nodes.emplace_back();
    for (int lane = 0; lane < batch.count; ++lane)
      batch_nodes.back().insert(batch_nodes.back().end(), batch.node[lane], batch.node[lane] + nodes);
  }
  colours_ = colour_chunks(batch_nodes, numbering_.nodes());
  remembers_ = remembers(batches_);
  for (const Want want : {Want::tangent, Want::single_tangent, Want::definite_tangent})
    rotated_[static_cast<std::size_t>(want)] = all_rotated(want);
  if constexpr (keeps)
    if (rotated_[static_cast<std::size_t>(Want::single_tangent)])
      kept_ = std::make_unique<KeptHooke<4>>(*this, batches_, colours_);
}

template <int dimension, int nodes, int count>
Rule<dimension> SimplexElements<dimension, nodes, count>::rule() {
  if constexpr (count == stiffness_points<dimension, nodes>) return stiffness_rule<dimension, nodes>();
  return rule_of_size<dimension>(2);
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::make_batches(const Model& model) {
  const int all = static_cast<int>(numbering_.elements.size());
  batches_.reserve(numbering_.elements.size() / lanes + model.regions.size());
  for (int first = 0; first < all;) {
    Batch batch;
    batch.first = first;
    batch.region = numbering_.region_of[static_cast<std::size_t>(first)];
    while (batch.count < lanes && first + batch.count < all &&
           numbering_.region_of[static_cast<std::size_t>(first + batch.count)] == batch.region)
      ++batch.count;
    first += batch.count;
    batches_.push_back(batch);
  }
  block_positions_.resize(batches_.size() * lanes);
  tbb::parallel_for(std::size_t(0), batches_.size(),
                    [&](std::size_t b) { fill(batches_[b], &block_positions_[b * lanes], model); });
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::fill(Batch& batch, typename Batch::Positions* position,
                                                    const Model& model) const {
  const Rule<dimension> places = rule();
  std::vector<std::vector<Vec3>> points(count);
  for (int lane = 0; lane < lanes; ++lane) {
    const std::size_t e = static_cast<std::size_t>(batch.first + std::min(lane, batch.count - 1));
    int ids[nodes];
    for (int a = 0; a < nodes; ++a) {
      batch.node[lane][a] = numbering_.element_nodes[e * nodes + static_cast<std::size_t>(a)];
      ids[a] = numbering_.node_of[static_cast<std::size_t>(batch.node[lane][a])];
    }
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b)
        position[lane][a * nodes + b] = pattern_->find(batch.node[lane][a], batch.node[lane][b]);
    const bool same = straight<dimension, nodes>(positions(), ids);
    batch.straight = batch.straight && same;
    Jacobian<dimension> J, inverse;
    for (std::size_t q = 0; q < count; ++q) {
      if (q == 0 || !same) {
        J = jacobian<dimension, nodes>(positions(), ids, places[q].xi);
        inverse = J.inverse();
      }
      for (int k = 0; k < dimension * dimension; ++k)
        batch.points[q].inverse[k][lane] = inverse(k / dimension, k % dimension);
      batch.points[q].weight[lane] = lane < batch.count ? places[q].weight * J.determinant() * thickness_ : 0.0;
      if (lane < batch.count) points[q].push_back(place<dimension, nodes>(positions(), ids, places[q].xi));
    }
  }
  const Region& region = model.regions[static_cast<std::size_t>(batch.region)];
  const auto first = numbering_.elements.begin() + batch.first;
  const std::vector<int> elements(first, first + batch.count);
  batch.laws = laws_of(model, region, elements, points);
  batch.law = batch.laws.only();
  batch.position = position;
  if (!region.prony.g.empty())
    batch.history = PronyHistory(series_of(region, elements, points), count, batch.laws.laws.front()->small_strain());
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::shape_gradients(const Batch& batch, int q, ShapeGradients& g) const {
  const Lanes* inverse = batch.inverse(q);
  for (int a = 0; a < nodes; ++a) {
    const auto& r = reference_gradients_[static_cast<std::size_t>(q)][static_cast<std::size_t>(a)];
    for (int k = 0; k < dimension; ++k) {
      g.g[a][k] = r[0] * inverse[k];
      for (int d = 1; d < dimension; ++d) g.g[a][k] += r[static_cast<std::size_t>(d)] * inverse[dimension * d + k];
    }
  }
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::set_gradients(const Batch& batch, const Vector& u, Gradients* H) const {
  const auto moved = slopes(gather_nodes<dimension, nodes>(batch, u));
  for (std::size_t q = 0; q < count; ++q) {
    displacement_gradient<dimension, nodes>(moved, batch.inverse(static_cast<int>(q)), barycentric_[q], H[q]);
    if (dimension == 2) batch.laws.complete(q, H[q]);
  }
}

/// Asks for what add_strips reads of a batch: the processor does not guess the gaps between batches.
template <class Batch>
void fetch(const Batch& batch, bool positions) {
  const auto lines = [](const void* from, std::size_t bytes) {
    for (std::size_t k = 0; k < bytes; k += 64) __builtin_prefetch(static_cast<const char*>(from) + k);
  };
  lines(&batch, sizeof batch.node + 32);
  if (positions) lines(batch.position, lanes * sizeof *batch.position);
  lines(batch.points, batch.straight ? sizeof batch.points[0] : sizeof batch.points);
}

/// Calls evaluate(laws, gradients, responses) for runs of batches with one law, or for a batch with several. `count`
/// points a batch.
template <int count, class Batch, class Response, class Evaluate>
void by_law(const Batch* batches, int size, const Gradients* H, Response* responses, const Evaluate& evaluate) {
  for (int b = 0, next = 1; b < size; b = next++) {
    while (next < size && batches[b].law != nullptr && batches[next].law == batches[b].law) ++next;
    const auto points = static_cast<std::size_t>((next - b) * count);
    evaluate(batches[b].laws, std::span(H + b * count, points), std::span(responses + b * count, points));
  }
}

template <int dimension, int nodes, int count>
template <class Response, class Evaluate, class Add>
Assembled SimplexElements<dimension, nodes, count>::add_strips(const Vector& u, bool positions,
                                                               const Evaluate& evaluate, const Add& add) const {
  return add_chunks(colours_, [&](const Chunk& chunk) {
    Notes notes;
    Gradients H[strip_points];
    Response response[strip_points];
    for (int first = chunk.first; first < chunk.last; first += strip_batches) {
      const Batch* batch = &batches_[static_cast<std::size_t>(first)];
      const int size = std::min(strip_batches, chunk.last - first);
      for (int b = 0; b < size; ++b) set_gradients(batch[b], u, H + b * count);
      by_law<count>(batch, size, H, response, evaluate);
      for (int b = 0; b < size; ++b) {
        if (first + b + strip_batches < chunk.last) fetch(batch[b + strip_batches], positions);
        add(batch[b], H + b * count, response + b * count, notes);
      }
    }
    return notes.tell(numbering_.elements);
  });
}

template <int dimension, int nodes, int count>
template <class Response>
void SimplexElements<dimension, nodes, count>::add_force(const Batch& batch, const Gradients* H,
                                                         const Response* response, Vector& force, Notes& notes) const {
  PointWork<dimension> work[count];
  for (int q = 0; q < count; ++q) {
    const Lanes w = batch.points[q].weight;
    work[q] = work_at<dimension>(response[q].P, w, batch.inverse(q));
    notes.add(w * response[q].energy, volume_ratio(H[q]), batch.first);
  }
  SimplexResult<dimension, nodes> result;
  set_forces(work, barycentric_, result);
  scatter_force(batch, result, force);
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::add_tangent(const Batch& batch, const Response* response,
                                                           BlockMatrix& matrix) const {
  SimplexResult<dimension, nodes> result;
  std::fill_n(&result.block[0][0], nodes * (nodes + 1) / 2 * dimension * dimension, Lanes{});
  for (int q = 0; q < count; ++q) {
    ShapeGradients g;
    shape_gradients(batch, q, g);
    add_stiffness<dimension, nodes>(response[q].tangent, batch.points[q].weight, g, result);
  }
  scatter_stiffness(batch, result, matrix);
}

template <int dimension, int nodes, int count>
bool SimplexElements<dimension, nodes, count>::all_rotated(Want want) const {
  const bool rows = dimension == 3 && nodes == 4 && RotatedRows::serves(numbering_.elements.size());
  return (rows || keeps) && !remembers_ && std::all_of(batches_.begin(), batches_.end(), [&](const Batch& batch) {
           return batch.laws.laws.front()->evaluate_rotated(want, {}, {});
         });
}

template <int dimension, int nodes, int count>
template <class Keep>
Assembled SimplexElements<dimension, nodes, count>::add_rotated(const Vector& u, Want want, Vector& force,
                                                                const Keep& keep) const {
  const auto evaluate = [&](const BatchLaws& laws, auto gradients, auto responses) {
    laws.laws.front()->evaluate_rotated(want, gradients, responses);
  };
  const auto add = [&](const Batch& batch, const Gradients* H, const RotatedResponse* at, Notes& notes) {
    add_force(batch, H, at, force, notes);
    keep(batch, at);
  };
  return add_strips<RotatedResponse>(u, false, evaluate, add);
}

template <int dimension, int nodes, int count>
Assembled SimplexElements<dimension, nodes, count>::add_by_rows(const Vector& u, Want want, Vector& force,
                                                                BlockMatrix& matrix) const {
  if (!rows_) rows_.emplace(pattern_, positions_of_blocks(batches_));
  const Assembled found = add_rotated(u, want, force, [&](const Batch& batch, const RotatedResponse* at) {
    ShapeGradients g;
    shape_gradients(batch, 0, g);
    if constexpr (dimension == 3 && nodes == 4)
      rows_->set(batch.first, batch.count, at->R, batch.points[0].weight * at->mu, at->lambda / at->mu, g.g);
  });
  rows_->sum(matrix);
  return found;
}

template <int dimension, int nodes, int count>
Assembled SimplexElements<dimension, nodes, count>::add_kept(const Vector& u, Vector& force) const {
  kept_->begin(u);
  return add_rotated(u, Want::single_tangent, force, [&](const Batch& batch, const RotatedResponse* at) {
    if constexpr (keeps)
      for (std::size_t q = 0; q < count; ++q) {
        HookePoint point{.inverse = {}, .weight = batch.points[q].weight * at[q].mu, .ratio = at[q].lambda / at[q].mu};
        std::copy_n(batch.inverse(static_cast<int>(q)), 9, point.inverse);
        kept_->at(static_cast<std::size_t>(&batch - batches_.data()))[q] = point.turned(at[q].R);
      }
  });
}

template <int dimension, int nodes, int count>
Assembled SimplexElements<dimension, nodes, count>::add_internal(const Vector& u, Want want, Vector& force,
                                                                 BlockMatrix* matrix) const {
  matrices_ += matrix != nullptr;
  if (kept_ && want == Want::single_tangent && !matrix) return add_kept(u, force);
  if (nodes == 4 && matrix && matrices_ > matrices_before_rows && rotated_[static_cast<std::size_t>(want)])
    return add_by_rows(u, want, force, *matrix);
  if (matrix) matrix->set_zero();
  const auto evaluate = [&](const BatchLaws& laws, auto gradients, auto responses) {
    laws.evaluate(want, gradients, responses);
  };
  const auto add = [&](const Batch& batch, const Gradients* H, Response* response, Notes& notes) {
    if (matrix) fetch_blocks(batch, *matrix);
    if (remembers_ && !batch.history.empty()) batch.history.apply(want, {H, count}, {response, count});
    add_force(batch, H, response, force, notes);
    if (matrix) add_tangent(batch, response, *matrix);
  };
  return add_strips<Response>(u, matrix != nullptr, evaluate, add);
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::add_mass(bool lumped, ScalarMatrix& mass) const {
  const auto add = [&](const Batch& batch) {
    for (int lane = 0; lane < batch.count; ++lane) {
      int ids[nodes];
      for (int a = 0; a < nodes; ++a) ids[a] = numbering_.node_of[static_cast<std::size_t>(batch.node[lane][a])];
      const int cell = numbering_.elements[static_cast<std::size_t>(batch.first + lane)];
      const ElementMass<nodes> M =
          densities_.mass<dimension, nodes>(positions(), ids, batch.region, cell, lumped, thickness_);
      for (int k = 0; k < nodes * nodes; ++k)
        mass.values[static_cast<std::size_t>(batch.position[lane][k])] += M(k / nodes, k % nodes);
    }
  };
  for_batches(colours_, [&](std::size_t b) { add(batches_[b]); });
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::visit_points(const Vector& u, const PointsVisitor& visit) const {
  const Rule<dimension> places = rule();
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    const Batch& batch = batches_[b];
    Gradients H[count];
    set_gradients(batch, u, H);
    ElementPoints found[lanes] = {};
    for (int q = 0; q < count; ++q) {
      for (int lane = 0; lane < batch.count; ++lane) {
        ElementPoints& out = found[lane];
        int ids[nodes];
        for (int a = 0; a < nodes; ++a) ids[a] = numbering_.node_of[static_cast<std::size_t>(batch.node[lane][a])];
        out.count = q + 1;
        out.place[q] = place<dimension, nodes>(positions(), ids, places[static_cast<std::size_t>(q)].xi);
        out.weight[q] = batch.points[q].weight[lane];
        for (int k = 0; k < 9; ++k) out.gradient.c[k][q] = H[q].c[k][lane];
      }
    }
    for (int lane = 0; lane < batch.count; ++lane) visit(static_cast<std::size_t>(batch.first + lane), found[lane]);
  });
}

template <int dimension, int nodes, int count>
std::size_t SimplexElements<dimension, nodes, count>::bytes() const {
  std::size_t sum = numbering_.bytes() + batches_.size() * sizeof(Batch) +
                    block_positions_.size() * sizeof block_positions_[0] + (rows_ ? rows_->bytes() : 0) +
                    (kept_ ? kept_->bytes() : 0);
  for (const Batch& batch : batches_) sum += batch.laws.bytes() + batch.history.bytes();
  return sum;
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::begin_step(double dt) {
  if (!remembers_) return;
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    if (!batches_[b].history.empty()) batches_[b].history.begin_step(dt);
  });
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::end_step(const Vector& u) {
  if (!remembers_) return;
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    if (!batches_[b].history.empty()) end_step(batches_[b], u);
  });
}

template <int dimension, int nodes, int count>
void SimplexElements<dimension, nodes, count>::end_step(Batch& batch, const Vector& u) const {
  Gradients H[count];
  Response response[count];
  set_gradients(batch, u, H);
  batch.laws.evaluate(stored_energies_ ? Want::tangent : Want::stress, {H, count}, {response, count});
  batch.history.end_step({H, count}, {response, count}, stored_energies_);
  if (!stored_energies_) return;
  batch.history.apply(Want::stress, {H, count}, {response, count});
  Lanes weights[count];
  for (int q = 0; q < count; ++q) weights[q] = batch.points[q].weight;
  batch.stored_beside = fe::stored_beside(batch.history, response, weights, batch.count);
}

template <int dimension, int nodes, int count>
double SimplexElements<dimension, nodes, count>::stored_beside() const {
  if (!remembers_) return 0;
  double sum = 0;
  for (const Batch& batch : batches_) sum += batch.stored_beside;
  return sum;
}

template <int dimension, int nodes, int count>
std::shared_ptr<const std::vector<double>> SimplexElements<dimension, nodes, count>::history_energy() const {
  if (!stored_energies_ || !remembers_) return nullptr;
  return history_energies(batches_, numbering_.elements.size(), count, element_of<Batch>);
}

template <int dimension, int nodes, int count>
std::shared_ptr<const std::vector<double>> SimplexElements<dimension, nodes, count>::history_stress() const {
  if (!remembers_) return nullptr;
  return history_stresses(batches_, numbering_.elements.size(), count, element_of<Batch>);
}

template class SimplexElements<1, 2>;
template class SimplexElements<1, 3>;
template class SimplexElements<2, 3>;
template class SimplexElements<2, 6>;
template class SimplexElements<3, 4>;
template class SimplexElements<3, 10>;
template class SimplexElements<3, 10, 8>;

}  // namespace msml::fe
