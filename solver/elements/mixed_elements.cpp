// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over elements with a pressure of their own.
#include "solver/elements/mixed_elements.hpp"

#include <tbb/parallel_for.h>

#include "solver/elements/element_sums.hpp"
#include "solver/elements/history_values.hpp"

namespace msml::fe {
namespace {

constexpr int body = MixedBatch<4>::body, corners = MixedBatch<4>::corners, nodes = MixedBatch<4>::nodes;

/// Internal forces and the blocks of the tangent.
struct Result {
  Lanes force[body][3];
  Lanes volume[corners];                  ///< of the constraint
  Lanes block[body * (body + 1) / 2][9];  ///< displacement: (a, b), a <= b, at packed(b, a)
  Lanes coupling[body][corners][3];       ///< displacement by pressure
  Lanes pressure[corners][corners];
};

template <class Batch>
std::size_t element_of(const Batch& batch, int lane) {
  return static_cast<std::size_t>(batch.first + lane);
}

/// The ten nodes of each element and the additional nodes of its corners.
std::vector<int> with_pressure_nodes(const Numbering& numbering) {
  std::vector<int> list;
  auto extra = numbering.pressure_nodes.begin();
  for (auto node = numbering.element_nodes.begin(); node != numbering.element_nodes.end(); node += body) {
    list.insert(list.end(), node, node + body);
    list.insert(list.end(), extra, extra + corners);
    extra += corners;
  }
  return list;
}

template <class Batch>
void scatter_force(const Batch& batch, const Result& result, Vector& force) {
  for (int lane = 0; lane < batch.count; ++lane) {
    for (int a = 0; a < body; ++a)
      for (int i = 0; i < 3; ++i) force[3 * batch.node[lane][a] + i] += result.force[a][i][lane];
    for (int c = 0; c < corners; ++c) force[3 * batch.node[lane][body + c]] += result.volume[c][lane];
  }
}

template <class Batch>
void scatter_stiffness(const Batch& batch, const Result& result, BlockMatrix& matrix) {
  for (int lane = 0; lane < batch.count; ++lane) {
    const auto at = [&](int a, int b) {
      return matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][a * nodes + b]);
    };
    for (int b = 0; b < body; ++b)
      for (int a = 0; a <= b; ++a) {
        const Lanes* block = result.block[packed(b, a)];
        double *upper = at(a, b), *lower = at(b, a);
        for (int i = 0; i < 9; ++i) upper[i] += block[i][lane];
        if (a == b) continue;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) lower[3 * j + i] += block[3 * i + j][lane];
      }
    for (int c = 0; c < corners; ++c) {
      for (int a = 0; a < body; ++a) {
        double *right = at(a, body + c), *left = at(body + c, a);
        for (int i = 0; i < 3; ++i) {
          right[3 * i] += result.coupling[a][c][i][lane];
          left[i] += result.coupling[a][c][i][lane];
        }
      }
      for (int d = 0; d < corners; ++d) *at(body + c, body + d) += result.pressure[c][d][lane];
    }
  }
}

}  // namespace

/// What a quadrature point sees.
template <int points>
struct MixedElements<points>::Values {
  Lanes g[body][3];  ///< dN_a/dX
  Gradients H;
  Lanes p;
};

template <int points>
Rule<3> MixedElements<points>::rule() {
  if constexpr (points == 4) return four_point_rule();
  return rule_of_size<3>(2);
}

template <int points>
MixedElements<points>::MixedElements(const Model& model)
    : numbering_(number(model)),
      pressures_(model, numbering_),
      stored_energies_(model.stored_energies),
      densities_(model) {
  const Rule<3> quadrature = rule();
  for (std::size_t q = 0; q < quadrature.size(); ++q) {
    reference_gradients_[q] = Tetrahedron<body>::gradients(quadrature[q].xi);
    barycentric_[q] = Tetrahedron<body>::barycentric(quadrature[q].xi);
  }
  for (const int node : numbering_.element_nodes) cells_.push_back(numbering_.node_of[static_cast<std::size_t>(node)]);
  const std::vector<int> element_nodes = with_pressure_nodes(numbering_);
  pattern_ = make_pattern(numbering_.nodes(), element_nodes, nodes, numbering_.links);
  make_batches(model, element_nodes);
  set_scale(model);
}

