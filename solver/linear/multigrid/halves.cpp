// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds blocks to half precision.
#include "solver/linear/multigrid/halves.hpp"

#include <cmath>

namespace msml::fe {

#ifdef __AVX512F__
void Halves::allocate(const Sparsity& sparsity) {
  set_zero(values_, 9 * sparsity.columns.size() + 16);
  scales_.assign(static_cast<std::size_t>(sparsity.rows()), 1);
}

void Halves::set_row(const Sparsity& sparsity, int r, const float* blocks) {
  constexpr int most = 14;  // the largest number of a row is below 2^15, half of what the format holds
  const auto row = static_cast<std::size_t>(r);
  const auto begin = static_cast<std::size_t>(sparsity.offsets[row]);
  const std::size_t count = static_cast<std::size_t>(sparsity.offsets[row + 1]) - begin;
  float largest = 0;
  for (std::size_t k = 0; k < 9 * count; ++k) largest = std::max(largest, std::abs(blocks[k]));
  const int exponent = std::isnormal(largest) ? most - std::ilogb(largest) : 0;
  scales_[row] = std::ldexp(1.0f, -exponent);
  const __m512 factor = _mm512_set1_ps(std::ldexp(1.0f, exponent));
  for (std::size_t p = 0; p < count; ++p) {
    const __m512 scaled = _mm512_mul_ps(_mm512_maskz_loadu_ps(0x1ff, blocks + 9 * p), factor);
    alignas(32) std::uint16_t block[16];
    _mm256_store_si256(reinterpret_cast<__m256i*>(block),
                       _mm512_maskz_cvtps_ph(0xffff, scaled, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
    std::copy_n(block, 9, values_.data() + 9 * (begin + p));
  }
}
#else
void Halves::allocate(const Sparsity&) {}
void Halves::set_row(const Sparsity&, int, const float*) {}
#endif

}  // namespace msml::fe
