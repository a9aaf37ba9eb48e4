// SPDX-License-Identifier: GPL-3.0-or-later
// What viscoelastic quadrature points remember.
#pragma once
#include <span>
#include <vector>

#include "solver/elements/prony_series.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {

/// A symmetric tensor of eight points: xx yy zz xy yz xz.
struct SymmetricLanes {
  Lanes c[6] = {};
};

/// The history of eight elements at their quadrature points, under quasi-linear viscoelasticity (see Prony):
/// S = g_inf S_e + sum_i h_i, h_i' + h_i / tau_i = g_i S_e', S_e the elastic second Piola stress, g_inf = 1 - sum_i
/// g_i. Over a step of dt in which S_e changes linearly, with x = dt / tau_i (Taylor, Pister and Goudreau 1970,
/// doi 10.1002/nme.1620020106; Simo 1987, doi 10.1016/0045-7825(87)90107-1):
/// h_i <- exp(-x) h_i + g_i (1 - exp(-x)) / x (S_e,new - S_e,old), so that S = factor S_e + Q with Q fixed in the step.
/// A step that jumps at its start is one of dt = 0 (instantaneous) followed by one without change. Small-strain laws
/// use their own stress P instead of S. Stored is g_inf W and what the terms hold, w(h_i) / g_i with
/// w(S) = W S . C^-1 S / (S_e . C^-1 S_e), C = dS_e/dE: the energy of the spring of a Maxwell element where S_e is
/// linear in E (Simo and Hughes 1998, doi 10.1007/b98904, section 10.2), and for every law g_i W after a sudden strain
/// and its part exp(-2 t / tau_i) as that is held. 0 where C is not positive definite.
/// Under plane stress S_e has no 33 component at any time, so that S has none either.
class PronyHistory {
 public:
  PronyHistory() = default;
  /// Of `points` quadrature points, with one series for all or one for each.
  PronyHistory(std::vector<PronySeries> series, int points, bool small_strain);

  bool empty() const { return series_.empty(); }
  /// Sets the step that follows.
  void begin_step(double dt);
  /// Of the elastic stress in this step.
  const Lanes& factor(std::size_t point) const { return of(point).factor(); }
  /// Elastic responses become viscoelastic ones: W <- factor W + Q : E, P <- factor P + F Q; the tangent is its
  /// derivative (for definite_tangent with the semidefinite part of Q).
  void apply(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const;
  /// Takes over the end of the step; `responses` are the elastic ones. With their tangents (`stored`), finds the stored
  /// energy.
  void end_step(std::span<const Gradients> gradients, std::span<const Response> responses, bool stored);
  std::size_t bytes() const;
  /// S at the end of the last step, per point; P for small-strain laws.
  std::span<const SymmetricLanes> stress() const { return stress_; }
  /// Energy stored per reference volume at the end of the last step that asked for it, per point.
  std::span<const Lanes> energy() const { return energy_; }

 private:
  const PronySeries& of(std::size_t point) const { return series_[series_.size() == 1 ? 0 : point]; }
  void store(std::size_t point, const Gradients& gradient, const Response& response);

  std::vector<PronySeries> series_;
  bool small_strain_ = false;
  std::vector<SymmetricLanes> elastic_;             ///< S_e at the start of the step, per point
  std::vector<std::vector<SymmetricLanes>> parts_;  ///< h_i at the start of the step: [term][point]
  std::vector<SymmetricLanes> fixed_;               ///< Q, per point
  std::vector<SymmetricLanes> stress_;
  std::vector<Lanes> energy_;
};

}  // namespace msml::fe