template <int points>
void MixedElements<points>::make_batches(const Model& model, const std::vector<int>& element_nodes) {
  const int all = static_cast<int>(numbering_.elements.size());
  std::vector<std::vector<int>> batch_nodes;
  for (int first = 0; first < all;) {
    Batch batch;
    batch.first = first;
    batch.region = numbering_.region_of[static_cast<std::size_t>(first)];
    while (batch.count < lanes && first + batch.count < all &&
           numbering_.region_of[static_cast<std::size_t>(first + batch.count)] == batch.region)
      ++batch.count;
    batch_nodes.emplace_back(element_nodes.begin() + nodes * first,
                             element_nodes.begin() + nodes * (first + batch.count));
    first += batch.count;
    batches_.push_back(batch);
  }
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) { fill(batches_[b], model, element_nodes); });
  colours_ = colour_chunks(batch_nodes, numbering_.nodes());
}

template <int points>
void MixedElements<points>::fill(Batch& batch, const Model& model, const std::vector<int>& element_nodes) const {
  const Rule<3> quadrature = rule();
  std::vector<std::vector<Vec3>> places(quadrature.size());
  for (int lane = 0; lane < lanes; ++lane) {
    const int e = batch.first + std::min(lane, batch.count - 1);
    std::copy_n(element_nodes.begin() + nodes * e, nodes, batch.node[lane]);
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b)
        batch.position[lane][a * nodes + b] = pattern_->find(batch.node[lane][a], batch.node[lane][b]);
    const int* ids = cells_.data() + body * e;
    for (std::size_t q = 0; q < quadrature.size(); ++q) {
      if (lane < batch.count) places[q].push_back(place<3, body>(positions(), ids, quadrature[q].xi));
      const Mat3 J = jacobian<3, body>(positions(), ids, quadrature[q].xi), inverse = J.inverse();
      for (int k = 0; k < 9; ++k) batch.point[q].inverse.c[k][lane] = inverse(k / 3, k % 3);
      batch.point[q].weight[lane] = lane < batch.count ? quadrature[q].weight * J.determinant() : 0.0;
    }
  }
  const Region& region = model.regions[static_cast<std::size_t>(batch.region)];
  const std::span<const int> elements(numbering_.elements.data() + batch.first, static_cast<std::size_t>(batch.count));
  batch.law = BatchSplit(region, elements, places);
  if (!region.prony.g.empty())
    batch.history = PronyHistory(series_of(region, elements, places), points, region.law->small_strain());
}

// A shear modulus over an element's size: pressures then have the size of displacements, and the constraint that of
// forces.
template <int points>
void MixedElements<points>::set_scale(const Model& model) {
  double volume = 0, modulus = 0;
  for (const Batch& batch : batches_)
    for (const typename Batch::Point& point : batch.point)
      for (int lane = 0; lane < batch.count; ++lane) {
        volume += point.weight[lane];
        modulus += point.weight[lane] * model.regions[static_cast<std::size_t>(batch.region)].law->shear_modulus();
      }
  const double size = std::cbrt(volume / static_cast<double>(numbering_.elements.size()));
  numbering_.pressure_scale = modulus / volume / size;
}

template <int points>
typename MixedElements<points>::Values MixedElements<points>::values(const Batch& batch, int q, const Vector& u) const {
  const Tensor<Lanes>& inverse = batch.point[q].inverse;
  Values at{};
  for (int a = 0; a < body; ++a) {
    const auto& r = reference_gradients_[static_cast<std::size_t>(q)][static_cast<std::size_t>(a)];
    for (int k = 0; k < 3; ++k) at.g[a][k] = r[0] * inverse(0, k) + r[1] * inverse(1, k) + r[2] * inverse(2, k);
    for (int i = 0; i < 3; ++i) {
      const Lanes value = gather(batch, a, u.data() + i);
      for (int k = 0; k < 3; ++k) at.H(i, k) += value * at.g[a][k];
    }
  }
  for (int c = 0; c < corners; ++c)
    at.p += barycentric_[static_cast<std::size_t>(q)][static_cast<std::size_t>(c)] * numbering_.pressure_scale *
            gather(batch, body + c, u.data());
  return at;
}

