// SPDX-License-Identifier: GPL-3.0-or-later
// Sets up and runs the cycle.
#include "solver/linear/multigrid/multigrid.hpp"

#include <atomic>
#include <cmath>

namespace msml::fe {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Nodes without a free unknown.
std::vector<char> held(const std::vector<char>& fixed) {
  std::vector<char> all(fixed.size() / 3);
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = fixed[3 * n] && fixed[3 * n + 1] && fixed[3 * n + 2];
  return all;
}

template <int R, int C>
void multiply_single(const Blocks<float, R, C>& A, const std::vector<float>& x, std::vector<float>& y, bool add) {
  using V = Column<R>;
  for_rows(A.sparsity.rows(), A.piece(), [&](int r) {
    V sum = row_product(A, r, x.data());
    float* out = &y[at(R * r)];
    if (add) {
      V old;
      std::memcpy(&old, out, sizeof old);
      sum += old;
    }
    std::memcpy(out, &sum, R * sizeof(float));
  });
}

/// What a nearly incompressible body asks for, measured on beams at nu = 0.49 with 10^4 to 5x10^6 unknowns: at
/// most 40 iterations to 1e-8. More steps of energy make prolongations that serve less well, not only dearer ones.
constexpr int wide_steps = 2, first_steps = 6, later_steps = 6;
template <int B>
void reach_further(Level<B>& level, bool quadratic) {
  level.degree = 3;
  level.lowest = quadratic ? 0.02 : B == 3 ? 0.03 : 0.06;
}

/// True if inertia is large enough at every node that half precision (5e-4) does not hide the softest motions: about a
/// millionth of the stiffness against shear, of which the diagonal blocks have lambda/mu + 4 parts (5.5 where nu = .3).
/// What moves a body as a whole has no stiffness, so that the blocks of a row add up to its mass. Measured on beams 100
/// to 300 times as long as thick: at this limit 16 instead of 14 iterations, 31 instead of 27 with quadratic elements;
/// at a hundredth of it, and in statics, several times as many.
bool heavy(const BlockMatrix& A, double smallest_poisson_ratio) {
  const double nu = std::min(smallest_poisson_ratio, 0.49);  // beyond it rounding disturbs the volume too
  const double least = 5.5e-6 / (2 * nu / (1 - 2 * nu) + 4);
  const Pattern& pattern = *A.pattern;
  std::atomic<bool> everywhere = true;
  for_rows(pattern.nodes(), 1024, [&](int r) {
    double sum = 0;
    const auto trace = [&](int p) {
      const double* block = A.values.data() + 9 * at(p);
      return block[0] + block[4] + block[8];
    };
    for (int p = pattern.offsets[at(r)]; p < pattern.offsets[at(r + 1)]; ++p) sum += trace(p);
    if (!(std::abs(sum) > least * trace(pattern.diagonal[at(r)]))) everywhere = false;
  });
  return everywhere;
}

}  // namespace

/// The matrix of the finest grid in single precision.
bool Multigrid::set_fine(const FreeBlocks& A) {
  if (nearly_incompressible()) reach_further(fine_.level, corners_.has_value());
  fine_.level.halved = heavy_ && !(fresh_ && nearly_incompressible());  // lower_energy wants single precision
  const std::size_t size = 3 * at(A.view().rows()) + 8;
  for (auto* v : {&fine_.b, &fine_.x, &fine_.r}) v->assign(size, 0.0f);
  return fine_.level.set(A);
}

void Multigrid::prepare_modes(const std::vector<int>& nodes, const std::vector<char>& fixed, Modes& modes) const {
  const Vector& X = geometry_.positions;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int n : nodes) middle += X.segment<3>(3 * n) / static_cast<double>(nodes.size());
  double size = 0;
  for (const int n : nodes) size = std::max(size, (X.segment<3>(3 * n) - middle).norm());
  if (size == 0) size = 1;
  modes.assign(18 * nodes.size(), 0);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Eigen::Vector3d x = (X.segment<3>(3 * nodes[k]) - middle) / size;
    Eigen::Map<Eigen::Matrix<double, 3, 6>> block(modes.data() + 18 * k);
    block.leftCols<3>().setIdentity();
    block.rightCols<3>() << 0, x[2], -x[1], -x[2], 0, x[0], x[1], -x[0], 0;
    for (int i = 0; i < 3; ++i)
      if (fixed[3 * k + at(i)]) block.row(i).setZero();
  }
}

