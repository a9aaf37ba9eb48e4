// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients preconditioned by a multigrid cycle that turns with the body.
#include <cmath>
#include <limits>
#include <random>

#include "solver/linear/cg.hpp"
#include "solver/linear/multigrid/multigrid.hpp"
#include "solver/linear/multigrid/node_rotations.hpp"

namespace msml::fe {
namespace {

constexpr long limit_fresh = 400;      // iterations with grids of the matrix itself
constexpr double worth_a_set_up = 10;  // iterations that cost as much as setting up

/// The grids are those of an earlier matrix for as long as they serve: set up anew where the iterations grow. Between
/// two set-ups the cycle sees residuals turned back by the rotation of each node since the last one, so that the
/// matrix of a body that turns without straining is met exactly.
class MultigridSolver final : public LinearSystem {
 public:
  MultigridSolver(const NodeGeometry& geometry, std::function<void()> pulse)
      : geometry_(geometry), grids_(geometry, pulse), pulse_(std::move(pulse)) {}

  void place(const Vector& displacement) override { displacement_ = displacement; }
  void expect(const Vector& solution) override { guesses_.expect(solution); }

  LinearStatus factor(const BlockMatrix& A, const Mask& fixed) override {
    matrix_ = {&A};
    pattern_ = A.pattern;
    if (usable_ && !stale_ && fixed == fixed_) {
      turn();
      return LinearStatus::done;
    }
    fixed_ = fixed;
    return set_up();
  }

  bool take(const Products& A, const Mask& fixed) override {
    if (!usable_ || stale_ || fixed != fixed_) return false;
    matrix_ = {.products = &A};
    turn();
    return true;
  }

  LinearStatus solve(const Vector& right, double tolerance, Vector& x) override {
    b_ = right;
    zero_fixed(fixed_, b_);
    guesses_.start(matrix_, fixed_, b_, r_, x);
    const double target = tolerance * std::sqrt(dot(b_, b_));
    double size = std::sqrt(dot(r_, r_)), before = std::numeric_limits<double>::infinity();
    if (size <= target) size = measure(x);  // the difference of large multiples drifts too
    while (size > target) {
      const double decades = std::max(1.0, std::log10(size / target));
      const bool judged = !fresh_ && usual_ > 0;
      const long limit = judged ? static_cast<long>(2 * usual_ * decades) + 10 : limit_fresh;
      long taken = 0;
      const LinearStatus status = conjugate_gradients(
          matrix_, fixed_, [this](const Vector& r, double length, Vector& z) { precondition(r, length, z); }, target,
          limit, space_, r_, x, taken);
      iterations += taken;
      if (fresh_ && usual_ == 0 && status == LinearStatus::done && decades >= 2)
        usual_ = static_cast<double>(taken) / decades;
      stale_ = stale_ || (judged && static_cast<double>(taken) > usual_ * decades + worth_a_set_up);
      if (status == LinearStatus::limit && fresh_) return status;
      if (status == LinearStatus::not_positive_definite && fresh_) return status;
      if (status != LinearStatus::done) {
        const LinearStatus made = set_up();
        if (made != LinearStatus::done) return made;
      }
      size = measure(x);  // go on from there where needed
      if (!std::isfinite(size)) return LinearStatus::not_positive_definite;
      if (status == LinearStatus::done && size > target && std::isfinite(before)) {  // once more did not help
        if (size <= round_off(x)) break;
        if (size > 0.5 * before) return LinearStatus::limit;
      }
      before = size;
    }
    guesses_.keep(x);
    return LinearStatus::done;
  }

  /// A solution with a random right-hand side meets every direction of negative curvature.
  LinearStatus probe() override {
    Vector right = Vector::Zero(static_cast<Eigen::Index>(fixed_.size())), unused;
    std::mt19937 random(1);
    for (Eigen::Index k = 0; k < right.size(); ++k) right[k] = static_cast<double>(random() % 2001) / 1000 - 1;
    return solve(right, 1e-6, unused);
  }

  bool iterative() const override { return true; }
  std::size_t factor_bytes() const override {
    std::size_t sum =
        grids_.bytes() + guesses_.bytes() + 2 * geometry_.ends.size() * sizeof(geometry_.ends[0]) + fixed_.size();
    for (const Vector* v : {&geometry_.positions, &geometry_.positions, &displacement_, &reference_, &b_, &r_,
                            &space_.z, &space_.p, &space_.q})
      sum += bytes(*v);
    return sum + (rotations_.size() + single_r_.size() + single_z_.size()) * sizeof(float);
  }