template <int points>
Assembled MixedElements<points>::add_batch(const Batch& batch, const Vector& u, Want want, Vector& force,
                                           BlockMatrix* matrix) const {
  constexpr int count = points;
  Values at[count];
  Gradients H[count];
  Response rest[count], volume[count];
  for (int q = 0; q < count; ++q) {
    at[q] = values(batch, q, u);
    H[q] = at[q].H;
  }
  const bool definite = want == Want::definite_tangent;
  batch.law.evaluate_rest(want, {H, count}, {rest, count});
  batch.law.evaluate_constraint(definite ? Want::stress : want, {H, count}, {volume, count});

  for (int q = 0; q < count; ++q) {
    const Lanes p = at[q].p;
    Response& sum = rest[q];
    sum.energy += p * volume[q].energy - 0.5 * p * p * batch.law.compliance(static_cast<std::size_t>(q));
    for (int k = 0; k < 9; ++k) sum.P.c[k] += p * volume[q].P.c[k];
    for (int k = 0; k < 45 && matrix && !definite; ++k) sum.tangent[k] += p * volume[q].tangent[k];
  }
  const bool remembers = !batch.history.empty();
  if (remembers) batch.history.apply(want, {H, count}, {rest, count});

  Assembled found;
  Result result{};
  for (int q = 0; q < count; ++q) {
    const auto point = static_cast<std::size_t>(q);
    const Lanes w = batch.point[q].weight;
    const Lanes& compliance = batch.law.compliance(point);
    add_force<3, body>(rest[q].P, w, at[q].g, result.force);
    Lanes share[corners];
    for (int c = 0; c < corners; ++c) {
      share[c] = barycentric_[point][static_cast<std::size_t>(c)] * numbering_.pressure_scale * w;
      if (remembers) share[c] *= batch.history.factor(point);
      result.volume[c] += share[c] * (volume[q].energy - at[q].p * compliance);
    }
    note(w * rest[q].energy, volume_ratio(H[q]), batch.count, numbering_.elements.data() + batch.first, found);
    if (!matrix) continue;
    add_stiffness<3, body>(rest[q].tangent, w, at[q].g, result.block);
    for (int c = 0; c < corners; ++c) {
      for (int a = 0; a < body; ++a)
        for (int i = 0; i < 3; ++i) result.coupling[a][c][i] += share[c] * inner<3>(volume[q].P.c + 3 * i, at[q].g[a]);
      for (int d = 0; d < corners; ++d)
        result.pressure[c][d] -=
            share[c] * compliance * numbering_.pressure_scale * barycentric_[point][static_cast<std::size_t>(d)];
    }
  }
  scatter_force(batch, result, force);
  if (matrix) scatter_stiffness(batch, result, *matrix);
  return found;
}

template <int points>
Assembled MixedElements<points>::add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const {
  if (matrix) matrix->set_zero();
  return add_by_colour(colours_, [&](std::size_t b) {
    if (matrix) fetch_blocks(batches_[b], *matrix);
    return add_batch(batches_[b], u, want, force, matrix);
  });
}

template <int points>
void MixedElements<points>::begin_step(double dt) {
  pressures_.begin_step(dt);
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    if (!batches_[b].history.empty()) batches_[b].history.begin_step(dt);
  });
}

template <int points>
void MixedElements<points>::end_step(const Vector& u) {
  pressures_.end_step(u);
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    if (!batches_[b].history.empty()) end_step(batches_[b], u);
  });
}

