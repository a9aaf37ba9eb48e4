// SPDX-License-Identifier: GPL-3.0-or-later
// Products and sums of block matrices in parallel.
#include "solver/block_matrix.hpp"

#include <algorithm>
#include <cstring>

#include "solver/pieces.hpp"

namespace msml::fe {
namespace {

using Range = tbb::blocked_range<std::size_t>;

template <class Body>
void for_rows(int rows, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, rows, 256), [&](const tbb::blocked_range<int>& range) {
    for (int r = range.begin(); r < range.end(); ++r) body(r);
  });
}

}  // namespace

int Pattern::find(int row, int column) const {
  const auto first = columns.begin() + offsets[static_cast<std::size_t>(row)];
  const auto last = columns.begin() + offsets[static_cast<std::size_t>(row) + 1];
  return static_cast<int>(std::lower_bound(first, last, column) - columns.begin());
}

namespace {

/// The elements of each node: of[first[n]], …, of[first[n + 1] - 1].
struct ElementsOfNodes {
  std::vector<int> first, of;
};

ElementsOfNodes elements_of_nodes(int count, const std::vector<int>& element_nodes, int nodes) {
  ElementsOfNodes list{std::vector<int>(static_cast<std::size_t>(count) + 1, 0),
                       std::vector<int>(element_nodes.size())};
  for (const int node : element_nodes) ++list.first[static_cast<std::size_t>(node) + 1];
  for (std::size_t i = 1; i < list.first.size(); ++i) list.first[i] += list.first[i - 1];
  std::vector<int> fill(list.first.begin(), list.first.end() - 1);
  for (std::size_t k = 0; k < element_nodes.size(); ++k)
    list.of[static_cast<std::size_t>(fill[static_cast<std::size_t>(element_nodes[k])]++)] = static_cast<int>(k) / nodes;
  return list;
}

/// Columns of a run of rows, one row after the other, and how many each has.
struct Rows {
  std::vector<int> columns, sizes;
};

}  // namespace

PatternPtr make_pattern(int count, const std::vector<int>& element_nodes, int nodes,
                        const std::vector<std::array<int, 2>>& links) {
  const ElementsOfNodes elements = elements_of_nodes(count, element_nodes, nodes);
  std::vector<std::array<int, 2>> linked;  // row, column
  for (const auto& [a, b] : links) linked.insert(linked.end(), {{a, b}, {b, a}});
  std::sort(linked.begin(), linked.end());
  constexpr int piece = 2048;
  std::vector<Rows> pieces(static_cast<std::size_t>((count + piece - 1) / piece));
  tbb::parallel_for(std::size_t(0), pieces.size(), [&](std::size_t k) {
    Rows& rows = pieces[k];
    std::vector<int> row;
    const int begin = static_cast<int>(k) * piece;
    for (int r = begin; r < std::min(count, begin + piece); ++r) {
      row.assign(1, r);
      for (int i = elements.first[static_cast<std::size_t>(r)]; i < elements.first[static_cast<std::size_t>(r) + 1];
           ++i) {
        const auto e = element_nodes.begin() + static_cast<long>(elements.of[static_cast<std::size_t>(i)]) * nodes;
        row.insert(row.end(), e, e + nodes);
      }
      for (auto link = std::lower_bound(linked.begin(), linked.end(), std::array<int, 2>{r, 0});
           link != linked.end() && (*link)[0] == r; ++link)
        row.push_back((*link)[1]);
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
      rows.columns.insert(rows.columns.end(), row.begin(), row.end());
      rows.sizes.push_back(static_cast<int>(row.size()));
    }
  });
  auto pattern = std::make_shared<Pattern>();
  pattern->offsets.reserve(static_cast<std::size_t>(count) + 1);
  std::size_t all = 0;
  for (const Rows& rows : pieces) all += rows.columns.size();
  pattern->columns.reserve(all);
  for (Rows& rows : pieces) {
    pattern->columns.insert(pattern->columns.end(), rows.columns.begin(), rows.columns.end());
    for (const int size : rows.sizes) pattern->offsets.push_back(pattern->offsets.back() + size);
    rows = {};
  }
  pattern->diagonal.reserve(static_cast<std::size_t>(count));
  for (int r = 0; r < count; ++r) pattern->diagonal.push_back(pattern->find(r, r));
  return pattern;
}

void BlockMatrix::set_zero() { fe::set_zero(values, 9 * pattern->columns.size()); }

void BlockMatrix::assign(const BlockMatrix& A, double s, const ScalarMatrix& M) {
  values.resize(A.values.size());
  tbb::parallel_for(Range(0, M.values.size(), 1 << 13), [&](const Range& range) {
    for (std::size_t p = range.begin(); p < range.end(); ++p) {
      for (std::size_t k = 0; k < 9; ++k) values[9 * p + k] = A.values[9 * p + k];
      for (std::size_t i = 0; i < 3; ++i) values[9 * p + 4 * i] += s * M.values[p];
    }
  });
}