 private:
  /// The norm of the true residual, from which recurrences drift.
  double measure(const Vector& x) {
    multiply(matrix_, x, r_);
    r_ = b_ - r_;
    zero_fixed(fixed_, r_);
    return std::sqrt(dot(r_, r_));
  }

  /// Norm of the residual that round-off in A x alone can leave: eps |A| |x| (Higham 2002, section 3.5). No method does
  /// better.
  double round_off(const Vector& x) {
    const BlockMatrix& A = matrix_.in_numbers();
    const Pattern& pattern = *A.pattern;
    Vector bound(x.size());
    for_rows(pattern.nodes(), 512, [&](int r) {
      double sum[3] = {};
      for (int p = pattern.offsets[static_cast<std::size_t>(r)]; p < pattern.offsets[static_cast<std::size_t>(r) + 1];
           ++p)
        for (std::size_t k = 0; k < 9; ++k)
          sum[k / 3] += std::abs(A.values[9 * static_cast<std::size_t>(p) + k] *
                                 x[3 * pattern.columns[static_cast<std::size_t>(p)] + static_cast<int>(k % 3)]);
      for (int i = 0; i < 3; ++i) bound[3 * r + i] = sum[i];
    });
    zero_fixed(fixed_, bound);
    return std::numeric_limits<double>::epsilon() * std::sqrt(dot(bound, bound));
  }

  LinearStatus set_up() {
    usable_ = stale_ = false;
    const LinearStatus status = grids_.set(matrix_.in_numbers(), fixed_);
    if (status != LinearStatus::done) return status;
    reference_ = geometry_.positions;
    if (displacement_.size() == reference_.size()) reference_ += displacement_;
    rotations_.clear();
    usable_ = fresh_ = true;
    usual_ = 0;
    return status;
  }

  void turn() {
    fresh_ = false;
    rotations_.clear();
    if (displacement_.size() != reference_.size()) return;
    node_rotations(*pattern_, reference_, Vector(geometry_.positions + displacement_), fixed_, geometry_.ends,
                   rotations_);
  }

  /// z = R V R^T r with the rotations R of the nodes, in single precision on numbers of order one.
  void precondition(const Vector& r, double size, Vector& z) {
    if (pulse_) pulse_();
    const auto count = static_cast<std::size_t>(r.size());
    single_r_.resize(count + 8, 0.0f);
    single_z_.resize(count + 8, 0.0f);
    const double scale = 1 / size;
    for_rows(static_cast<int>(count / 3), 1024, [&](int n) { turned(n, true, r.data(), scale, single_r_.data()); });
    grids_.cycle(single_r_, single_z_);
    for_rows(static_cast<int>(count / 3), 1024, [&](int n) { turned(n, false, single_z_.data(), size, z.data()); });
  }

  template <class From, class To>
  void turned(int n, bool back, const From* from, double scale, To* to) const {
    const From* v = from + 3 * n;
    To* out = to + 3 * n;
    if (rotations_.empty()) {
      for (int i = 0; i < 3; ++i) out[i] = static_cast<To>(scale * v[i]);
      return;
    }
    const float* R = rotations_.data() + 9 * static_cast<std::size_t>(n);
    for (int i = 0; i < 3; ++i) {
      double sum = 0;
      for (int j = 0; j < 3; ++j) sum += static_cast<double>(back ? R[3 * j + i] : R[3 * i + j]) * v[j];
      out[i] = static_cast<To>(scale * sum);
    }
  }

  NodeGeometry geometry_;
  Multigrid grids_;
  std::function<void()> pulse_;
  SystemMatrix matrix_;
  PatternPtr pattern_;
  Mask fixed_;
  bool usable_ = false, fresh_ = false, stale_ = false;
  double usual_ = 0;  ///< iterations for a tenth of the residual with grids of the matrix itself; 0: not known
  Vector displacement_, reference_;
  std::vector<float> rotations_;  ///< 9 per node, row by row; empty: none
  Vector b_, r_;
  Guesses guesses_;
  CgSpace space_;
  std::vector<float> single_r_, single_z_;
};

}  // namespace

std::unique_ptr<LinearSystem> make_multigrid(const NodeGeometry& geometry, std::function<void()> pulse) {
  return std::make_unique<MultigridSolver>(geometry, std::move(pulse));
}

}  // namespace msml::fe
