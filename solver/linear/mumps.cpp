// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse factorisations with pivoting by MUMPS: symmetric indefinite and unsymmetric matrices.
#include <dmumps_c.h>
#include <metis.h>

#include <algorithm>

#include "solver/linear/blas_threads.hpp"
#include "solver/linear/linear_system.hpp"
#include "solver/linear/versions.hpp"

namespace msml::fe {
namespace {

/// Entries of the free part in coordinates from 1; of a symmetric matrix the lower triangle.
struct Entries {
  std::vector<int> unknown_of, rows, columns;
  std::vector<std::size_t> source;  ///< places in BlockMatrix::values
  std::vector<int> order;           ///< place of each free unknown in the elimination, from 1
  int size() const { return static_cast<int>(unknown_of.size()); }
};

/// The fill-reducing order of the nodes by nested dissection. An additional node for a pressure has the neighbours of
/// its corner node, and METIS keeps such nodes together, so that pivots of order two are found inside a front.
std::vector<int> order_nodes(const Pattern& pattern) {
  idx_t nodes = pattern.nodes();
  std::vector<idx_t> starts{0}, neighbours, order(static_cast<std::size_t>(nodes)), place(order.size());
  for (idx_t n = 0; n < nodes; ++n) {
    const auto row = static_cast<std::size_t>(n);
    for (int p = pattern.offsets[row]; p < pattern.offsets[row + 1]; ++p)
      if (pattern.columns[static_cast<std::size_t>(p)] != n)
        neighbours.push_back(pattern.columns[static_cast<std::size_t>(p)]);
    starts.push_back(static_cast<idx_t>(neighbours.size()));
  }
  if (nodes < 2 || neighbours.empty() ||
      METIS_NodeND(&nodes, starts.data(), neighbours.data(), nullptr, nullptr, order.data(), place.data()) != METIS_OK)
    for (idx_t n = 0; n < nodes; ++n) order[static_cast<std::size_t>(n)] = n;
  return {order.begin(), order.end()};
}

Entries make_entries(const Pattern& pattern, const Mask& fixed, bool symmetric) {
  Entries entries;
  std::vector<int> number(fixed.size(), 0);
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (!fixed[k]) {
      entries.unknown_of.push_back(static_cast<int>(k));
      number[k] = entries.size();
    }
  for (const int unknown : entries.unknown_of) {
    const std::size_t node = static_cast<std::size_t>(unknown / 3);
    for (int p = pattern.offsets[node]; p < pattern.offsets[node + 1]; ++p)
      for (int j = 0; j < 3; ++j) {
        const int other = 3 * pattern.columns[static_cast<std::size_t>(p)] + j;
        const int row = number[static_cast<std::size_t>(unknown)], column = number[static_cast<std::size_t>(other)];
        if (column == 0 || (symmetric && column > row)) continue;
        entries.rows.push_back(row);
        entries.columns.push_back(column);
        entries.source.push_back(9 * static_cast<std::size_t>(p) + static_cast<std::size_t>(3 * (unknown % 3) + j));
      }
  }
  int next = 0;
  entries.order.resize(entries.unknown_of.size());
  for (const int node : order_nodes(pattern))
    for (int i = 0; i < 3; ++i)
      if (const int k = number[static_cast<std::size_t>(3 * node + i)]; k > 0)
        entries.order[static_cast<std::size_t>(k - 1)] = ++next;
  return entries;
}

class Mumps final : public LinearSystem {
 public:
  Mumps(bool symmetric, int threads, std::function<void()> pulse)
      : symmetric_(symmetric), threads_(threads), pulse_(std::move(pulse)) {}
  ~Mumps() override { release(); }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  LinearStatus factor(const BlockMatrix& A, const Mask& fixed) override {
    matrix_ = &A;
    if (!ready_ || fixed != fixed_) {
      const LinearStatus status = analyse(*A.pattern, fixed);
      if (status != LinearStatus::done) return status;
      if (pulse_) pulse_();
    }
    if (entries_.size() == 0) return LinearStatus::done;
    const BlasThreads blas(large_ ? threads_ : 1);
    values_.resize(entries_.source.size());
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = A.values[entries_.source[k]];
    data_.a = values_.data();
    data_.job = 2;
    // Pivots that are put off need more room than the analysis foresaw.
    for (data_.icntl[13] = 30; data_.icntl[13] <= 2000; data_.icntl[13] *= 2) {
      dmumps_c(&data_);
      if (data_.infog[0] != -8 && data_.infog[0] != -9) break;
    }
    return status();
  }

