// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over patches of linear tetrahedra.
#include "solver/elements/patch_elements.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "solver/elements/element_sums.hpp"
#include "solver/elements/history_values.hpp"

namespace msml::fe {
namespace {

constexpr int patch_size = 8;
constexpr int most_batches = patch_limit / lanes;
constexpr int most_nodes = patch_limit + 3;  // each element behind a face adds at most one

std::size_t element_of(const PatchBatch& batch, int lane) { return static_cast<std::size_t>(batch.element[lane]); }

/// What the law gives in one batch.
struct Evaluated {
  Gradients H;
  Response rest, volume;
  Lanes J;
};

Gradients gradient(const PatchBatch& batch, const Vector& u) {
  Gradients H{};
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 3; ++i) {
      const Lanes value = gather(batch, a, u.data() + i);
      for (int k = 0; k < 3; ++k) H(i, k) += value * batch.g[a][k];
    }
  return H;
}

double sum(const Lanes& x) {
  double total = 0;
  for (int lane = 0; lane < lanes; ++lane) total += x[lane];
  return total;
}

/// P and tangent of rest + p g, viscoelastic where the batch remembers, take the place of those of rest.
void join(const PatchBatch& batch, double p, Want want, Evaluated& at) {
  for (int k = 0; k < 9; ++k) at.rest.P.c[k] += p * at.volume.P.c[k];
  if (want == Want::tangent || want == Want::single_tangent)
    for (int k = 0; k < 45; ++k) at.rest.tangent[k] += p * at.volume.tangent[k];
  if (!batch.history.empty()) batch.history.apply(want, {&at.H, 1}, {&at.rest, 1});
}

/// Force and stiffness of one batch with the joined law; d += sum V dg/du, node after node of the patch.
void add_batch(const PatchBatch& batch, const Patch& patch, const Evaluated& at, double* d, Vector& force,
               BlockMatrix* matrix) {
  const Response& law = at.rest;
  Lanes pull[4][3] = {}, slope[4][3] = {};
  add_force<3, 4>(law.P, batch.weight, batch.g, pull);
  if (matrix) add_force<3, 4>(at.volume.P, batch.weight, batch.g, slope);
  for (int lane = 0; lane < batch.count; ++lane)
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 3; ++i) {
        force[3 * batch.node[lane][a] + i] += pull[a][i][lane];
        d[3 * batch.local[lane][a] + i] += slope[a][i][lane];
      }
  if (!matrix) return;
  Lanes block[10][9] = {};
  add_stiffness<3, 4>(law.tangent, batch.weight, batch.g, block);
  const std::size_t nodes = patch.nodes.size();
  for (int lane = 0; lane < batch.count; ++lane)
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a <= b; ++a) {
        const auto one = static_cast<std::size_t>(batch.local[lane][a]),
                   two = static_cast<std::size_t>(batch.local[lane][b]);
        double* upper = matrix->values.data() + 9 * static_cast<std::size_t>(patch.positions[one * nodes + two]);
        double* lower = matrix->values.data() + 9 * static_cast<std::size_t>(patch.positions[two * nodes + one]);
        for (int k = 0; k < 9; ++k) upper[k] += block[packed(b, a)][k][lane];
        if (a == b) continue;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) lower[3 * j + i] += block[packed(b, a)][3 * i + j][lane];
      }
}

/// matrix += factor d d^T.
void add_coupling(const Patch& patch, double factor, const double* d, BlockMatrix& matrix) {
  const std::size_t nodes = patch.nodes.size();
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = 0; b < nodes; ++b) {
      double* out = matrix.values.data() + 9 * static_cast<std::size_t>(patch.positions[a * nodes + b]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[3 * i + j] += factor * d[3 * a + i] * d[3 * b + j];
    }
}

}  // namespace

PatchElements::PatchElements(const Model& model)
    : numbering_(number(model)), stored_energies_(model.stored_energies), densities_(model) {
  for (const std::vector<int>& elements : make_patches(numbering_, patch_size)) make_patch(elements, model);
  find_positions();
  std::vector<std::vector<int>> patch_nodes;
  for (const Patch& patch : patches_) patch_nodes.push_back(patch.nodes);
  colours_ = colour_chunks(patch_nodes, numbering_.nodes());
}

