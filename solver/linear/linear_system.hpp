// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems on the free unknowns of a block matrix.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "solver/block_matrix.hpp"
#include "solver/linear/available_memory.hpp"
#include "solver/linear/node_geometry.hpp"
#include "solver/linear/products.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// fixed[k] != 0 marks an eliminated unknown (its value is known).
using Mask = std::vector<char>;

/// The lower triangle of the free part of a block matrix, by columns, as CHOLMOD and Eigen want it. `source[k]` is the
/// place of entry k in BlockMatrix::values, so that new values are a gather.
struct LowerTriangle {
  std::vector<int> unknown_of;  ///< index of each free unknown among all 3 #nodes
  std::vector<int> starts, rows;
  std::vector<std::size_t> source;
  int size() const { return static_cast<int>(unknown_of.size()); }
  void gather(const BlockMatrix& A, double* values) const;
};
LowerTriangle lower_triangle(const Pattern& pattern, const Mask& fixed);

enum class LinearStatus { done, not_positive_definite, singular, limit, out_of_memory };

/// One way to solve A x = b on the free unknowns: Cholesky and conjugate gradients where A is symmetric positive
/// definite, make_indefinite where it is symmetric, make_unsymmetric where it is neither.
class LinearSystem {
 public:
  virtual ~LinearSystem() = default;
  /// Takes the matrix; must be called before solve and again when the values change. Analyses the pattern when the mask
  /// differs from the one before. The matrix must outlive the calls of solve.
  virtual LinearStatus factor(const BlockMatrix& A, const Mask& fixed) = 0;
  /// Takes a matrix without numbers in the place of factor(), with the same duties; false where it is of no use, for
  /// instance as nothing was made of an earlier matrix that serves for this one.
  virtual bool take(const Products& /*A*/, const Mask& /*fixed*/) { return false; }
  /// x at free unknowns so that |b - A x| <= tolerance |b| there; 0 at the others.
  virtual LinearStatus solve(const Vector& b, double tolerance, Vector& x) = 0;
  /// The displacement (3 per node) that the next matrix belongs to; a help to solvers that keep what they made of an
  /// earlier one.
  virtual void place(const Vector& /*displacement*/) {}
  /// A vector that the next solution is likely near a multiple of; iterations start from the best sum of such multiples
  /// of it and of the last solutions of which something was expected.
  virtual void expect(const Vector& /*solution*/) {}
  /// Looks once more, where factor() has not, whether the matrix taken last is positive definite.
  virtual LinearStatus probe() { return LinearStatus::done; }
  /// True if a solution costs more the smaller its tolerance is.
  virtual bool iterative() const { return false; }
  virtual std::size_t factor_bytes() const = 0;
  /// Negative eigenvalues of the matrix factorised last (Sylvester's law of inertia); 0 unless made by make_indefinite.
  virtual long negative_pivots() const { return 0; }
  /// True if the determinant of the matrix factorised last is negative; only where made by make_unsymmetric.
  virtual bool negative_determinant() const { return false; }
  long iterations = 0;   ///< CG iterations so far, over all solves
  bool gave_up = false;  ///< CG missed its tolerance once, and Cholesky has taken over
};

/// Refuses, as out_of_memory, a factor larger than `memory` bytes: the system would rather end the whole program.
/// `pulse` is called between the analysis and the factorisation; an exception of its own ends both.
std::unique_ptr<LinearSystem> make_cholesky(int threads, std::size_t memory = available_memory(),
                                            std::function<void()> pulse = {});
/// `pulse` is called in each iteration; an exception of its own ends the solution.
std::unique_ptr<LinearSystem> make_conjugate_gradient(Preconditioner preconditioner, std::function<void()> pulse = {});
/// Conjugate gradients preconditioned by multigrid, with a pulse for each grid that is set up too.
std::unique_ptr<LinearSystem> make_multigrid(const NodeGeometry& geometry, std::function<void()> pulse = {});
/// L D L^T with pivots of order one and two, by MUMPS in the order of METIS; counts negative pivots and refuses a
/// singular matrix, but never an indefinite one.
std::unique_ptr<LinearSystem> make_indefinite(int threads, std::function<void()> pulse = {});
/// L U by MUMPS, for any matrix on the pattern.
std::unique_ptr<LinearSystem> make_unsymmetric(int threads, std::function<void()> pulse = {});

/// x from b by a factorisation and steps of refinement: `correct` adds A^-1 residual to x and is false where it cannot.
/// Round-off grows with the condition number; refinement wins it back unless the matrix is singular.
LinearStatus refine(const BlockMatrix& A, const std::vector<int>& unknown_of,
                    const std::function<bool(const Vector& residual, Vector& x)>& correct, const Vector& b,
                    double tolerance, Vector& x);

/// The system that the settings ask for. `automatic` factorises small systems, takes multigrid for larger solids, and
/// never factorises more than 600,000 unknowns. Up to that size conjugate gradients that miss their tolerance give way
/// to a factorisation, for good.
std::unique_ptr<LinearSystem> make_linear_system(const Settings& settings, const NodeGeometry& geometry);

}  // namespace msml::fe