template <int points>
void MixedElements<points>::end_step(Batch& batch, const Vector& u) const {
  constexpr int count = points;
  Gradients H[count];
  Response rest[count], volume[count];
  Lanes p[count], weights[count];
  for (int q = 0; q < count; ++q) {
    const Values at = values(batch, q, u);
    H[q] = at.H;
    p[q] = at.p;
    weights[q] = batch.point[q].weight;
  }
  const Want want = stored_energies_ ? Want::tangent : Want::stress;
  batch.law.evaluate_rest(want, {H, count}, {rest, count});
  batch.law.evaluate_constraint(want, {H, count}, {volume, count});
  for (std::size_t q = 0; q < count; ++q)
    rest[q] = joined(rest[q], volume[q], p[q], batch.law.modulus(q), batch.law.largest_modulus(q), stored_energies_);
  batch.history.end_step({H, count}, {rest, count}, stored_energies_);
  if (!stored_energies_) return;
  for (std::size_t q = 0; q < count; ++q) rest[q].energy += p[q] * (volume[q].energy - p[q] * batch.law.compliance(q));
  batch.history.apply(Want::stress, {H, count}, {rest, count});
  batch.stored_beside = fe::stored_beside(batch.history, rest, weights, batch.count);
}

template <int points>
double MixedElements<points>::stored_beside() const {
  double sum = 0;
  for (const Batch& batch : batches_) sum += batch.stored_beside;
  return sum;
}

template <int points>
std::shared_ptr<const std::vector<double>> MixedElements<points>::history_stress() const {
  return history_stresses(batches_, numbering_.elements.size(), points, element_of<Batch>);
}

template <int points>
std::shared_ptr<const std::vector<double>> MixedElements<points>::history_energy() const {
  if (!stored_energies_) return nullptr;
  return history_energies(batches_, numbering_.elements.size(), points, element_of<Batch>);
}

template <int points>
void MixedElements<points>::add_mass(bool lumped, ScalarMatrix& mass) const {
  for (const Batch& batch : batches_)
    for (int lane = 0; lane < batch.count; ++lane) {
      const int* ids = cells_.data() + body * (batch.first + lane);
      const int cell = numbering_.elements[static_cast<std::size_t>(batch.first + lane)];
      const ElementMass<body> M = densities_.mass<3, body>(positions(), ids, batch.region, cell, lumped);
      for (int a = 0; a < body; ++a)
        for (int b = 0; b < body; ++b)
          mass.values[static_cast<std::size_t>(batch.position[lane][a * nodes + b])] += M(a, b);
    }
}

template <int points>
std::size_t MixedElements<points>::bytes() const {
  std::size_t sum =
      numbering_.bytes() + pressures_.bytes() + batches_.size() * sizeof(Batch) + cells_.size() * sizeof(int);
  for (const Batch& batch : batches_) sum += batch.law.bytes() + batch.history.bytes();
  return sum;
}

template <int points>
void MixedElements<points>::visit_points(const Vector& u, const PointsVisitor& visit) const {
  const Rule<3> quadrature = rule();
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    const Batch& batch = batches_[b];
    ElementPoints found[lanes] = {};
    for (int q = 0; q < points; ++q) {
      const Values at = values(batch, q, u);
      for (int lane = 0; lane < batch.count; ++lane) {
        ElementPoints& out = found[lane];
        const int* ids = cells_.data() + body * (batch.first + lane);
        out.count = q + 1;
        out.place[q] = place<3, body>(positions(), ids, quadrature[static_cast<std::size_t>(q)].xi);
        out.weight[q] = batch.point[q].weight[lane];
        out.volume_stress[q] = at.p[lane];
        for (int k = 0; k < 9; ++k) out.gradient.c[k][q] = at.H.c[k][lane];
      }
    }
    for (int lane = 0; lane < batch.count; ++lane) visit(static_cast<std::size_t>(batch.first + lane), found[lane]);
  });
}

template class MixedElements<4>;
template class MixedElements<8>;

}  // namespace msml::fe
