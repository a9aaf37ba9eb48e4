// SPDX-License-Identifier: GPL-3.0-or-later
// Sets the threads of OpenBLAS and OpenMP.
#include "solver/linear/blas_threads.hpp"

#include <sys/mman.h>

#include <new>

#include "msml/core/address_space.hpp"
#include "solver/linear/versions.hpp"

extern "C" {
void openblas_set_num_threads(int threads);
char* openblas_get_config(void);
void omp_set_max_active_levels(int levels);
void dsyrk_(const char* part, const char* transposed, const int* n, const int* k, const double* alpha, const double* a,
            const int* a_rows, const double* beta, double* c, const int* c_rows);
}

namespace msml::fe {
namespace {

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

/// The first product takes a buffer of 128 MB that later ones use again. OpenBLAS would wait for it without end: throws
/// std::bad_alloc where there is none to be had.
bool take_buffer() {
  constexpr std::size_t size = std::size_t{144} << 20;
  void* place = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  ::munmap(place, size);
  const int one = 1;
  const double a = 1, b = 0;
  double c = 0;
  dsyrk_("L", "N", &one, &one, &a, &a, &one, &b, &c, &one);
  return true;
}

}  // namespace

BlasThreads::BlasThreads(int threads) : lock_(one_at_a_time()) {
  openblas_set_num_threads(address_space_is_limited() ? 1 : threads);
  [[maybe_unused]] static const bool taken = take_buffer();
  omp_set_max_active_levels(0);
}

BlasThreads::~BlasThreads() { openblas_set_num_threads(1); }

std::string openblas_version() { return openblas_get_config(); }

}  // namespace msml::fe
