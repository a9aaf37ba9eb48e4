// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices with one 3 x 3 block (or one number) per pair of neighbouring nodes.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "solver/numbers.hpp"

namespace msml::fe {

using Vector = Eigen::VectorXd;                                   ///< 3 numbers per node, node after node
using Eight = std::array<double, 8>;                              ///< of one unknown the numbers of eight vectors
using Wide = double __attribute__((vector_size(sizeof(Eight))));  ///< the same in a register

/// Which nodes share an element. Symmetric, sorted, diagonal included.
struct Pattern {
  std::vector<int> offsets{0};  ///< #nodes + 1
  std::vector<int> columns;     ///< neighbours of node r: columns[offsets[r] .. offsets[r+1]), ascending
  std::vector<int> diagonal;    ///< position of block (r, r)
  int nodes() const { return static_cast<int>(diagonal.size()); }
  std::size_t bytes() const { return (offsets.size() + columns.size() + diagonal.size()) * sizeof(int); }
  /// Position of block (row, column), which must exist.
  int find(int row, int column) const;
};
using PatternPtr = std::shared_ptr<const Pattern>;

/// The pattern of a list of elements: `nodes` node numbers each, all below `count`; and of pairs of nodes beside them.
PatternPtr make_pattern(int count, const std::vector<int>& element_nodes, int nodes,
                        const std::vector<std::array<int, 2>>& links = {});

/// values[p] times the 3 x 3 identity is the block at position p.
struct ScalarMatrix {
  PatternPtr pattern;
  Numbers<double> values;
  explicit ScalarMatrix(PatternPtr p) : pattern(std::move(p)), values(pattern->columns.size(), 0.0) {}
};

/// values[9 p + 3 i + j] is entry (i, j) of the block at position p.
struct BlockMatrix {
  PatternPtr pattern;
  Numbers<double> values;
  explicit BlockMatrix(PatternPtr p) : pattern(std::move(p)) { set_zero(); }
  /// With room for `room` numbers only, until assign() or set_zero() is called.
  BlockMatrix(PatternPtr p, std::size_t room) : pattern(std::move(p)), values(room, 0.0) {}
  void set_zero();
  /// Becomes A + s M.
  void assign(const BlockMatrix& A, double s, const ScalarMatrix& M);
};

/// y = A x, in parallel over rows; the result does not depend on the number of threads.
void multiply(const BlockMatrix& A, const Vector& x, Vector& y);
/// The rows of nodes [first, last) alone; y has its size already.
void multiply(const BlockMatrix& A, int first, int last, const Vector& x, Vector& y);
/// y = s A x; and of eight vectors, where Y has the size of X.
void multiply(const ScalarMatrix& A, const Vector& x, Vector& y, double s = 1);
void multiply(const ScalarMatrix& A, const std::vector<Eight>& X, std::vector<Eight>& Y, double s);
/// The rows of nodes [first, last) alone; y has its size already.
void multiply(const ScalarMatrix& A, int first, int last, const Vector& x, Vector& y, double s);

/// A += s M on every block's diagonal.
void add(BlockMatrix& A, double s, const ScalarMatrix& M);
/// A += s B.
void add(BlockMatrix& A, double s, const BlockMatrix& B);

inline std::size_t bytes(const Vector& v) { return static_cast<std::size_t>(v.size()) * sizeof(double); }

/// x . y, summed in pieces of fixed size so that the result does not depend on the number of threads.
double dot(const Vector& x, const Vector& y);

}  // namespace msml::fe
