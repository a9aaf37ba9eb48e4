// SPDX-License-Identifier: GPL-3.0-or-later
// Motions of incompressible bodies: what keeps their volumes, and how far a given one is from that.
#pragma once
#include "solver/equations.hpp"
#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// Mixed elements of infinite modulus keep c(u) = int N_c g(F) = 0 for each of their corners c (see MixedElements).
/// 1 for the pressures that enforce it, which nothing but the balance of forces determines; `tangent` is one of theirs.
Mask open_pressures(const Numbering& numbering, const BlockMatrix& tangent);

/// The second rate of c along a motion with the velocity v, c''(u)[v, v], at all pressures; zero at displacements. By
/// central differences of sixth order over strains of up to 3 %: exact where g is a polynomial, to 1e-10 elsewhere.
Vector second_rate(const Elements& elements, const Vector& u, const Vector& v);

/// Motions x and pressures y with M x + B y = f and B^T x = r, where B = dc/du: the balance of a body that keeps its
/// volume; with f = 0 the smallest x, in the norm of the mass M, that has these rates r.
class Saddle {
 public:
  /// `open`: open_pressures(); `room` is overwritten, and used until the last call of solve, as is `linear`.
  Saddle(const Equations& equations, const Supports& supports, const Mask& open, LinearSystem& linear,
         BlockMatrix& room);
  /// Takes B from a tangent.
  LinearStatus factor(const BlockMatrix& tangent);
  /// `right`: f at displacements and r at open pressures. `given`: x at fixed unknowns, zero at others; slides hold x
  /// in their planes. `both`: x at displacements and y at open pressures, in units of the unknown; zero at others.
  LinearStatus solve(const Vector& right, const Vector& given, Vector& both);

 private:
  const Equations& equations_;
  const Supports& supports_;
  LinearSystem& linear_;
  BlockMatrix& matrix_;
  Mask still_;
  double scale_ = 1;  ///< of the mass: its entries then have the size of those of B
};

/// How much a motion changes volumes that are kept.
struct VolumeChange {
  /// The largest change around a corner, of the volume there, beside the largest gradient of the motion (root mean
  /// square over an element). NaN: the field makes no numbers.
  double relative = 0;
  double gradient = 0;  ///< that gradient
  int element = -1;     ///< cell id: of the elements at that corner the one that changes most
  double change = 0;    ///< of its own volume
};

/// Of the displacement u from rest.
VolumeChange volume_change(const Elements& elements, const Mask& open, const BlockMatrix& tangent, const Vector& u);
/// Of the velocity v, per time, from the displacement u; `tangent` is the one at u.
VolumeChange volume_rate(const Elements& elements, const Mask& open, const BlockMatrix& tangent, const Vector& u,
                         const Vector& v);

}  // namespace msml::fe
