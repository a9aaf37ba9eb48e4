// SPDX-License-Identifier: GPL-3.0-or-later
// Eight quadratic tetrahedra with one rotation each: the arithmetic, apart from the assembly.
#pragma once
#include <functional>

#include "solver/elements/hooke_points.hpp"
#include "solver/elements/simplex_elements.hpp"

namespace msml::fe {

/// What eight viscoelastic elements remember: the series relaxes q = K d in the frame that turns with the element, as
/// PronyHistory does S: q = factor K d + fixed. Since that is linear in d, kept are the displacements e_i of Maxwell's
/// springs, h_i = K e_i, which hold e_i . K e_i / (2 g_i).
struct RotationHistory {
  using Displacements = std::array<Lanes[3], 10>;
  explicit RotationHistory(const PronySeries& of) : series(of), elastic(), parts(of.terms().size()), fixed() {}

  PronySeries series;
  Displacements elastic;             ///< d at the start of the step, times the scale of the series
  std::vector<Displacements> parts;  ///< e_i at the start of the step
  Displacements fixed;
  Lanes stored = {};  ///< energy at the end of the last step
};

/// The stiffness of eight elements at rest; block (a, b), a <= b, at b(b+1)/2 + a.
struct RestStiffness {
  Lanes block[55][9];
};

/// What eight elements keep. Unused lanes have no stiffness.
struct RotationBatch {
  Lanes X[10][3];                        ///< reference positions, relative to corner 0
  Lanes g[4][3];                         ///< gradients of the corners' linear shape functions
  Lanes shear, ratio;                    ///< reference volume times mu, and lambda/mu; of straight elements of one law
  std::vector<RestStiffness> kept;       ///< one, or none where shear, ratio and g say it all
  bool exact = true;                     ///< the law asks for the derivative of the force as tangent
  std::vector<RotationHistory> history;  ///< one, or none where elastic
  std::size_t bytes() const { return sizeof *this + kept.size() * sizeof(RestStiffness); }
};

/// What one evaluation leaves for the tangent; see make_single_rotation_elements for the letters.
struct RotationState {
  Tensor<Lanes> R, U, inverse;  ///< inverse of D
  Lanes d[10][3], q[10][3], w[3];
  Lanes energy, J;  ///< J: det of the corners' deformation gradient
};

/// Stiffness and g of a batch; `gradients(q, g)` gives dN/dX at quadrature point q.
RotationBatch make_rotation_batch(const SimplexBatch<3, 10, 4>& batch,
                                  const std::function<void(int, SimplexGradients<3, 10>&)>& gradients);

/// What relaxation leaves of the stiffness in the step that was begun last.
Lanes factor_of(const RotationBatch& batch);

/// Makes X relative to corner 0.
void move_corner(RotationBatch& batch);

/// Sets the step that follows, of elements with a history.
void begin_step(double dt, RotationBatch& batch);

/// Takes over its end at u; finds the stored energy too.
void end_step(const Lanes (&u)[10][3], RotationBatch& batch);

/// Forces of eight elements displaced by u into result.force (overwritten).
RotationState evaluate_rotation(const RotationBatch& batch, const Lanes (&u)[10][3], SimplexResult<3, 10>& result);

/// What R K R^T of straight elements of one law is made of, with what relaxation leaves.
HookePoint turned_hooke(const RotationBatch& batch, const RotationState& state);

/// Their stiffness into result.block (overwritten): the Hessian of the energy, or R K R^T.
void rotation_tangent(const RotationBatch& batch, const RotationState& state, bool exact, SimplexResult<3, 10>& result);

}  // namespace msml::fe
