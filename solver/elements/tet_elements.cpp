// SPDX-License-Identifier: GPL-3.0-or-later
// The element loops: gather, law, force and stiffness, scatter.
#include "solver/elements/tet_elements.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstring>

#include "solver/elements/mass.hpp"

namespace msml::fe {
namespace {

constexpr int packed(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }

/// values[3 n] for the nodes a of eight elements.
template <int nodes>
Lanes gather(const TetBatch<nodes>& batch, int a, const double* values) {
  alignas(Lanes) double out[lanes];
  for (int lane = 0; lane < lanes; ++lane) out[lane] = values[3 * batch.node[lane][a]];
  Lanes result;
  std::memcpy(&result, out, sizeof result);
  return result;
}

/// force_a += w P g_a.
template <int nodes>
void add_force(const Tensor<Lanes>& P, Lanes w, const TetGradients<nodes>& gradients, TetResult<nodes>& result) {
  for (int a = 0; a < nodes; ++a) {
    const Lanes* g = gradients.g[a];
    for (int i = 0; i < 3; ++i) result.force[a][i] += w * (P(i, 0) * g[0] + P(i, 1) * g[1] + P(i, 2) * g[2]);
  }
}

/// block_ab(i, j) += w sum_kl g_a,k A_(ik)(jl) g_b,l.
template <int nodes>
void add_stiffness(const Lanes* A, Lanes w, const TetGradients<nodes>& gradients, TetResult<nodes>& result) {
  for (int b = 0; b < nodes; ++b) {
    const Lanes g0 = w * gradients.g[b][0], g1 = w * gradients.g[b][1], g2 = w * gradients.g[b][2];
    Lanes half[9][3];  // A contracted with g_b: (ik) x j
    for (int I = 0; I < 9; ++I)
      for (int j = 0; j < 3; ++j)
        half[I][j] = A[packed(I, 3 * j)] * g0 + A[packed(I, 3 * j + 1)] * g1 + A[packed(I, 3 * j + 2)] * g2;
    for (int a = 0; a <= b; ++a) {
      const Lanes* g = gradients.g[a];
      Lanes* block = result.block[packed(b, a)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          block[3 * i + j] += g[0] * half[3 * i][j] + g[1] * half[3 * i + 1][j] + g[2] * half[3 * i + 2][j];
    }
  }
}

template <int nodes>
void scatter_force(const TetBatch<nodes>& batch, const TetResult<nodes>& result, Vector& force) {
  for (int lane = 0; lane < batch.count; ++lane)
    for (int a = 0; a < nodes; ++a) {
      double* f = force.data() + 3 * batch.node[lane][a];
      for (int i = 0; i < 3; ++i) f[i] += result.force[a][i][lane];
    }
}

template <int nodes>
void scatter_stiffness(const TetBatch<nodes>& batch, const TetResult<nodes>& result, BlockMatrix& matrix) {
  for (int lane = 0; lane < batch.count; ++lane)
    for (int b = 0; b < nodes; ++b)
      for (int a = 0; a <= b; ++a) {
        const Lanes* block = result.block[packed(b, a)];
        double* upper = matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][a * nodes + b]);
        double* lower = matrix.values.data() + 9 * static_cast<std::size_t>(batch.position[lane][b * nodes + a]);
        for (int i = 0; i < 9; ++i) upper[i] += block[i][lane];
        if (a == b) continue;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) lower[3 * j + i] += block[3 * i + j][lane];
      }
}

void merge(Assembled& sum, const Assembled& part) {
  sum.energy += part.energy;
  sum.finite = sum.finite && part.finite;
  if (part.smallest_J < sum.smallest_J) {
    sum.smallest_J = part.smallest_J;
    sum.smallest_J_element = part.smallest_J_element;
  }
}

}  // namespace

template <int nodes>
TetElements<nodes>::TetElements(const Model& model)
    : numbering_(number(model)),
      pattern_(make_pattern(numbering_.nodes(), numbering_.element_nodes, nodes)),
      points_(model.mesh->points) {
  const Rule<3> rule = stiffness_rule<nodes>();
  for (std::size_t q = 0; q < rule.size(); ++q) reference_gradients_[q] = Tetrahedron<nodes>::gradients(rule[q].xi);
  for (const Region& region : model.regions) {
    laws_.push_back(region.law);
    densities_.push_back(region.density);
  }
  make_batches();
  std::vector<std::vector<int>> batch_nodes;
  for (const Batch& batch : batches_) {
    batch_nodes.emplace_back();
    for (int lane = 0; lane < batch.count; ++lane)
      batch_nodes.back().insert(batch_nodes.back().end(), batch.node[lane], batch.node[lane] + nodes);
  }
  colours_ = colour_chunks(batch_nodes, numbering_.nodes());
}

template <int nodes>
void TetElements<nodes>::make_batches() {
  const int count = static_cast<int>(numbering_.elements.size());
  for (int first = 0; first < count;) {
    Batch batch;
    batch.first = first;
    batch.region = numbering_.region_of[static_cast<std::size_t>(first)];
    while (batch.count < lanes && first + batch.count < count &&
           numbering_.region_of[static_cast<std::size_t>(first + batch.count)] == batch.region)
      ++batch.count;
    first += batch.count;
    batches_.push_back(batch);
  }
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) { fill(batches_[b], points_); });
}