void PatchElements::make_patch(const std::vector<int>& elements, const Model& model) {
  Patch patch;
  patch.region = numbering_.region_of[static_cast<std::size_t>(elements.front())];
  patch.first_batch = static_cast<int>(batches_.size());
  for (const int e : elements)
    patch.nodes.insert(patch.nodes.end(), numbering_.element_nodes.begin() + 4 * e,
                       numbering_.element_nodes.begin() + 4 * e + 4);
  std::sort(patch.nodes.begin(), patch.nodes.end());
  patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
  for (std::size_t first = 0; first < elements.size(); first += lanes) {
    PatchBatch batch;
    batch.count = static_cast<int>(std::min<std::size_t>(lanes, elements.size() - first));
    for (int lane = 0; lane < lanes; ++lane)
      batch.element[lane] = elements[first + static_cast<std::size_t>(std::min(lane, batch.count - 1))];
    fill(batch, patch, model);
    patch.volume += sum(batch.weight);
    for (int lane = 0; lane < batch.count; ++lane) patch.modulus += batch.weight[lane] * batch.law.modulus(0)[lane];
    batches_.push_back(batch);
  }
  patch.modulus /= patch.volume;
  patch.batches = static_cast<int>(batches_.size()) - patch.first_batch;
  remember(patch, model.regions[static_cast<std::size_t>(patch.region)]);
  patches_.push_back(patch);
}

void PatchElements::remember(const Patch& patch, const Region& region) {
  if (region.prony.g.empty()) return;
  const std::span<PatchBatch> batches(batches_.data() + patch.first_batch, static_cast<std::size_t>(patch.batches));
  Prony mean = region.prony;
  if (region.prony_at) {
    mean.g.assign(mean.g.size(), 0);
    mean.tau.assign(mean.tau.size(), 0);
    for (const PatchBatch& batch : batches)
      for (int lane = 0; lane < batch.count; ++lane) {
        Vec3 middle = Vec3::Zero();
        const int* ids = numbering_.mesh->cell(batch.cell[lane]);
        for (int a = 0; a < 4; ++a) middle += 0.25 * positions().row(ids[a]).transpose();
        const Prony own = region.prony_at(batch.cell[lane], middle);
        for (std::size_t i = 0; i < mean.g.size(); ++i) {
          mean.g[i] += batch.weight[lane] / patch.volume * own.g[i];
          mean.tau[i] += batch.weight[lane] / patch.volume * own.tau[i];
        }
      }
  }
  for (PatchBatch& batch : batches)
    batch.history = PronyHistory({PronySeries({&mean, 1})}, 1, region.law->small_strain());
}

void PatchElements::fill(PatchBatch& batch, const Patch& patch, const Model& model) {
  const auto reference = Tetrahedron<4>::gradients({0.25, 0.25, 0.25});
  std::vector<Vec3> middles;
  for (int lane = 0; lane < lanes; ++lane) {
    const std::size_t e = static_cast<std::size_t>(batch.element[lane]);
    batch.cell[lane] = numbering_.elements[e];
    for (int a = 0; a < 4; ++a) {
      const int node = batch.node[lane][a] = numbering_.element_nodes[4 * e + static_cast<std::size_t>(a)];
      const auto place = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), node);
      batch.local[lane][a] = static_cast<int>(place - patch.nodes.begin());
    }
    const Mat3 J = jacobian<3, 4>(positions(), model.mesh->cell(batch.cell[lane]), {0.25, 0.25, 0.25}),
               inverse = J.inverse();
    if (lane < batch.count)
      middles.push_back(place<3, 4>(positions(), model.mesh->cell(batch.cell[lane]), {0.25, 0.25, 0.25}));
    batch.weight[lane] = lane < batch.count ? J.determinant() / 6 : 0.0;
    for (int a = 0; a < 4; ++a)
      for (int k = 0; k < 3; ++k)
        batch.g[a][k][lane] =
            Eigen::Map<const Eigen::RowVector3d>(reference[static_cast<std::size_t>(a)].data()) * inverse.col(k);
  }
  batch.law = BatchSplit(model.regions[static_cast<std::size_t>(patch.region)],
                         {batch.cell, static_cast<std::size_t>(batch.count)}, {&middles, 1});
}

