// SPDX-License-Identifier: GPL-3.0-or-later
// The check after a run: equilibrium, balance, volume, strain, rotation, mass and lowest period.
#pragma once
#include "solver/integrators/stepper.hpp"

namespace msml::fe {

/// Free unknowns of a step.
long count_unknowns(const Model& model, const Numbering& numbering, int step);

/// Fills the check for the present state of a run.
Check check_answer(Run& run);

/// Share of the amplitude that backward Euler takes from an undamped oscillation of the given period in one cycle. Each
/// time step multiplies the amplitude by 1/sqrt(1 + w^2) and turns the phase by atan w, w = 2 pi dt/period.
double euler_loss_per_cycle(double period, double dt);

}  // namespace msml::fe