namespace {

using Four = double __attribute__((vector_size(32)));

Four four(const double* from) {
  Four values;
  std::memcpy(&values, from, sizeof values);
  return values;
}

/// Blocks [first, last) of a row; reads one number behind each block and behind each node's three.
void multiply_row(const BlockMatrix& A, int first, int last, const double* x, double* y) {
  Four s0{}, s1{}, s2{};
  for (int p = first; p < last; ++p) {
    const double* a = A.values.data() + 9 * static_cast<std::size_t>(p);
    const Four v = four(x + 3 * A.pattern->columns[static_cast<std::size_t>(p)]);
    s0 += four(a) * v;
    s1 += four(a + 3) * v;
    s2 += four(a + 6) * v;
  }
  y[0] = s0[0] + s0[1] + s0[2], y[1] = s1[0] + s1[1] + s1[2], y[2] = s2[0] + s2[1] + s2[2];
}

/// The same, reading nothing beyond.
void multiply_last_row(const BlockMatrix& A, int first, int last, const double* x, double* y) {
  double s0 = 0, s1 = 0, s2 = 0;
  for (int p = first; p < last; ++p) {
    const double* a = A.values.data() + 9 * static_cast<std::size_t>(p);
    const double* v = x + 3 * A.pattern->columns[static_cast<std::size_t>(p)];
    s0 += a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
    s1 += a[3] * v[0] + a[4] * v[1] + a[5] * v[2];
    s2 += a[6] * v[0] + a[7] * v[1] + a[8] * v[2];
  }
  y[0] = s0, y[1] = s1, y[2] = s2;
}

}  // namespace

void multiply(const BlockMatrix& A, int first, int last, const Vector& x, Vector& y) {
  const Pattern& pattern = *A.pattern;
  const int end = pattern.nodes() - 1;
  for (int r = first; r < last; ++r) {
    const int begin = pattern.offsets[static_cast<std::size_t>(r)];
    const int stop = pattern.offsets[static_cast<std::size_t>(r) + 1];
    if (pattern.columns[static_cast<std::size_t>(stop) - 1] == end)
      multiply_last_row(A, begin, stop, x.data(), y.data() + 3 * r);
    else
      multiply_row(A, begin, stop, x.data(), y.data() + 3 * r);
  }
}

void multiply(const BlockMatrix& A, const Vector& x, Vector& y) {
  y.resize(x.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, A.pattern->nodes(), 256),
                    [&](const tbb::blocked_range<int>& range) { multiply(A, range.begin(), range.end(), x, y); });
}

namespace {

/// s times the sum of a_p v(p) over row r; two sums, so that one need not wait for the other.
template <class Sum, class Read>
Sum scalar_row(const ScalarMatrix& A, int r, double s, const Read& v) {
  const int* columns = A.pattern->columns.data();
  Sum even{}, odd{};
  int p = A.pattern->offsets[static_cast<std::size_t>(r)];
  const int end = A.pattern->offsets[static_cast<std::size_t>(r) + 1];
  const double* a = A.values.data();
  for (; p + 1 < end; p += 2) even.add(a[p], v(columns[p])), odd.add(a[p + 1], v(columns[p + 1]));
  if (p < end) even.add(a[p], v(columns[p]));
  even.add(1, odd);
  Sum sum{};
  sum.add(s, even);
  return sum;
}

/// `count` vectors abreast.
template <class T, int count>
struct Vectors {
  T v[count];
  void add(double a, const Vectors& other) {
    for (int i = 0; i < count; ++i) v[i] += a * other.v[i];
  }
};

}  // namespace

void multiply(const ScalarMatrix& A, int first, int last, const Vector& x, Vector& y, double s) {
  using One = Vectors<Four, 1>;
  const int end = A.pattern->nodes() - 1;
  const auto read = [&](int node) {
    const double* v = x.data() + 3 * node;
    return node < end ? One{four(v)} : One{Four{v[0], v[1], v[2], 0}};  // nothing is behind the last one
  };
  for (int r = first; r < last; ++r) {
    const One sum = scalar_row<One>(A, r, s, read);
    for (int i = 0; i < 3; ++i) y[3 * r + i] = sum.v[0][i];
  }
}

void multiply(const ScalarMatrix& A, const Vector& x, Vector& y, double s) {
  y.resize(x.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, A.pattern->nodes(), 256),
                    [&](const auto& range) { multiply(A, range.begin(), range.end(), x, y, s); });
}

void multiply(const ScalarMatrix& A, const std::vector<Eight>& X, std::vector<Eight>& Y, double s) {
  using Three = Vectors<Wide, 3>;
  for_rows(A.pattern->nodes(), [&](int r) {
    const Three sums = scalar_row<Three>(A, r, s, [&](int node) {
      Three v;
      std::memcpy(&v, &X[3 * static_cast<std::size_t>(node)], sizeof v);
      return v;
    });
    std::memcpy(&Y[3 * static_cast<std::size_t>(r)], &sums, sizeof sums);
  });
}

void add(BlockMatrix& A, double s, const ScalarMatrix& M) {
  tbb::parallel_for(Range(0, M.values.size(), 1 << 14), [&](const Range& range) {
    for (std::size_t p = range.begin(); p < range.end(); ++p)
      for (int i = 0; i < 3; ++i) A.values[9 * p + 4 * static_cast<std::size_t>(i)] += s * M.values[p];
  });
}

void add(BlockMatrix& A, double s, const BlockMatrix& B) {
  tbb::parallel_for(Range(0, A.values.size(), 1 << 16), [&](const Range& range) {
    for (std::size_t p = range.begin(); p < range.end(); ++p) A.values[p] += s * B.values[p];
  });
}

double dot(const Vector& x, const Vector& y) {
  return sum_pieces(x.size(), [&](long first, long last) {
    return x.segment(first, last - first).dot(y.segment(first, last - first));
  });
}

}  // namespace msml::fe