void PatchElements::find_positions() {
  std::size_t width = 0;
  for (const Patch& patch : patches_) width = std::max(width, patch.nodes.size());
  std::vector<int> lists;  // of equal length: the last node repeated
  for (const Patch& patch : patches_) {
    lists.insert(lists.end(), patch.nodes.begin(), patch.nodes.end());
    lists.insert(lists.end(), width - patch.nodes.size(), patch.nodes.back());
  }
  pattern_ = make_pattern(numbering_.nodes(), lists, static_cast<int>(width), numbering_.links);
  for (Patch& patch : patches_)
    for (const int a : patch.nodes)
      for (const int b : patch.nodes) patch.positions.push_back(pattern_->find(a, b));
}

Assembled PatchElements::add_patch(const Patch& patch, const Vector& u, Want want, Vector& force,
                                   BlockMatrix* matrix) const {
  Evaluated at[most_batches];
  const PatchBatch* batches = batches_.data() + patch.first_batch;
  const bool definite = want == Want::definite_tangent;
  double gbar = 0;
  for (int b = 0; b < patch.batches; ++b) {
    at[b].H = gradient(batches[b], u);
    batches[b].law.evaluate_rest(want, {&at[b].H, 1}, {&at[b].rest, 1});
    batches[b].law.evaluate_constraint(definite ? Want::stress : want, {&at[b].H, 1}, {&at[b].volume, 1});
    at[b].J = volume_ratio(at[b].H);
    gbar += sum(batches[b].weight * at[b].volume.energy) / patch.volume;
  }
  Assembled found;
  double d[3 * most_nodes] = {};
  for (int b = 0; b < patch.batches; ++b) {
    join(batches[b], patch.modulus * gbar, want, at[b]);
    note(batches[b].weight * at[b].rest.energy, at[b].J, batches[b].count, batches[b].cell, found);
    add_batch(batches[b], patch, at[b], d, force, matrix);
  }
  const double modulus = patch.modulus * (batches->history.empty() ? 1 : batches->history.factor(0)[0]);
  if (matrix) add_coupling(patch, modulus / patch.volume, d, *matrix);
  found.energy += 0.5 * patch.volume * modulus * gbar * gbar;
  found.finite = found.finite && std::isfinite(gbar);
  return found;
}

Assembled PatchElements::add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const {
  if (matrix) matrix->set_zero();
  return add_by_colour(colours_, [&](std::size_t p) { return add_patch(patches_[p], u, want, force, matrix); });
}

void PatchElements::begin_step(double dt) {
  tbb::parallel_for(std::size_t(0), batches_.size(), [&](std::size_t b) {
    if (!batches_[b].history.empty()) batches_[b].history.begin_step(dt);
  });
}

void PatchElements::end_step(const Vector& u) {
  tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t p) {
    if (!batches_[static_cast<std::size_t>(patches_[p].first_batch)].history.empty()) end_step(patches_[p], u);
  });
}

void PatchElements::end_step(Patch& patch, const Vector& u) {
  PatchBatch* batches = batches_.data() + patch.first_batch;
  Evaluated at[most_batches];
  double gbar = 0;
  for (int b = 0; b < patch.batches; ++b) {
    at[b].H = gradient(batches[b], u);
    const Want want = stored_energies_ ? Want::tangent : Want::stress;
    batches[b].law.evaluate_rest(want, {&at[b].H, 1}, {&at[b].rest, 1});
    batches[b].law.evaluate_constraint(want, {&at[b].H, 1}, {&at[b].volume, 1});
    gbar += sum(batches[b].weight * at[b].volume.energy) / patch.volume;
  }
  patch.stored_beside = 0;
  const Lanes modulus = lanes_of(patch.modulus), p = gbar * modulus;
  for (int b = 0; b < patch.batches; ++b) {
    PatchBatch& batch = batches[b];
    Response all = joined(at[b].rest, at[b].volume, p, modulus, patch.modulus, stored_energies_);
    batch.history.end_step({&at[b].H, 1}, {&all, 1}, stored_energies_);
    if (!stored_energies_) continue;
    batch.history.apply(Want::stress, {&at[b].H, 1}, {&all, 1});
    patch.stored_beside += fe::stored_beside(batch.history, {&all, 1}, {&batch.weight, 1}, batch.count);
  }
}

