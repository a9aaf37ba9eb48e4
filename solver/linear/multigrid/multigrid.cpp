// SPDX-License-Identifier: GPL-3.0-or-later
// Sets up and runs the cycle.
#include "solver/linear/multigrid/multigrid.hpp"

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
  for_rows(A.sparsity.rows(), 512, [&](int r) {
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

}  // namespace

/// The matrix of the finest grid in single precision; in double too where groups are made from it.
bool Multigrid::set_fine(const FreeBlocks& A) {
  const Sparsity sparsity = A.sparsity();
  const std::size_t size = 3 * at(sparsity.rows()) + 8;
  for (auto* v : {&fine_.b, &fine_.x, &fine_.r}) v->assign(size, 0.0f);
  if (!corners_) {
    fine_.matrix.sparsity = sparsity;
    fine_.matrix.values.resize(9 * sparsity.columns.size() + 8);
    for_rows(sparsity.rows(), 512, [&](int r) {
      for (int p = sparsity.offsets[at(r)]; p < sparsity.offsets[at(r + 1)]; ++p)
        A.copy(p, r, sparsity.columns[at(p)], fine_.matrix.block(p));
    });
  }
  return fine_.level.set(sparsity, [&](int p, int r, int c, double* out) { A.copy(p, r, c, out); });
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
  grid.solved = B * grid.matrix.sparsity.rows() <= Coarsest::largest;
  const auto copy = [&](int p, int, int, double* out) { std::copy_n(grid.matrix.block(p), B * B, out); };
  const bool good = grid.solved ? coarsest_.set(grid.matrix) : grid.level.set(grid.matrix.sparsity, copy);
  const std::size_t size = B * at(grid.matrix.sparsity.rows()) + 8;
  for (auto* v : {&grid.b, &grid.x, &grid.r}) v->assign(size, 0.0f);
  return good;
}

/// Makes the step below a grid, unless it is the last, and the matrix there.
template <int B>
bool Multigrid::coarsen(Grid<B>& grid, const std::vector<char>& skip, std::optional<Step<B>>& step, Modes& modes) {
  if (grid.solved) return false;
  if (!step) {
    if (!fresh_) return false;
    const Aggregates groups = aggregate(grid.matrix, skip);
    if (groups.count == 0 || 3 * groups.count > 2 * grid.matrix.sparsity.rows()) return false;
    Modes coarse;
    step.emplace();
    step->P = prolongation(grid.matrix, grid.level.inverse(), grid.level.radius(), groups, modes, coarse);
    step->restriction = transposed(step->P);
    step->P_single = rounded(step->P);
    step->restriction_single = rounded(step->restriction);
    modes = std::move(coarse);
  }
  return true;
}

bool Multigrid::set_matrices(const FreeBlocks& A) {
  if (!set_fine(A)) return false;
  Grid<3>* last = &fine_;
  if (corners_) {
    corners_->restrict_matrix(A, linear_.matrix);
    if (!settle(linear_)) return false;
    last = &linear_;
  }
  Modes modes;
  if (fresh_) {
    std::vector<int> nodes(at(last->matrix.sparsity.rows()));
    for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = corners_ ? corners_->node_of()[n] : static_cast<int>(n);
    prepare_modes(nodes, corners_ ? corners_->fixed() : fixed_, modes);
  }
  if (!coarsen(*last, held(corners_ ? corners_->fixed() : fixed_), first_, modes)) return true;
  if (groups_.empty()) groups_.emplace_back(), steps_.emplace_back();
  galerkin(last->matrix, first_->P, first_->restriction, groups_[0].matrix);
  last->matrix.values = {};
  for (std::size_t k = 0; k < 20; ++k) {
    if (!settle(groups_[k])) return false;
    if (!coarsen(groups_[k], std::vector<char>(at(groups_[k].matrix.sparsity.rows()), 0), steps_[k], modes)) break;
    if (groups_.size() == k + 1) groups_.emplace_back(), steps_.emplace_back();
    galerkin(groups_[k].matrix, steps_[k]->P, steps_[k]->restriction, groups_[k + 1].matrix);
    groups_[k].matrix.values = {};
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
    first_.reset();
    groups_.clear();
    steps_.clear();
    made_ = true;
  }
  return set_matrices({A, fixed_}) ? LinearStatus::done : LinearStatus::not_positive_definite;
}

/// x = V b on a grid, with everything below it.
template <int B>
void Multigrid::descend(Grid<B>& grid, const std::optional<Step<B>>& step, std::size_t below) {
  if (grid.solved) return coarsest_.solve(grid.b, grid.x);
  grid.level.smooth_from_zero(grid.b, grid.x);
  if (step) {
    grid.level.residual(grid.b, grid.x, grid.r);
    multiply_single(step->restriction_single, grid.r, groups_[below].b, false);
    descend(groups_[below], steps_[below], below + 1);
    multiply_single(step->P_single, groups_[below].x, grid.x, true);
  }
  grid.level.smooth(grid.b, grid.x);
}

void Multigrid::cycle(std::vector<float>& r, std::vector<float>& z) {
  std::swap(fine_.b, r);
  if (corners_) {
    fine_.level.smooth_from_zero(fine_.b, fine_.x);
    fine_.level.residual(fine_.b, fine_.x, fine_.r);
    corners_->restrict_vector(fine_.r, linear_.b);
    descend(linear_, first_, 0);
    corners_->add_prolonged(linear_.x, fine_.x);
    fine_.level.smooth(fine_.b, fine_.x);
  } else {
    descend(fine_, first_, 0);
  }
  std::swap(fine_.b, r);
  std::swap(fine_.x, z);
}

std::size_t Multigrid::bytes() const {
  std::size_t sum = fine_.level.bytes() + linear_.level.bytes() + coarsest_.bytes();
  if (first_) sum += 3 * (first_->P_single.bytes() + first_->restriction_single.bytes());
  for (const Grid<6>& grid : groups_) sum += grid.level.bytes();
  for (const auto& step : steps_)
    if (step) sum += 3 * (step->P_single.bytes() + step->restriction_single.bytes());
  return sum;
}

}  // namespace msml::fe
