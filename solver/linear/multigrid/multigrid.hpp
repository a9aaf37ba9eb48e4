// SPDX-License-Identifier: GPL-3.0-or-later
// A multigrid cycle as preconditioner.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "solver/linear/linear_system.hpp"
#include "solver/linear/multigrid/aggregates.hpp"
#include "solver/linear/multigrid/coarsest.hpp"
#include "solver/linear/multigrid/corners.hpp"
#include "solver/linear/multigrid/level.hpp"
#include "solver/linear/multigrid/prolongation.hpp"

namespace msml::fe {

/// z = V r, one symmetric V cycle: quadratic elements, then linear ones on the same corners, then groups of nodes that
/// reproduce rigid motions (smoothed aggregation, Vanek, Mandel and Brezina 1996), then a dense inverse. The set-up is
/// in double precision, the cycle in single.
/// Where the volume hardly changes (Poisson's ratio above 0.45), averages of corners and of groups lock: what they make
/// changes the volume, which is stiff, and what does not change it they cannot make. There mid nodes take from all
/// corners around them, prolongations lower their energy by a few steps, smoothers reach further down, and grids of
/// groups visit the next one twice (a W cycle). Conjugate gradients then need at most 40 iterations to 1e-8 at
/// nu = 0.49, on beams from 10^4 to 5x10^6 unknowns.
class Multigrid {
 public:
  /// `pulse` is called while grids are set up; an exception of its own ends the set-up.
  explicit Multigrid(NodeGeometry geometry, std::function<void()> pulse = {})
      : geometry_(std::move(geometry)), pulse_(std::move(pulse)) {}
  /// Takes the free part of a symmetric positive definite matrix. Grids are made anew when the mask changes; otherwise
  /// only their matrices. not_positive_definite if that shows.
  LinearStatus set(const BlockMatrix& A, const Mask& fixed);
  /// 3 numbers per node in and out (r may be written to); both are zero at fixed unknowns.
  void cycle(std::vector<float>& r, std::vector<float>& z);
  std::size_t bytes() const;
  /// The finest grid keeps its matrix in half precision.
  bool in_halves() const { return fine_.level.in_halves(); }

 private:
  /// A grid of groups below a grid with B unknowns per node.
  template <int B, int C = 6>
  struct Step {
    Blocks<float, B, C> P;
    Blocks<float, C, B> restriction;
  };
  template <int B>
  struct Grid {
    Blocks<double, B, B> matrix;  ///< of coarser grids, emptied after the set-up
    Level<B> level;
    std::vector<float> b, x, r;
    bool solved = false;  ///< by coarsest_, instead of smoothing
  };
  bool set_matrices(const FreeBlocks& A);
  bool set_groups(Modes& modes);
  bool set_fine(const FreeBlocks& A);
  bool set_linear(const FreeBlocks& A);
  bool nearly_incompressible() const { return geometry_.poisson_ratio > 0.45; }
  template <int B, class Matrix>
  bool coarsen(Grid<B>& grid, const Matrix& A, const std::vector<char>& skip, std::optional<Step<B>>& step,
               Modes& modes);
  template <int B>
  bool settle(Grid<B>& grid);
  template <int B>
  void descend(Grid<B>& grid, const std::optional<Step<B>>& step, std::size_t below);
  void prepare_modes(const std::vector<int>& nodes, const std::vector<char>& fixed, Modes& modes) const;

  void beat() const {
    if (pulse_) pulse_();
  }

  NodeGeometry geometry_;
  std::function<void()> pulse_;
  Mask fixed_;
  bool made_ = false, fresh_ = true;  ///< fresh_: the grids are being made
  bool heavy_ = false;                ///< inertia allows half precision on the fine grid
  int solved_size_ = 0;               ///< unknowns of a grid that is solved exactly, at most
  std::optional<Corners> corners_;
  Grid<3> fine_, linear_;
  std::optional<Step<3, 3>> wide_;  ///< from quadratic to linear elements, where the body is nearly incompressible
  std::optional<Step<3>> first_;    ///< from the linear grid (or the fine one, if it is linear) to the first of groups
  std::vector<Grid<6>> groups_;
  std::vector<std::optional<Step<6>>> steps_;  ///< steps_[k]: from groups_[k] to groups_[k + 1]
  Coarsest coarsest_;
};

}  // namespace msml::fe
