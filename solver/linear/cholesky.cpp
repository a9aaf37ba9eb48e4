// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse Cholesky factorisation by CHOLMOD: analysed once per set of fixed unknowns, refactored for new values.
#include <cholmod.h>
#include <fmt/format.h>

#include "solver/linear/blas_threads.hpp"
#include "solver/linear/linear_system.hpp"
#include "solver/linear/versions.hpp"

namespace msml::fe {
namespace {

class Cholesky final : public LinearSystem {
 public:
  Cholesky(int threads, std::size_t memory, std::function<void()> pulse)
      : threads_(threads), memory_(memory), pulse_(std::move(pulse)) {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    common_.postorder = 1;
  }
  ~Cholesky() override {
    release();
    cholmod_finish(&common_);
  }
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  LinearStatus factor(const BlockMatrix& A, const Mask& fixed) override {
    matrix_ = &A;
    if (!factor_ || fixed != fixed_) {
      release();
      fixed_ = fixed;
      lower_ = lower_triangle(*A.pattern, fixed);
      values_.resize(lower_.source.size());
      if (lower_.size() == 0) return LinearStatus::done;
      cholmod_sparse view = sparse();
      const BlasThreads blas(1);
      factor_ = cholmod_analyze(&view, &common_);
      if (!factor_) return failure();
      if (factor_bytes() > memory_) {
        release();
        lower_ = {};
        std::vector<double>().swap(values_);
        return LinearStatus::out_of_memory;
      }
      large_ = common_.fl > 2e10;
      if (pulse_) pulse_();
    }
    const BlasThreads blas(large_ ? threads_ : 1);
    lower_.gather(A, values_.data());
    cholmod_sparse view = sparse();
    cholmod_factorize(&view, factor_, &common_);
    if (common_.status < 0) return failure();
    if (common_.status == CHOLMOD_NOT_POSDEF) return LinearStatus::not_positive_definite;
    return LinearStatus::done;
  }

  LinearStatus solve(const Vector& b, double tolerance, Vector& x) override {
    const auto correct = [this](const Vector& residual, Vector& sum) { return add_solution(residual, sum); };
    return refine(*matrix_, lower_.unknown_of, correct, b, tolerance, x);
  }

  std::size_t factor_bytes() const override {
    const std::size_t gathered = values_.size() * (sizeof(double) + sizeof(std::size_t) + sizeof(int)) +
                                 2 * static_cast<std::size_t>(lower_.size()) * sizeof(int);
    return gathered + (factor_ ? (factor_->is_super ? factor_->xsize : factor_->nzmax) * sizeof(double) : 0);
  }

 private:
  /// x += A^-1 residual on the free unknowns.
  bool add_solution(const Vector& residual, Vector& x) {
    const BlasThreads blas(1);
    std::vector<double> right(static_cast<std::size_t>(lower_.size()));
    for (std::size_t k = 0; k < right.size(); ++k) right[k] = residual[lower_.unknown_of[k]];
    cholmod_dense view{};
    view.nrow = view.nzmax = view.d = right.size();
    view.ncol = 1;
    view.x = right.data();
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &view, &common_);
    if (!solution) return false;
    const double* values = static_cast<const double*>(solution->x);
    for (std::size_t k = 0; k < right.size(); ++k) x[lower_.unknown_of[k]] += values[k];
    cholmod_free_dense(&solution, &common_);
    return true;
  }

  cholmod_sparse sparse() {
    cholmod_sparse view{};
    view.nrow = view.ncol = static_cast<std::size_t>(lower_.size());
    view.nzmax = values_.size();
    view.p = lower_.starts.data();
    view.i = lower_.rows.data();
    view.x = values_.data();
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    return view;
  }

  LinearStatus failure() const {
    return common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE ? LinearStatus::out_of_memory
                                                                                          : LinearStatus::singular;
  }

  void release() {
    if (factor_) cholmod_free_factor(&factor_, &common_);
    factor_ = nullptr;
  }

  int threads_;
  std::size_t memory_;
  std::function<void()> pulse_;
  bool large_ = false;  ///< enough operations that waking a second thread for each dense block pays
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  const BlockMatrix* matrix_ = nullptr;
  Mask fixed_;
  LowerTriangle lower_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<LinearSystem> make_cholesky(int threads, std::size_t memory, std::function<void()> pulse) {
  return std::make_unique<Cholesky>(threads, memory, std::move(pulse));
}

std::string suitesparse_version() {
  return fmt::format("{}.{}.{} (CHOLMOD {}.{}.{})", SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
                     SUITESPARSE_SUBSUB_VERSION, CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION);
}

}  // namespace msml::fe
