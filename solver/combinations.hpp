// SPDX-License-Identifier: GPL-3.0-or-later
// What goes with what: the parts of Model::check that need no mesh.
#pragma once
#include "solver/model.hpp"

namespace msml::fe {

/// Each of the others throws Error where the parts of a model that it names do not go together, in the words of the
/// scene. None looks at Model::mesh or at the elements of regions; a region without a law (not known yet) is passed
/// over.

/// Throws Error "WHAT = VALUE is not > 0" (or >= 0) unless it is.
void check_number(const char* what, double value, bool zero_allowed);

/// Settings by themselves: ranges, and what goes with the integrator.
void check_settings(const Settings& settings);

/// Formulation, plane, quadrature and thickness against each other and against the kind of the elements.
void check_elements(const Model& model, CellKind kind);

/// The law of a region against formulation and plane of the model.
void check_law(const Model& model, const Region& region);

/// The prony series of a region: its numbers, and formulation, plane and settings of the model.
void check_prony(const Model& model, const Region& region);

/// All laws against each other, and against the integrator and the linear solver.
void check_problem(const Model& model);

}  // namespace msml::fe