template <int B>
bool Multigrid::settle(Grid<B>& grid) {
  beat();
  grid.solved = B * grid.matrix.sparsity.rows() <= solved_size_;
  if (nearly_incompressible()) reach_further(grid.level, false);
  const bool good = grid.solved ? coarsest_.set(grid.matrix) : grid.level.set(grid.matrix);
  const std::size_t size = B * at(grid.matrix.sparsity.rows()) + 8;
  for (auto* v : {&grid.b, &grid.x, &grid.r}) v->assign(size, 0.0f);
  return good;
}

/// Makes the step below a grid with the matrix A, unless it is the last.
template <int B, class Matrix>
bool Multigrid::coarsen(Grid<B>& grid, const Matrix& A, const std::vector<char>& skip, std::optional<Step<B>>& step,
                        Modes& modes) {
  if (grid.solved) return false;
  beat();
  if (!step && fresh_) {
    const Aggregates groups = aggregate<B>(A, skip);
    if (groups.count > 0 && 3 * groups.count <= 2 * A.view().rows()) {
      Modes coarse;
      step.emplace();
      step->P = prolongation<B>(A, grid.level.inverse(), grid.level.radius(), groups, modes, coarse);
      if (nearly_incompressible())
        lower_energy(grid.level.matrix(), grid.level.inverse(), coarse, B == 3 ? first_steps : later_steps, step->P);
      step->restriction = transposed(step->P);
      modes = std::move(coarse);
    }
  }
  grid.level.forget_inverse();
  return step.has_value();
}

/// The grid of linear elements on the corners of quadratic ones.
bool Multigrid::set_linear(const FreeBlocks& A) {
  if (nearly_incompressible() && !wide_) {
    Modes modes;
    prepare_modes(corners_->node_of(), corners_->fixed(), modes);
    wide_.emplace();
    wide_->P = corners_->wide(A.view());
    lower_energy(fine_.level.matrix(), fine_.level.inverse(), modes, wide_steps, wide_->P);
    wide_->restriction = transposed(wide_->P);
  }
  fine_.level.forget_inverse();
  if (wide_)
    galerkin<3>(A, wide_->P, wide_->restriction, linear_.matrix);
  else
    corners_->restrict_matrix(A, linear_.matrix);
  return settle(linear_);
}

bool Multigrid::set_matrices(const FreeBlocks& A) {
  if (!set_fine(A)) return false;
  if (corners_) {
    if (!set_linear(A)) return false;
  }
  const Mask& fixed = corners_ ? corners_->fixed() : fixed_;
  Modes modes;
  if (fresh_) {
    std::vector<int> nodes(fixed.size() / 3);
    for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = corners_ ? corners_->node_of()[n] : static_cast<int>(n);
    prepare_modes(nodes, fixed, modes);
  }
  const bool more = corners_ ? coarsen(linear_, linear_.matrix, held(fixed), first_, modes)
                             : coarsen(fine_, A, held(fixed), first_, modes);
  if (more) {
    if (groups_.empty()) groups_.emplace_back(), steps_.emplace_back();
    if (corners_)
      galerkin<3>(linear_.matrix, first_->P, first_->restriction, groups_[0].matrix);
    else
      galerkin<3>(A, first_->P, first_->restriction, groups_[0].matrix);
  }
  linear_.matrix.forget_values();
  if (heavy_ && !fine_.level.halved) fine_.level.halve();
  return !more || set_groups(modes);
}

