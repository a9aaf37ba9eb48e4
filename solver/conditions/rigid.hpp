// SPDX-License-Identifier: GPL-3.0-or-later
// Finds parts of a body that nothing holds.
#pragma once
#include "solver/elements/assembly.hpp"
#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// Throws Error if a connected part of the body keeps a rigid motion under the step's supports: it names the place of
/// the part and the number of free motions. A part is connected through shared nodes.
void check_held(const Model& model, const Step& step);

/// The same where loads (3 per numbered node) push along motions that nothing holds: names the part that is pushed most
/// beside its loads, the force and the moment about its centre that are left over along these motions.
void refuse_unbalanced(const Model& model, const Step& step, const Numbering& numbering, const Vector& loads);

/// Rigid motions that nothing holds.
struct FreeMotions {
  std::vector<Vector> modes;            ///< orthonormal, in solver numbering; of small rotations
  std::vector<std::vector<int>> parts;  ///< numbered nodes of each connected part that has all six
};
FreeMotions free_motions(const Model& model, const Step& step, const Numbering& numbering, const Mask& fixed);

/// Takes the mean of free rigid motions out of a displacement that carries `loads` (their norm): all of them under
/// small strains; with large ones the translations of parts with six free motions and, where no load says which way
/// they turn, the best rotation (Kabsch 1976, doi 10.1107/S0567739476001873). X: reference positions.
void remove_free_motions(const FreeMotions& free, bool small_strain, double loads, const Vector& X, Vector& u);

}  // namespace msml::fe
