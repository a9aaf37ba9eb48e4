// SPDX-License-Identifier: GPL-3.0-or-later
// What goes with what: the parts of Model::check that need no mesh.
#pragma once
#include <functional>

#include "msml/core/error.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// What is done with a fault that is found. A check that goes on finds all of them.
using Tell = std::function<void(const Error&)>;
/// Throws it.
[[noreturn]] void raise(const Error& error);

/// Throws Error "WHAT = VALUE is not > 0" (or >= 0) unless it is.
void check_number(const char* what, double value, bool zero_allowed);

/// Each of the others tells where the parts of a model that it names do not go together, in the words of the scene.
/// None looks at Model::mesh or at the elements of regions; a region without a law (not known yet) is passed over.

/// Settings by themselves: ranges, and what goes with the integrator.
void check_settings(const Settings& settings, const Tell& tell = raise);

/// Formulation, plane, quadrature and thickness against each other and against the kind of the elements.
void check_elements(const Model& model, CellKind kind, const Tell& tell = raise);

/// The law of a region against formulation and plane of the model.
void check_law(const Model& model, const Region& region, const Tell& tell = raise);

/// The prony series of a region: its numbers, and formulation, plane and settings of the model.
void check_prony(const Model& model, const Region& region, const Tell& tell = raise);

/// The laws of two regions against each other: one kind of unknown.
void check_same_unknown(const Region& first, const Region& region, const Tell& tell = raise);

/// A preconditioner that the scene names against the elements and the laws, where linear systems are iterated on.
void check_preconditioner(const Model& model, CellKind kind, const Tell& tell = raise);

/// All laws against the integrator and the linear solver.
void check_problem(const Model& model, const Tell& tell = raise);

}  // namespace msml::fe
