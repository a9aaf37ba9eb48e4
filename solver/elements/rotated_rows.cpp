// SPDX-License-Identifier: GPL-3.0-or-later
// Sums blocks of rotated stiffness matrices.
#include "solver/elements/rotated_rows.hpp"

#include <tbb/parallel_for.h>

#include <cstring>

namespace msml::fe {
namespace {

using Four = double __attribute__((vector_size(32)));
using Two = double __attribute__((vector_size(16)));

constexpr std::size_t blocks = 16;  // of an element
constexpr int ahead = 48;           // parts that are asked for before they are needed, about those of a row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Three rows of a 3 x 3 matrix; the fourth numbers mean nothing.
struct Rows {
  Four row[3] = {};
  /// += a b^T.
  void add(const double* a, const double* b) {
    Four B;
    std::memcpy(&B, b, sizeof B);
    for (int i = 0; i < 3; ++i) row[i] += a[i] * B;
  }
  Rows transposed() const {
    const Four low = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);   // 00 10 01 11
    const Four high = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);  // 02 12
    return {{__builtin_shufflevector(low, row[2], 0, 1, 4, 7), __builtin_shufflevector(low, row[2], 2, 3, 5, 7),
             __builtin_shufflevector(high, row[2], 0, 1, 6, 7)}};
  }
  /// What is written behind a row is overwritten by the next one.
  void write(double* out) const {
    std::memcpy(out, &row[0], sizeof(Four));
    std::memcpy(out + 3, &row[1], sizeof(Four));
    const Two start = __builtin_shufflevector(row[2], row[2], 0, 1);
    std::memcpy(out + 6, &start, sizeof start);
    out[8] = row[2][2];
  }
};

/// A block while it is summed: D is gathered for as long as elements agree in what multiplies it.
struct Block {
  Rows values, D;
  double ratio = 0;
  bool begun = false;

  void add(const double (&h)[4][4], unsigned a, unsigned b) {
    if (h[a][3] != ratio) {
      if (begun) close();
      ratio = h[a][3];
    }
    begun = true;
    D.add(h[a], h[b]);
  }
  /// Adds D^T + ratio D + tr(D) I.
  void close() {
    const Rows turned = D.transposed();
    const double trace = D.row[0][0] + D.row[1][1] + D.row[2][2];
    for (int i = 0; i < 3; ++i) values.row[i] += turned.row[i] + ratio * D.row[i];
    values.row[0] += trace * Four{1, 0, 0, 0};
    values.row[1] += trace * Four{0, 1, 0, 0};
    values.row[2] += trace * Four{0, 0, 1, 0};
    D = {};
  }
};

}  // namespace

RotatedRows::RotatedRows(PatternPtr pattern, const std::vector<int>& positions)
    : pattern_(std::move(pattern)),
      elements_(positions.size() / blocks),
      first_(pattern_->columns.size() + 1, 0),
      parts_(12 * elements_.size() + ahead, 0) {
  const auto off_diagonal = [](std::size_t k) { return k % blocks / 4 != k % 4; };
  for (std::size_t k = 0; k < positions.size(); ++k) first_[at(positions[k]) + 1] += off_diagonal(k);
  for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (off_diagonal(k))
      parts_[at(next[at(positions[k])]++)] = static_cast<unsigned>(k / blocks * stride + 16 * (k % blocks / 4) + k % 4);
}

void RotatedRows::set(int first, int count, const Tensor<Lanes>& R, Lanes stiffness, Lanes ratio,
                      const Lanes (&gradients)[4][3]) {
  const Lanes size = root(stiffness);
  Lanes h[4][3];
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 3; ++i)
      h[a][i] = size * (R(i, 0) * gradients[a][0] + R(i, 1) * gradients[a][1] + R(i, 2) * gradients[a][2]);
  for (int a = 0; a < 4; a += 2) {
    Lanes entries[lanes] = {h[a][0], h[a][1], h[a][2], ratio, h[a + 1][0], h[a + 1][1], h[a + 1][2], ratio};
    transpose(entries);
    for (int e = 0; e < count; ++e) std::memcpy(elements_[at(first + e)].h[a], &entries[e], sizeof(Lanes));
  }
}

void RotatedRows::sum_row(int row, double* out) const {
  const int diagonal = pattern_->diagonal[at(row)];
  Rows own;
  for (int p = pattern_->offsets[at(row)]; p < pattern_->offsets[at(row) + 1]; ++p) {
    if (p == diagonal) continue;
    Block block;
    for (int k = first_[at(p)]; k < first_[at(p) + 1]; ++k) {
      const unsigned soon = parts_[at(k + ahead)], pair = parts_[at(k)] % stride;
      __builtin_prefetch(elements_[soon / stride].h[soon % stride / 16]);
      __builtin_prefetch(elements_[soon / stride].h[soon % 16]);
      block.add(elements_[parts_[at(k)] / stride].h, pair / 16, pair % 16);
    }
    block.close();
    block.values.write(out + 9 * at(p));
    for (int i = 0; i < 3; ++i) own.row[i] -= block.values.row[i];
  }
  const Rows turned = own.transposed();
  for (int i = 0; i < 3; ++i) own.row[i] = 0.5 * (own.row[i] + turned.row[i]);
  own.write(out + 9 * at(diagonal));
}

void RotatedRows::sum(BlockMatrix& matrix) const {
  matrix.values.resize(9 * pattern_->columns.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, pattern_->nodes(), 128), [&](const auto& range) {
    for (int row = range.begin(); row < range.end(); ++row) sum_row(row, matrix.values.data());
  });
}

}  // namespace msml::fe
