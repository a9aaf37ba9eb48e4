// SPDX-License-Identifier: GPL-3.0-or-later
// Where iterative solutions start.
#pragma once
#include <vector>

#include "solver/linear/linear_system.hpp"
#include "solver/linear/products.hpp"

namespace msml::fe {

/// v = 0 at fixed unknowns.
void zero_fixed(const Mask& fixed, Vector& v);

/// The solutions of a few time steps, in whose span that of the next one nearly is (Fischer 1998,
/// doi 10.1016/S0045-7825(98)00012-7): a motion with three frequencies is met exactly.
class Guesses {
 public:
  /// A vector that the next solution is likely near a multiple of.
  void expect(const Vector& likely) { likely_ = likely; }
  /// x = the sum of multiples of the expected vector and the solutions kept that is nearest to the solution of A x = b
  /// in the norm of A, r = b - A x; both 0 at fixed unknowns, as b is. Zero where nothing was expected.
  void start(const SystemMatrix& A, const Mask& fixed, const Vector& b, Vector& r, Vector& x);
  /// The solution of the system that start() was called for: kept if something was expected of it.
  void keep(const Vector& x);
  std::size_t bytes() const { return (span_.size() + image_.size()) * sizeof(Eight) + fe::bytes(likely_); }

 private:
  Vector likely_;
  std::vector<Eight> span_, image_;  ///< the expected vector, then solutions from new to old; and A times these
  bool started_ = false;
};

}  // namespace msml::fe
