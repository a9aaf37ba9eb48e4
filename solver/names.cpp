// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the solver's choices and outcomes.
#include "solver/model.hpp"

namespace msml::fe {

const char* name(Stop stop) {
  switch (stop) {
    case Stop::converged:
      return "converged";
    case Stop::newton_limit:
      return "Newton iteration limit";
    case Stop::diverged:
      return "diverged";
    case Stop::inverted_element:
      return "inverted element";
    case Stop::indefinite_tangent:
      return "indefinite tangent";
    case Stop::linear_solver_limit:
      return "linear solver limit";
    case Stop::singular:
      return "singular matrix";
    case Stop::interrupted:
      return "interrupted";
    case Stop::out_of_memory:
      return "out of memory";
    case Stop::collapsed:
      return "collapsed equilibrium";
    case Stop::unstable_step:
      return "unstable time step";
    case Stop::step_too_large:
      return "step too large";
    case Stop::bad_element:
      return "bad element";
  }
  return "unknown";
}

const char* name(Integrator integrator) {
  switch (integrator) {
    case Integrator::static_:
      return "static";
    case Integrator::quasi_static:
      return "quasiStatic";
    case Integrator::implicit_euler:
      return "dynamicImplicitEuler";
    case Integrator::newmark:
      return "Newmark";
    case Integrator::generalized_alpha:
      return "generalizedAlpha";
    case Integrator::forward_euler:
      return "forwardEuler";
    case Integrator::symplectic_euler:
      return "symplecticEuler";
    case Integrator::central_difference:
      return "centralDifference";
  }
  return "unknown";
}

bool is_dynamic(Integrator integrator) {
  return integrator != Integrator::static_ && integrator != Integrator::quasi_static;
}

bool is_explicit(Integrator integrator) {
  return integrator == Integrator::forward_euler || integrator == Integrator::symplectic_euler ||
         integrator == Integrator::central_difference;
}

}  // namespace msml::fe
