// SPDX-License-Identifier: GPL-3.0-or-later
// Sets the threads of OpenBLAS and OpenMP.
#include "solver/linear/blas_threads.hpp"

#include "solver/linear/versions.hpp"

extern "C" {
void openblas_set_num_threads(int threads);
char* openblas_get_config(void);
void omp_set_max_active_levels(int levels);
}

namespace msml::fe {
namespace {

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

BlasThreads::BlasThreads(int threads) : lock_(one_at_a_time()) {
  openblas_set_num_threads(threads);
  omp_set_max_active_levels(0);
}

BlasThreads::~BlasThreads() { openblas_set_num_threads(1); }

std::string openblas_version() { return openblas_get_config(); }

}  // namespace msml::fe
