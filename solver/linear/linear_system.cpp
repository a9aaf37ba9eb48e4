// SPDX-License-Identifier: GPL-3.0-or-later
// Eliminates fixed unknowns and chooses a linear solver.
#include "solver/linear/linear_system.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

namespace msml::fe {

LowerTriangle lower_triangle(const Pattern& pattern, const Mask& fixed) {
  LowerTriangle lower;
  std::vector<int> free_number(fixed.size(), -1);
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (!fixed[k]) {
      free_number[k] = lower.size();
      lower.unknown_of.push_back(static_cast<int>(k));
    }
  lower.starts.reserve(lower.unknown_of.size() + 1);
  lower.starts.push_back(0);
  for (const int unknown : lower.unknown_of) {
    const int node = unknown / 3, i = unknown % 3;
    // Row `unknown` of the symmetric matrix is its column.
    for (int p = pattern.offsets[static_cast<std::size_t>(node)];
         p < pattern.offsets[static_cast<std::size_t>(node) + 1]; ++p) {
      const int other = pattern.columns[static_cast<std::size_t>(p)];
      if (other < node) continue;
      for (int j = other == node ? i : 0; j < 3; ++j) {
        const int row = free_number[static_cast<std::size_t>(3 * other + j)];
        if (row < 0) continue;
        lower.rows.push_back(row);
        lower.source.push_back(9 * static_cast<std::size_t>(p) + static_cast<std::size_t>(3 * i + j));
      }
    }
    lower.starts.push_back(static_cast<int>(lower.rows.size()));
  }
  return lower;
}

void LowerTriangle::gather(const BlockMatrix& A, double* values) const {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, source.size(), 1 << 15),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t k = range.begin(); k < range.end(); ++k) values[k] = A.values[source[k]];
                    });
}

LinearStatus refine(const BlockMatrix& A, const std::vector<int>& unknown_of,
                    const std::function<bool(const Vector& residual, Vector& x)>& correct, const Vector& b,
                    double tolerance, Vector& x) {
  const auto norm = [&](const Vector& v) {
    double sum = 0;
    for (const int k : unknown_of) sum += v[k] * v[k];
    return std::sqrt(sum);
  };
  x = Vector::Zero(b.size());
  const double target = norm(b);
  if (target == 0) return LinearStatus::done;
  Vector residual = b, product;
  double before = target;
  for (int refinement = 0; refinement < 4; ++refinement) {
    if (!correct(residual, x)) return LinearStatus::out_of_memory;
    multiply(A, x, product);
    residual = b - product;
    const double now = norm(residual);
    if (!std::isfinite(now)) return LinearStatus::singular;
    if (now <= tolerance * target) return LinearStatus::done;
    if (refinement > 0 && now > 0.5 * before) break;
    before = now;
  }
  return norm(residual) <= 1e-6 * target ? LinearStatus::done : LinearStatus::singular;
}

namespace {

/// Conjugate gradients until they fail, Cholesky from then on.
class WithFallback final : public LinearSystem {
 public:
  WithFallback(const Settings& settings, std::unique_ptr<LinearSystem> first)
      : settings_(settings), active_(std::move(first)) {}
  void place(const Vector& displacement) override { active_->place(displacement); }
  void expect(const Vector& solution) override { active_->expect(solution); }

  LinearStatus factor(const BlockMatrix& A, const Mask& fixed) override {
    matrix_ = {&A};
    fixed_ = fixed;
    return active_->factor(A, fixed);
  }

  bool take(const Products& A, const Mask& fixed) override {
    if (!active_->take(A, fixed)) return false;
    matrix_ = {.products = &A};
    fixed_ = fixed;
    return true;
  }

  LinearStatus solve(const Vector& b, double tolerance, Vector& x) override {
    const long before = active_->iterations;
    LinearStatus status = active_->solve(b, tolerance, x);
    iterations += active_->iterations - before;
    if (status != LinearStatus::limit || gave_up) return status;
    auto direct = make_cholesky(settings_.threads, available_memory(), settings_.pulse);
    status = direct->factor(matrix_.in_numbers(), fixed_);
    if (status != LinearStatus::done) return status;  // which was not the fault of conjugate gradients
    gave_up = true;
    active_ = std::move(direct);
    return active_->solve(b, tolerance, x);
  }

  LinearStatus probe() override { return active_->probe(); }
  bool iterative() const override { return active_->iterative(); }
  std::size_t factor_bytes() const override { return active_->factor_bytes(); }

 private:
  Settings settings_;
  std::unique_ptr<LinearSystem> active_;
  SystemMatrix matrix_;
  Mask fixed_;
};

}  // namespace

std::unique_ptr<LinearSystem> make_linear_system(const Settings& settings, const NodeGeometry& geometry) {
  // The factor of a tet10 mesh passes about 16 GB at the upper limit; below the lower one a factorisation takes a
  // millisecond or two. At 1,600 unknowns time steps take 1.5 to 4 times as long with it, at 2,800 six times.
  constexpr long largest_factor = 600000, smallest_iterated = 1000;
  const long unknowns = geometry.positions.size();
  const bool factored = settings.linear_solver == LinearSolver::direct ||
                        (settings.linear_solver == LinearSolver::automatic &&
                         (unknowns <= smallest_iterated || (!geometry.solid && unknowns <= largest_factor)));
  if (factored) return make_cholesky(settings.threads, available_memory(), settings.pulse);
  const bool multigrid = settings.preconditioner == Preconditioner::multigrid ||
                         (settings.preconditioner == Preconditioner::automatic && geometry.solid);
  auto iterative = multigrid ? make_multigrid(geometry, settings.pulse)
                             : make_conjugate_gradient(settings.preconditioner, settings.pulse);
  if (unknowns <= largest_factor) return std::make_unique<WithFallback>(settings, std::move(iterative));
  return iterative;
}

}  // namespace msml::fe
