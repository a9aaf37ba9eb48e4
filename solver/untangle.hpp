// SPDX-License-Identifier: GPL-3.0-or-later
// A better start for increments that begin with elements turned inside out.
#pragma once
#include "solver/newton.hpp"

namespace msml::fe {

/// The same body of the stable neo-Hookean law (Smith, de Goes and Kim 2018, doi 10.1145/3180491), each region with the
/// shear modulus and Poisson's ratio of its own law at rest. That law does not hold a body in a tangle, as others may:
/// the answer to an increment with it is the place from which the model's own laws go on.
class Untangler {
 public:
  explicit Untangler(const Model& model);
  ~Untangler();
  /// Whether Newton's method may start elsewhere than at the increment's start: elastic finite-strain laws that survive
  /// inversion, displacements alone, more than one iteration, and Settings::untangle.
  static bool serves(const Model& model, const Equations& equations);
  /// The increment with the stable law; iterations and solves are counted as those of `own`. `rigid_free`: as
  /// Newton::free_rigid_motions.
  IncrementResult run(const Increment& increment, bool rigid_free, Newton& own);

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace msml::fe
