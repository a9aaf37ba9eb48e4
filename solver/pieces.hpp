// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over long vectors in pieces of fixed size, in parallel: sums do not depend on the number of threads.
#pragma once
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace msml::fe {

constexpr long short_piece = 1536, long_piece = 6144;  ///< numbers of a vector; three times a whole number

/// Calls body(k, first, last) for the pieces [first, last) of [0, size), which have the numbers k = 0, 1, ….
template <long piece = long_piece, class Body>
void for_pieces(long size, const Body& body) {
  if (size <= piece) return body(0, 0, size);
  tbb::parallel_for(0L, (size + piece - 1) / piece,
                    [&](long k) { body(k, k * piece, std::min(size, (k + 1) * piece)); });
}

/// The sum of body(first, last) over all pieces.
template <long piece = long_piece, class Body>
double sum_pieces(long size, const Body& body) {
  if (size <= piece) return body(0, size);
  std::vector<double> sums(static_cast<std::size_t>((size + piece - 1) / piece));
  for_pieces<piece>(size,
                    [&](long k, long first, long last) { sums[static_cast<std::size_t>(k)] = body(first, last); });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace msml::fe
