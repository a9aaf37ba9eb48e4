// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over long vectors in pieces of fixed size, in parallel: sums do not depend on the number of threads.
#pragma once
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace msml::fe {

constexpr long piece_of_vector = 6144;  ///< numbers; a multiple of 3

/// Calls body(k, first, last) for the pieces [first, last) of [0, size), which have the numbers k = 0, 1, ….
template <class Body>
void for_pieces(long size, const Body& body) {
  if (size <= piece_of_vector) return body(0, 0, size);
  tbb::parallel_for(0L, (size + piece_of_vector - 1) / piece_of_vector, [&](long k) {
    body(k, k * piece_of_vector, std::min(size, (k + 1) * piece_of_vector));
  });
}

/// The sum of body(first, last) over all pieces.
template <class Body>
double sum_pieces(long size, const Body& body) {
  if (size <= piece_of_vector) return body(0, size);
  std::vector<double> sums(static_cast<std::size_t>((size + piece_of_vector - 1) / piece_of_vector));
  for_pieces(size, [&](long k, long first, long last) { sums[static_cast<std::size_t>(k)] = body(first, last); });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace msml::fe
