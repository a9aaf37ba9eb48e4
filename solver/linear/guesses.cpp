// SPDX-License-Identifier: GPL-3.0-or-later
// Projection of a right-hand side on the images of a few vectors.
#include "solver/linear/guesses.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <cstring>
#include <utility>

#include "solver/pieces.hpp"

namespace msml::fe {
namespace {

constexpr int piece = 256;  // rows of one sum

Wide wide(const Eight& from) {
  Wide values;
  std::memcpy(&values, &from, sizeof values);
  return values;
}

using Square = Eigen::Matrix<double, 8, 8>;
using Few = Eigen::Matrix<double, 8, 1>;

/// X^T A X and X^T b.
struct Projected {
  Wide energies[8] = {}, works = {};
  Projected& operator+=(const Projected& other) {
    for (int i = 0; i < 8; ++i) energies[i] += other.energies[i];
    works += other.works;
    return *this;
  }
};

/// The coefficients c with X^T A X c = X^T b, without directions that round-off makes of dependent vectors.
Wide coefficients(const Projected& sum) {
  constexpr double dependent = 1e-12;
  Square G;
  Few w, scale;
  for (int i = 0; i < 8; ++i) scale[i] = sum.energies[i][i] > 0 ? 1 / std::sqrt(sum.energies[i][i]) : 0;
  for (int i = 0; i < 8; ++i) {
    w[i] = scale[i] * sum.works[i];
    for (int j = 0; j < 8; ++j) G(i, j) = scale[i] * scale[j] * sum.energies[i][j];
  }
  if (!G.allFinite() || !w.allFinite()) return Wide{};
  const Eigen::SelfAdjointEigenSolver<Square> modes(G);
  Few shares = modes.eigenvectors().transpose() * w;
  for (int k = 0; k < 8; ++k) shares[k] *= modes.eigenvalues()[k] > dependent ? 1 / modes.eigenvalues()[k] : 0;
  const Few c = scale.cwiseProduct(modes.eigenvectors() * shares);
  return c.allFinite() ? Wide{c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]} : Wide{};
}

double sum_of(const Wide& v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

/// Row `row` of A X.
void multiply_row(const BlockMatrix& A, int row, const std::vector<Eight>& X, Wide (&image)[3]) {
  const Pattern& pattern = *A.pattern;
  for (int p = pattern.offsets[static_cast<std::size_t>(row)]; p < pattern.offsets[static_cast<std::size_t>(row) + 1];
       ++p) {
    const double* a = A.values.data() + 9 * static_cast<std::size_t>(p);
    const Eight* v = &X[3 * static_cast<std::size_t>(pattern.columns[static_cast<std::size_t>(p)])];
    for (int i = 0; i < 3; ++i)
      image[i] += a[3 * i] * wide(v[0]) + a[3 * i + 1] * wide(v[1]) + a[3 * i + 2] * wide(v[2]);
  }
}

/// Rows [first, last) of A X, zero at fixed unknowns, and their share of X^T A X and X^T b. Where A has no numbers, AX
/// holds the products already.
Projected project_rows(const BlockMatrix* A, const Mask& fixed, const Vector& b, const std::vector<Eight>& X, int first,
                       int last, std::vector<Eight>& AX) {
  Projected sum;
  for (int row = first; row < last; ++row) {
    const std::size_t begin = 3 * static_cast<std::size_t>(row);
    Wide image[3] = {};
    if (A)
      multiply_row(*A, row, X, image);
    else
      std::memcpy(image, &AX[begin], sizeof image);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t unknown = begin + i;
      if (fixed[unknown]) image[i] = Wide{};
      std::memcpy(&AX[unknown], &image[i], sizeof(Wide));
      for (std::size_t j = 0; j < 8; ++j) sum.energies[j] += X[unknown][j] * image[i];
      sum.works += b[static_cast<Eigen::Index>(unknown)] * wide(X[unknown]);
    }
  }
  return sum;
}

}  // namespace

void zero_fixed(const Mask& fixed, Vector& v) {
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, v.size(), 8192), [&](const auto& range) {
    for (Eigen::Index k = range.begin(); k < range.end(); ++k)
      if (fixed[static_cast<std::size_t>(k)]) v[k] = 0;
  });
}

void Guesses::start(const SystemMatrix& A, const Mask& fixed, const Vector& b, Vector& r, Vector& x) {
  started_ = likely_.size() == b.size();
  r = b;
  x = Vector::Zero(b.size());
  if (!started_) return;
  span_.resize(fixed.size());
  image_.resize(fixed.size());
  for_pieces(b.size(), [&](long, long first, long last) {
    for (long k = first; k < last; ++k) span_[static_cast<std::size_t>(k)][0] = likely_[k];
  });
  likely_.resize(0);
  for (std::size_t k = 0; k < fixed.size(); ++k)
    if (fixed[k]) span_[k] = {};
  if (!A.numbers) A.products->multiply(span_, image_);
  const int rows = static_cast<int>(fixed.size() / 3), pieces = (rows + piece - 1) / piece;
  std::vector<Projected> parts(static_cast<std::size_t>(pieces));
  tbb::parallel_for(0, pieces, [&](int k) {
    parts[static_cast<std::size_t>(k)] =
        project_rows(A.numbers, fixed, b, span_, k * piece, std::min(rows, (k + 1) * piece), image_);
  });
  Projected sum;
  for (const Projected& part : parts) sum += part;
  const Wide c = coefficients(sum);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, span_.size(), 4096), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      x[static_cast<Eigen::Index>(k)] = sum_of(c * wide(span_[k]));
      r[static_cast<Eigen::Index>(k)] -= sum_of(c * wide(image_[k]));
    }
  });
}

void Guesses::keep(const Vector& x) {
  if (!std::exchange(started_, false)) return;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, span_.size(), 4096), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      Eight& group = span_[k];
      for (std::size_t j = group.size() - 1; j > 1; --j) group[j] = group[j - 1];
      group[1] = x[static_cast<Eigen::Index>(k)];
    }
  });
}

}  // namespace msml::fe