double PatchElements::stored_beside() const {
  double sum = 0;
  for (const Patch& patch : patches_) sum += patch.stored_beside;
  return sum;
}

std::shared_ptr<const std::vector<double>> PatchElements::history_stress() const {
  return history_stresses(batches_, numbering_.elements.size(), 1, element_of);
}

std::shared_ptr<const std::vector<double>> PatchElements::history_energy() const {
  if (!stored_energies_) return nullptr;
  return history_energies(batches_, numbering_.elements.size(), 1, element_of);
}

void PatchElements::add_mass(bool lumped, ScalarMatrix& mass) const {
  for (const Patch& patch : patches_)
    for (int b = patch.first_batch; b < patch.first_batch + patch.batches; ++b) {
      const PatchBatch& batch = batches_[static_cast<std::size_t>(b)];
      for (int lane = 0; lane < batch.count; ++lane) {
        int ids[4];
        for (int a = 0; a < 4; ++a) ids[a] = numbering_.node_of[static_cast<std::size_t>(batch.node[lane][a])];
        const ElementMass<4> M = densities_.mass<3, 4>(positions(), ids, patch.region, batch.cell[lane], lumped);
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j) {
            const std::size_t place = static_cast<std::size_t>(batch.local[lane][i]) * patch.nodes.size() +
                                      static_cast<std::size_t>(batch.local[lane][j]);
            mass.values[static_cast<std::size_t>(patch.positions[place])] += M(i, j);
          }
      }
    }
}

std::size_t PatchElements::bytes() const {
  std::size_t sum = numbering_.bytes() + batches_.size() * sizeof(PatchBatch) + patches_.size() * sizeof(Patch);
  for (const PatchBatch& batch : batches_) sum += batch.law.bytes() + batch.history.bytes();
  for (const Patch& patch : patches_) sum += (patch.nodes.size() + patch.positions.size()) * sizeof(int);
  return sum;
}

void PatchElements::visit_points(const Vector& u, const PointsVisitor& visit) const {
  tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t p) {
    const Patch& patch = patches_[p];
    double gbar = 0;
    for (int b = 0; b < patch.batches; ++b) {
      const PatchBatch& batch = batches_[static_cast<std::size_t>(patch.first_batch + b)];
      const Gradients H = gradient(batch, u);
      Response volume;
      batch.law.evaluate_constraint(Want::stress, {&H, 1}, {&volume, 1});
      gbar += sum(batch.weight * volume.energy) / patch.volume;
    }
    for (int b = 0; b < patch.batches; ++b) {
      const PatchBatch& batch = batches_[static_cast<std::size_t>(patch.first_batch + b)];
      const Gradients H = gradient(batch, u);
      for (int lane = 0; lane < batch.count; ++lane) {
        ElementPoints out = {};
        out.count = 1;
        out.weight[0] = batch.weight[lane];
        out.place[0] = Vec3::Zero();
        for (int a = 0; a < 4; ++a) {
          const auto node = static_cast<std::size_t>(batch.node[lane][a]);
          out.place[0] += 0.25 * positions().row(numbering_.node_of[node]).transpose();
        }
        for (int k = 0; k < 9; ++k) out.gradient.c[k][0] = H.c[k][lane];
        out.volume_stress[0] = patch.modulus * gbar;
        visit(static_cast<std::size_t>(batch.element[lane]), out);
      }
    }
  });
}

}  // namespace msml::fe