  LinearStatus solve(const Vector& b, double tolerance, Vector& x) override {
    const auto correct = [this](const Vector& residual, Vector& sum) { return add_solution(residual, sum); };
    return refine(*matrix_, entries_.unknown_of, correct, b, tolerance, x);
  }

  std::size_t factor_bytes() const override {
    if (!ready_) return 0;
    const double entries = data_.infog[28] < 0 ? -1e6 * data_.infog[28] : data_.infog[28];
    return static_cast<std::size_t>(entries) * sizeof(double);
  }

  bool negative_determinant() const override { return ready_ && !symmetric_ && data_.rinfog[11] < 0; }

  long negative_pivots() const override { return ready_ && symmetric_ ? data_.infog[11] : 0; }

 private:
  LinearStatus analyse(const Pattern& pattern, const Mask& fixed) {
    release();
    fixed_ = fixed;
    entries_ = make_entries(pattern, fixed, symmetric_);
    if (entries_.size() == 0) return LinearStatus::done;
    const BlasThreads blas(1);
    data_ = {};
    data_.sym = symmetric_ ? 2 : 0;
    data_.par = 1;
    data_.comm_fortran = -987654;  // MPI_COMM_WORLD of the sequential library
    data_.job = -1;
    dmumps_c(&data_);
    if (data_.infog[0] < 0) return status();
    ready_ = true;
    for (int stream = 0; stream < 3; ++stream) data_.icntl[stream] = -1;
    data_.icntl[3] = 0;                    // silence
    data_.icntl[5] = 0;                    // no permutation to a large diagonal: it would undo the symmetric pattern
    data_.icntl[6] = 1;                    // the order below
    data_.icntl[12] = 1;                   // count every pivot
    data_.icntl[23] = 1;                   // find null pivots
    data_.icntl[32] = symmetric_ ? 0 : 1;  // the determinant
    data_.n = entries_.size();
    data_.nnz = static_cast<MUMPS_INT8>(entries_.rows.size());
    data_.irn = entries_.rows.data();
    data_.jcn = entries_.columns.data();
    data_.perm_in = entries_.order.data();
    data_.job = 1;
    dmumps_c(&data_);
    large_ = data_.rinfog[0] > 2e10;
    return status();
  }

  /// x += A^-1 residual on the free unknowns.
  bool add_solution(const Vector& residual, Vector& x) {
    const BlasThreads blas(1);
    std::vector<double> right(entries_.unknown_of.size());
    for (std::size_t k = 0; k < right.size(); ++k) right[k] = residual[entries_.unknown_of[k]];
    data_.rhs = right.data();
    data_.nrhs = 1;
    data_.lrhs = data_.n;
    data_.job = 3;
    dmumps_c(&data_);
    if (data_.infog[0] < 0) return false;
    for (std::size_t k = 0; k < right.size(); ++k) x[entries_.unknown_of[k]] += right[k];
    return true;
  }

  LinearStatus status() const {
    const int code = data_.infog[0];
    if (code == -6 || code == -10 || (code >= 0 && data_.infog[27] > 0)) return LinearStatus::singular;
    return code < 0 ? LinearStatus::out_of_memory : LinearStatus::done;
  }

  void release() {
    if (!ready_) return;
    const BlasThreads blas(1);
    data_.job = -2;
    dmumps_c(&data_);
    ready_ = false;
  }

  bool symmetric_;
  int threads_;
  std::function<void()> pulse_;
  bool ready_ = false;
  bool large_ = false;  ///< enough operations that waking a second thread for each dense block pays
  DMUMPS_STRUC_C data_{};
  const BlockMatrix* matrix_ = nullptr;
  Mask fixed_;
  Entries entries_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<LinearSystem> make_indefinite(int threads, std::function<void()> pulse) {
  return std::make_unique<Mumps>(true, threads, std::move(pulse));
}

std::unique_ptr<LinearSystem> make_unsymmetric(int threads, std::function<void()> pulse) {
  return std::make_unique<Mumps>(false, threads, std::move(pulse));
}

std::string mumps_version() { return MUMPS_VERSION; }

}  // namespace msml::fe
