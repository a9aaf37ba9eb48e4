// SPDX-License-Identifier: GPL-3.0-or-later
// Walks to the end of an increment in pieces where Newton's method does not get there at once.
#include <algorithm>

#include "solver/newton.hpp"

namespace msml::fe {

IncrementResult Newton::walk(const Increment& increment) {
  // Full steps that blow the body up end with a singular matrix too: that says nothing about the body.
  const auto final = [this](const IncrementResult& result) {
    return result.stop == Stop::converged || (result.stop == Stop::singular && searching_) ||
           result.stop == Stop::out_of_memory || model_.settings.newton_iterations == 1;
  };
  searching_ = false;
  IncrementResult direct = run(increment);
  const bool plain = !model_.settings.line_search && direct.stop == Stop::singular, done = plain || final(direct);
  searching_ = model_.settings.line_search;
  if (!done && searching_) {
    tangent_current_ = false;
    direct = run(increment);
  }
  if (done || final(direct)) return direct;
  evaluate(increment, increment.start, want_, false);
  const Vector unbalanced = this->residual(increment);
  Increment part = increment;
  double share = 0, piece = 0.25;
  IncrementResult result = direct;
  while (share < 1 && piece > 1e-3) {
    const double next = std::min(1.0, share + piece);
    part.target = increment.start + next * (increment.target - increment.start);
    part.offset = (1 - next) * unbalanced;
    if (increment.offset.size() > 0) part.offset += increment.offset;
    tangent_current_ = false;
    result = run(part);
    if (result.stop == Stop::converged) {
      part.start = result.u;
      share = next;
      piece *= 2;
    } else {
      piece /= 2;
    }
  }
  tangent_current_ = false;
  result.walked = share;
  walked_ += result.stop == Stop::converged;
  return result;
}

}  // namespace msml::fe
