// SPDX-License-Identifier: GPL-3.0-or-later
// Linear tetrahedra whose volume change is averaged over patches.
#pragma once
#include "solver/elements/chunks.hpp"
#include "solver/elements/mass.hpp"
#include "solver/elements/patches.hpp"
#include "solver/elements/prony_history.hpp"
#include "solver/elements/shapes.hpp"
#include "solver/elements/split_laws.hpp"

namespace msml::fe {

/// Up to eight elements of a patch side by side. Unused lanes repeat an element with weight 0.
struct PatchBatch {
  int count = 0;
  int element[lanes];   ///< places in Numbering::elements
  int cell[lanes];      ///< cell ids
  int node[lanes][4];   ///< numbered nodes
  int local[lanes][4];  ///< the same among the nodes of the patch
  Lanes g[4][3];        ///< dN_a/dX
  Lanes weight;         ///< reference volume
  BatchSplit law;
  PronyHistory history;  ///< empty where elastic
};

/// Elements with one volume change.
struct Patch {
  int region = 0;
  int first_batch = 0, batches = 1;
  std::vector<int> nodes;      ///< numbered nodes, ascending
  std::vector<int> positions;  ///< of block (a, b) in the pattern, at a * #nodes + b
  double volume = 0;           ///< reference
  double modulus = 0;          ///< mean of the elements, weighted by volume
  double stored_beside = 0;    ///< see Elements::stored_beside
};

/// Energy sum_e V_e rest(F_e) + V k/2 gbar^2 of each patch of volume V, gbar the mean of g over it weighted by volume:
/// mean dilatation (Nagtegaal, Parks and Rice 1974, doi 10.1016/0045-7825(74)90032-2) on patches of tetrahedra (de
/// Souza Neto, Andrade Pires and Owen 2005, doi 10.1002/nme.1187), in the form that has an energy, so that the tangent
/// sum V_e (A_rest + k gbar d2g) + k/V (sum V_e dg)(sum V_e dg)^T is symmetric; it couples all nodes of a patch.
/// Want::definite_tangent leaves out k gbar d2g.
/// With a history (see PronyHistory) each element remembers S_e = d(rest + k gbar g)/dE, all of a patch with the mean
/// of their series: the energy of a step is factor (sum_e V_e rest + V k/2 gbar^2) + sum_e V_e Q_e : E_e.
class PatchElements final : public Elements {
 public:
  explicit PatchElements(const Model& model);
  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override;
  void add_mass(bool lumped, ScalarMatrix& mass) const override;
  void visit_points(const Vector& u, const PointsVisitor& visit) const override;
  void begin_step(double dt) override;
  void end_step(const Vector& u) override;
  std::shared_ptr<const std::vector<double>> history_stress() const override;
  std::shared_ptr<const std::vector<double>> history_energy() const override;
  double stored_beside() const override;
  std::size_t bytes() const override;
  const Numbering& numbering() const override { return numbering_; }
  const PatternPtr& pattern() const override { return pattern_; }

 private:
  const Points& positions() const { return numbering_.mesh->points; }  ///< at rest
  void make_patch(const std::vector<int>& elements, const Model& model);
  void fill(PatchBatch& batch, const Patch& patch, const Model& model);
  void find_positions();
  void remember(const Patch& patch, const Region& region);
  void end_step(Patch& patch, const Vector& u);
  Assembled add_patch(const Patch& patch, const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const;

  Numbering numbering_;
  bool stored_energies_ = true;
  PatternPtr pattern_;
  Densities densities_;
  std::vector<PatchBatch> batches_;
  std::vector<Patch> patches_;
  std::vector<std::vector<Chunk>> colours_;  ///< of patches
};

}  // namespace msml::fe