template <int nodes>
void TetElements<nodes>::fill(Batch& batch, const Points& points) const {
  const Rule<3> rule = stiffness_rule<nodes>();
  for (int lane = 0; lane < lanes; ++lane) {
    const std::size_t e = static_cast<std::size_t>(batch.first + std::min(lane, batch.count - 1));
    int ids[nodes];
    for (int a = 0; a < nodes; ++a) {
      batch.node[lane][a] = numbering_.element_nodes[e * nodes + static_cast<std::size_t>(a)];
      ids[a] = numbering_.node_of[static_cast<std::size_t>(batch.node[lane][a])];
    }
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b)
        batch.position[lane][a * nodes + b] = pattern_->find(batch.node[lane][a], batch.node[lane][b]);
    for (int q = 0; q < stiffness_points<nodes>; ++q) {
      const auto& point = rule[static_cast<std::size_t>(q)];
      const Mat3 J = jacobian<nodes>(points, ids, point.xi);
      const Mat3 inverse = J.inverse();
      for (int k = 0; k < 9; ++k) batch.points[q].inverse.c[k][lane] = inverse(k / 3, k % 3);
      batch.points[q].weight[lane] = lane < batch.count ? point.weight * J.determinant() : 0.0;
    }
  }
}

template <int nodes>
Gradients TetElements<nodes>::gradient(const Batch& batch, int q, const Vector& u, TetGradients<nodes>& g) const {
  const Tensor<Lanes>& inverse = batch.points[q].inverse;
  Gradients H{};
  for (int a = 0; a < nodes; ++a) {
    const auto& r = reference_gradients_[static_cast<std::size_t>(q)][static_cast<std::size_t>(a)];
    for (int k = 0; k < 3; ++k) g.g[a][k] = r[0] * inverse(0, k) + r[1] * inverse(1, k) + r[2] * inverse(2, k);
    for (int i = 0; i < 3; ++i) {
      const Lanes value = gather(batch, a, u.data() + i);
      for (int k = 0; k < 3; ++k) H(i, k) += value * g.g[a][k];
    }
  }
  return H;
}

template <int nodes>
Assembled TetElements<nodes>::add_batch(const Batch& batch, const Vector& u, Want want, Vector& force,
                                        BlockMatrix* matrix) const {
  constexpr int count = stiffness_points<nodes>;
  TetGradients<nodes> g[count];
  Gradients H[count];
  Response response[count];
  for (int q = 0; q < count; ++q) H[q] = gradient(batch, q, u, g[q]);
  laws_[static_cast<std::size_t>(batch.region)]->evaluate(want, {H, count}, {response, count});

  Assembled found;
  TetResult<nodes> result{};
  for (int q = 0; q < count; ++q) {
    const Lanes w = batch.points[q].weight;
    add_force<nodes>(response[q].P, w, g[q], result);
    if (matrix) add_stiffness<nodes>(response[q].tangent, w, g[q], result);
    Tensor<Lanes> F = H[q];
    for (int i = 0; i < 3; ++i) F(i, i) += 1.0;
    const Lanes J = determinant(F), energy = w * response[q].energy;
    for (int lane = 0; lane < batch.count; ++lane) {
      found.energy += energy[lane];
      if (!std::isfinite(energy[lane]) || !std::isfinite(J[lane])) found.finite = false;
      if (J[lane] < found.smallest_J) {
        found.smallest_J = J[lane];
        found.smallest_J_element = numbering_.elements[static_cast<std::size_t>(batch.first + lane)];
      }
    }
  }
  scatter_force(batch, result, force);
  if (matrix) scatter_stiffness(batch, result, *matrix);
  return found;
}

template <int nodes>
Assembled TetElements<nodes>::add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const {
  Assembled sum;
  for (const auto& chunks : colours_) {
    std::vector<Assembled> parts(chunks.size());
    tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t c) {
      for (int b = chunks[c].first; b < chunks[c].last; ++b)
        merge(parts[c], add_batch(batches_[static_cast<std::size_t>(b)], u, want, force, matrix));
    });
    for (const Assembled& part : parts) merge(sum, part);
  }
  return sum;
}

template <int nodes>
void TetElements<nodes>::add_mass(bool lumped, ScalarMatrix& mass) const {
  for (const Batch& batch : batches_)
    for (int lane = 0; lane < batch.count; ++lane) {
      int ids[nodes];
      for (int a = 0; a < nodes; ++a) ids[a] = numbering_.node_of[static_cast<std::size_t>(batch.node[lane][a])];
      ElementMass<nodes> M = consistent_mass<nodes>(points_, ids, densities_[static_cast<std::size_t>(batch.region)]);
      if (lumped) M = lumped_mass<nodes>(M);
      for (int k = 0; k < nodes * nodes; ++k)
        mass.values[static_cast<std::size_t>(batch.position[lane][k])] += M(k / nodes, k % nodes);
    }
}

template <int nodes>
std::vector<ElementPoints> TetElements<nodes>::points(const Vector& u) const {
  std::vector<ElementPoints> points(numbering_.elements.size());
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    const Batch& batch = batches_[b];
    TetGradients<nodes> g;
    for (int q = 0; q < stiffness_points<nodes>; ++q) {
      const Gradients H = gradient(batch, q, u, g);
      for (int lane = 0; lane < batch.count; ++lane) {
        ElementPoints& out = points[static_cast<std::size_t>(batch.first + lane)];
        if (q == 0) out = {};
        out.count = q + 1;
        out.weight[q] = batch.points[q].weight[lane];
        for (int k = 0; k < 9; ++k) out.gradient.c[k][q] = H.c[k][lane];
      }
    }
  });
  return points;
}

template class TetElements<4>;
template class TetElements<10>;

std::unique_ptr<Elements> make_elements(const Model& model) {
  const int cell = [&] {
    for (const Region& region : model.regions)
      if (!region.elements.empty()) return region.elements.front();
    return -1;
  }();
  if (model.mesh->kinds[static_cast<std::size_t>(cell)] == CellKind::tet4)
    return std::make_unique<TetElements<4>>(model);
  return std::make_unique<TetElements<10>>(model);
}

}  // namespace msml::fe