/// The grids of groups, of which the first has its matrix.
bool Multigrid::set_groups(Modes& modes) {
  for (std::size_t k = 0; k < 20; ++k) {
    if (!settle(groups_[k])) return false;
    const std::vector<char> none(at(groups_[k].matrix.sparsity.rows()), 0);
    const bool more = coarsen(groups_[k], groups_[k].matrix, none, steps_[k], modes);
    if (more && groups_.size() == k + 1) groups_.emplace_back(), steps_.emplace_back();
    if (more) galerkin<6>(groups_[k].matrix, steps_[k]->P, steps_[k]->restriction, groups_[k + 1].matrix);
    groups_[k].matrix.forget_values();
    if (!more) break;
  }
  return true;
}

LinearStatus Multigrid::set(const BlockMatrix& A, const Mask& fixed) {
  fresh_ = !made_ || fixed != fixed_;
  if (fresh_) {
    fixed_ = fixed;
    corners_.reset();
    if (!geometry_.ends.empty()) corners_.emplace(geometry_, fixed);
    fine_ = linear_ = {};
    wide_.reset();
    first_.reset();
    groups_.clear();
    steps_.clear();
  }
  // Quadratic elements that are nearly incompressible need half as many iterations again.
  heavy_ = !(corners_ && nearly_incompressible()) && heavy(A, geometry_.smallest_poisson_ratio);
  // An inverse that many time steps share pays where it takes a few milliseconds; else another grid costs less.
  if (fresh_) solved_size_ = heavy_ ? 700 : 400;
  made_ = set_matrices({A, fixed_});  // grids that are half made are not kept
  return made_ ? LinearStatus::done : LinearStatus::not_positive_definite;
}

/// x = V b on a grid, with everything below it.
template <int B>
void Multigrid::descend(Grid<B>& grid, const std::optional<Step<B>>& step, std::size_t below) {
  if (grid.solved) return coarsest_.solve(grid.b, grid.x);
  grid.level.smooth_from_zero(grid.b, grid.x);
  // Two visits of the grid below a grid of groups: they hardly cost, for it has a thirtieth of the rows.
  const int visits = !step ? 0 : B == 6 && nearly_incompressible() ? 2 : 1;
  for (int visit = 0; visit < visits; ++visit) {
    grid.level.residual(grid.b, grid.x, grid.r);
    multiply_single(step->restriction, grid.r, groups_[below].b, false);
    descend(groups_[below], steps_[below], below + 1);
    multiply_single(step->P, groups_[below].x, grid.x, true);
  }
  grid.level.smooth(grid.b, grid.x);
}

void Multigrid::cycle(std::vector<float>& r, std::vector<float>& z) {
  std::swap(fine_.b, r);
  if (corners_) {
    fine_.level.smooth_from_zero(fine_.b, fine_.x);
    fine_.level.residual(fine_.b, fine_.x, fine_.r);
    if (wide_)
      multiply_single(wide_->restriction, fine_.r, linear_.b, false);
    else
      corners_->restrict_vector(fine_.r, linear_.b);
    descend(linear_, first_, 0);
    if (wide_)
      multiply_single(wide_->P, linear_.x, fine_.x, true);
    else
      corners_->add_prolonged(linear_.x, fine_.x);
    fine_.level.smooth(fine_.b, fine_.x);
  } else {
    descend(fine_, first_, 0);
  }
  std::swap(fine_.b, r);
  std::swap(fine_.x, z);
}

std::size_t Multigrid::bytes() const {
  std::size_t sum = coarsest_.bytes() + (corners_ ? corners_->bytes() : 0);
  const auto add_grid = [&](const auto& grid) {
    sum += grid.level.bytes() + grid.matrix.bytes() + (grid.b.size() + grid.x.size() + grid.r.size()) * sizeof(float);
  };
  const auto add_step = [&](const auto& step) { sum += step ? step->P.bytes() + step->restriction.bytes() : 0; };
  add_grid(fine_);
  add_grid(linear_);
  add_step(wide_);
  add_step(first_);
  for (const Grid<6>& grid : groups_) add_grid(grid);
  for (const auto& step : steps_) add_step(step);
  return sum;
}

}  // namespace msml::fe
