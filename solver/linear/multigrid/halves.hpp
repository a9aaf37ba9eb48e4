// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse matrices of 3 x 3 blocks in half precision.
#pragma once
#include <cstdint>

#include "solver/linear/multigrid/blocks.hpp"

namespace msml::fe {

/// The numbers of a matrix with eleven binary digits (IEEE 754 binary16), half as many bytes to read for a smoother
/// that is bound by memory. Each row has a power of two in front, so that numbers down to 4e-9 of its largest one keep
/// all digits. Made only where the processor widens halves (AVX-512); stays empty elsewhere.
class Halves {
 public:
  /// Makes room, where the processor widens halves.
  void allocate(const Sparsity& sparsity);
  /// Takes the blocks of row r, nine numbers each.
  void set_row(const Sparsity& sparsity, int r, const float* blocks);
  void clear() { *this = {}; }
  bool empty() const { return values_.empty(); }
  std::size_t bytes() const { return values_.size() * sizeof(values_[0]) + scales_.size() * sizeof(float); }
  /// Row r of A x: three numbers and one more.
  Single4 row_product(const Sparsity& sparsity, int r, const float* x) const;

 private:
  Numbers<std::uint16_t> values_;  ///< 9 for each block, as Blocks has them, and a few more
  std::vector<float> scales_;      ///< of each row
};

#ifdef __AVX512F__
inline Single4 Halves::row_product(const Sparsity& sparsity, int r, const float* x) const {
  const auto times = [&](int p, __m512 sum) {
    const std::uint16_t* block = values_.data() + 9 * static_cast<std::size_t>(p);
    const __m512 a = _mm512_maskz_cvtph_ps(0xffff, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(block)));
    return _mm512_fmadd_ps(a, spread_columns(x + 3 * sparsity.columns[static_cast<std::size_t>(p)]), sum);
  };
  return scales_[static_cast<std::size_t>(r)] * sum_of_columns(sparsity, r, times);
}
#else
inline Single4 Halves::row_product(const Sparsity&, int, const float*) const { return Single4{}; }
#endif

}  // namespace msml::fe
