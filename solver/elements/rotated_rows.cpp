// SPDX-License-Identifier: GPL-3.0-or-later
// Sums blocks of rotated stiffness matrices.
#include "solver/elements/rotated_rows.hpp"

#include <tbb/parallel_for.h>

#include <cstring>

namespace msml::fe {
namespace {

using Four = double __attribute__((vector_size(32)));
using Two = double __attribute__((vector_size(16)));

constexpr int ahead = 64;  // parts that are asked for before they are needed, about those of a row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Four load(const double* from) {
  Four values;
  std::memcpy(&values, from, sizeof values);
  return values;
}

/// A block while it is summed, the part times I apart; the fourth numbers mean nothing.
struct Block {
  Four row[3] = {}, inner = {};

  /// Every product has a number of node a and one of node b, so that block (b, a) is the transpose to the last bit.
  void add(const double (&h)[4][4], int a, int b) {
    const Four A = load(h[a]), B = load(h[b]);
    const double ratio = h[0][3];
    for (int i = 0; i < 3; ++i) {
      row[i] += h[b][i] * A;
      row[i] += ratio * (h[a][i] * B);
    }
    inner += A * B;
  }
  void close() {
    const double diagonal = inner[0] + inner[1] + inner[2];
    row[0] += diagonal * Four{1, 0, 0, 0};
    row[1] += diagonal * Four{0, 1, 0, 0};
    row[2] += diagonal * Four{0, 0, 1, 0};
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

}  // namespace

RotatedRows::RotatedRows(PatternPtr pattern, const std::vector<int>& positions)
    : pattern_(std::move(pattern)),
      first_(pattern_->columns.size() + 1, 0),
      parts_(positions.size() / 4 * 3 + ahead, 0) {
  const auto off_diagonal = [](std::size_t k) { return k / 4 % 4 != k % 4; };
  for (std::size_t k = 0; k < positions.size(); ++k) first_[at(positions[k]) + 1] += off_diagonal(k);
  for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (off_diagonal(k)) parts_[at(next[at(positions[k])]++)] = static_cast<int>(k);
}

void RotatedRows::sum_row(int row, const RotatedTetrahedron* elements, double* out) const {
  const auto part_at = [&](int k) { return static_cast<unsigned>(parts_[at(k)]); };
  Block own;
  for (int p = pattern_->offsets[at(row)]; p < pattern_->offsets[at(row) + 1]; ++p) {
    if (p == pattern_->diagonal[at(row)]) continue;
    Block block;
    for (int k = first_[at(p)]; k < first_[at(p) + 1]; ++k) {
      const double* soon = elements[part_at(k + ahead) / 16].h[0];
      __builtin_prefetch(soon);
      __builtin_prefetch(soon + 8);
      const unsigned part = part_at(k);
      block.add(elements[part / 16].h, part / 4 % 4, part % 4);
    }
    block.close();
    block.write(out + 9 * at(p));
    for (int i = 0; i < 3; ++i) own.row[i] -= block.row[i];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) own.row[i][j] = own.row[j][i] = 0.5 * (own.row[i][j] + own.row[j][i]);
  own.write(out + 9 * at(pattern_->diagonal[at(row)]));
}

void RotatedRows::sum(const std::vector<RotatedTetrahedron>& elements, BlockMatrix& matrix) const {
  matrix.values.resize(9 * pattern_->columns.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, pattern_->nodes(), 128), [&](const auto& range) {
    for (int row = range.begin(); row < range.end(); ++row) sum_row(row, elements.data(), matrix.values.data());
  });
}

}  // namespace msml::fe
