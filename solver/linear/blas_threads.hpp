// SPDX-License-Identifier: GPL-3.0-or-later
// The number of threads in dense kernels, and who may factorise.
#pragma once
#include <mutex>

namespace msml::fe {

/// OpenBLAS has as many threads as asked for while an object lives, and one elsewhere. The setting belongs to the
/// process, so one factorisation runs at a time. CHOLMOD's own OpenMP loops, which ask for four threads wherever they
/// run and spend more time waking them than working, run in the calling thread.
class BlasThreads {
 public:
  explicit BlasThreads(int threads);
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
};

}  // namespace msml::fe
