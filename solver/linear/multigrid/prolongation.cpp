// SPDX-License-Identifier: GPL-3.0-or-later
// Projected conjugate gradients on prolongations.
#include "solver/linear/multigrid/prolongation.hpp"

#include <Eigen/Cholesky>
#include <numeric>

namespace msml::fe {
namespace {

constexpr int piece = 128;  // rows of one task

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A row of a block with C columns, and padding.
template <int C>
struct BlockRow {
  Column<C> v{};
};

double dot(const Column<3>& a, const Column<3>& b) {
  const Column<3> c = a * b;
  return static_cast<double>(c[0] + c[1] + c[2]);
}
double dot(const Column<6>& a, const Column<6>& b) {
  const Column<6> c = a * b;
  return static_cast<double>((c[0] + c[1] + c[2]) + (c[3] + c[4] + c[5]));
}

/// The rows of a block.
template <int B, int C>
void read(const float* block, BlockRow<C>* rows) {
  for (int i = 0; i < B; ++i)
    for (int j = 0; j < C; ++j) rows[i].v[j] = block[B * j + i];
}
template <int B, int C>
void add(float factor, const BlockRow<C>* rows, float* block) {
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < B; ++i) block[B * j + i] += factor * rows[i].v[j];
}

/// Blocks of B rows at the positions of a sparsity.
template <int B, int C>
class Columns {
 public:
  using Room = std::vector<BlockRow<C>>;

  Columns(const Blocks<float, B, B>& A, const std::vector<double>& inverse, const Modes& modes,
          const Sparsity& sparsity)
      : A_(A), inverse_(inverse), modes_(modes), sparsity_(sparsity), places_(places_of(sparsity)) {
    set_grams(modes);
  }
  Room room() const { return Room(B * sparsity_.columns.size()); }
  int rows() const { return sparsity_.rows(); }
  int first(int n) const { return sparsity_.offsets[at(n)]; }
  int end(int n) const { return sparsity_.offsets[at(n) + 1]; }

  /// Row n of A X, without what would change the modes.
  void multiply(int n, const Room& X, Room& out) const {
    std::vector<int>& place = places_.local();
    note_places(sparsity_, n, first(n), place);
    const Sparsity& left = A_.sparsity;
    for (int p = first(n); p < end(n); ++p)
      for (int i = 0; i < B; ++i) out[B * at(p) + at(i)].v = Column<C>{};
    for (int p = left.offsets[at(n)]; p < left.offsets[at(n) + 1]; ++p) {
      const float* a = A_.block(p);
      const int k = left.columns[at(p)];
      for (int q = first(k); q < end(k); ++q) {
        const int position = place[at(sparsity_.columns[at(q)])];
        if (position < 0) continue;
        const BlockRow<C>* b = &X[B * at(q)];
        BlockRow<C>* c = &out[B * at(position)];
        for (int i = 0; i < B; ++i) {
          Column<C> sum = c[i].v;
          for (int m = 0; m < B; ++m) sum += a[B * m + i] * b[m].v;
          c[i].v = sum;
        }
      }
    }
    for (int p = first(n); p < end(n); ++p) place[at(sparsity_.columns[at(p)])] = -1;
    project(n, out);
  }

  /// The inner product of row n of G and D G, where D is the inverse of A's diagonal.
  double preconditioned(int n, const Room& G) const {
    double sum = 0;
    for_preconditioned(n, G, [&](std::size_t k, const Column<C>& z) { sum += dot(G[k].v, z); });
    return sum;
  }
  /// S = D G + beta S in row n.
  void turn(int n, const Room& G, float beta, Room& S) const {
    for_preconditioned(n, G, [&](std::size_t k, const Column<C>& z) { S[k].v = z + beta * S[k].v; });
  }

  /// sum over rows of what body(row) gives, in the order of rows.
  template <class Body>
  double sum(const Body& body) {
    parts_.resize(at(rows()));
    for_rows(rows(), piece, [&](int n) { parts_[at(n)] = body(n); });
    return std::accumulate(parts_.begin(), parts_.end(), 0.0);
  }
  double inner(int n, const Room& X, const Room& Y) const {
    double result = 0;
    for_row(n, [&](std::size_t k) { result += dot(X[k].v, Y[k].v); });
    return result;
  }
  /// Calls body(k) for every place of row n.
  template <class Body>
  void for_row(int n, const Body& body) const {
    for (std::size_t k = B * at(first(n)); k < B * at(end(n)); ++k) body(k);
  }
  /// Calls body(p, k) for every block at position p, whose rows are at places k to k + B.
  template <class Body>
  void for_blocks(const Body& body) const {
    for_rows(static_cast<int>(sparsity_.columns.size()), 8 * piece, [&](int p) { body(p, B * at(p)); });
  }

 private:
  /// Calls body(k, D G at place k) in row n.
  template <class Body>
  void for_preconditioned(int n, const Room& G, const Body& body) const {
    float D[B * B];
    std::copy_n(inverse_.data() + B * B * at(n), B * B, D);
    for (int p = first(n); p < end(n); ++p)
      for (int i = 0; i < B; ++i) {
        Column<C> sum{};
        for (int m = 0; m < B; ++m) sum += D[B * m + i] * G[B * at(p) + at(m)].v;
        body(B * at(p) + at(i), sum);
      }
  }
  void set_grams(const Modes& modes) {
    grams_.resize(36 * at(rows()));
    for_rows(rows(), piece, [&](int n) {
      using Six = Eigen::Matrix<double, 6, 6>;
      Six gram = Six::Zero();
      for (int p = first(n); p < end(n); ++p) {
        const Eigen::Map<const Eigen::Matrix<double, C, 6>> M(modes.data() + 6 * C * at(sparsity_.columns[at(p)]));
        gram += M.transpose() * M;
      }
      // Few coarse nodes do not determine all modes: pivots tell how many, and the others are left out.
      const Eigen::LDLT<Six> factor(gram);
      Six Y = factor.transpositionsP() * Six::Identity();
      factor.matrixL().solveInPlace(Y);
      const Eigen::Matrix<double, 6, 1> d = factor.vectorD();
      for (int k = 0; k < 6; ++k) Y.row(k) *= d[k] > 1e-10 * d.maxCoeff() ? 1 / std::sqrt(d[k]) : 0.0;
      Eigen::Map<Six>(grams_.data() + 36 * at(n)).noalias() = Y.transpose() * Y;
    });
  }

  /// X -= (X M) (M^T M)^-1 M^T in row n, where M are the modes on the coarse nodes of the row.
  void project(int n, Room& X) const {
    using Share = Eigen::Matrix<double, B, 6>;
    using Mode = Eigen::Map<const Eigen::Matrix<double, C, 6>>;
    using Block =
        Eigen::Map<Eigen::Matrix<float, B, C, Eigen::RowMajor>, 0, Eigen::OuterStride<sizeof(BlockRow<C>) / 4>>;
    Share sum = Share::Zero();
    // One coarse node alone is determined: no change, and no traces of round-off, which would be denormal numbers.
    if (end(n) == first(n) + 1) return for_row(n, [&](std::size_t k) { X[k].v = Column<C>{}; });
    const auto block = [&](int p) { return Block(reinterpret_cast<float*>(&X[B * at(p)])); };
    const auto mode = [&](int p) { return Mode(modes_.data() + 6 * C * at(sparsity_.columns[at(p)])); };
    for (int p = first(n); p < end(n); ++p) sum += block(p).template cast<double>().lazyProduct(mode(p));
    const Share share = sum * Eigen::Map<const Eigen::Matrix<double, 6, 6>>(grams_.data() + 36 * at(n));
    for (int p = first(n); p < end(n); ++p) block(p) -= share.lazyProduct(mode(p).transpose()).template cast<float>();
  }

  const Blocks<float, B, B>& A_;
  const std::vector<double>& inverse_;
  const Modes& modes_;
  std::vector<double> grams_;
  const Sparsity& sparsity_;
  mutable Places places_;
  std::vector<double> parts_;
};

}  // namespace

template <int B, int C>
void lower_energy(const Blocks<float, B, B>& A, const std::vector<double>& inverse, const Modes& coarse_modes,
                  int steps, Blocks<float, B, C>& P) {
  Columns<B, C> columns(A, inverse, coarse_modes, P.sparsity);
  // The gradient downhill, the direction, and A times the direction.
  auto G = columns.room(), S = columns.room(), AS = columns.room();
  columns.for_blocks([&](int p, std::size_t k) { read<B, C>(P.block(p), &S[k]); });
  double rho = columns.sum([&](int n) {
    columns.multiply(n, S, G);
    columns.for_row(n, [&](std::size_t k) { G[k].v = -G[k].v; });
    return columns.preconditioned(n, G);
  });
  std::fill(S.begin(), S.end(), BlockRow<C>{});
  float beta = 0;
  for (int s = 0; s < steps && rho > 0; ++s) {
    for_rows(columns.rows(), piece, [&](int n) { columns.turn(n, G, beta, S); });
    const double curvature = columns.sum([&](int n) {
      columns.multiply(n, S, AS);
      return columns.inner(n, S, AS);
    });
    if (!(curvature > 0)) return;
    const float alpha = static_cast<float>(rho / curvature);
    columns.for_blocks([&](int p, std::size_t k) { add<B, C>(alpha, &S[k], P.block(p)); });
    const double before = rho;
    rho = columns.sum([&](int n) {
      columns.for_row(n, [&](std::size_t k) { G[k].v -= alpha * AS[k].v; });
      return columns.preconditioned(n, G);
    });
    beta = static_cast<float>(rho / before);
  }
}

template void lower_energy(const Blocks<float, 3, 3>&, const std::vector<double>&, const Modes&, int,
                           Blocks<float, 3, 3>&);
template void lower_energy(const Blocks<float, 3, 3>&, const std::vector<double>&, const Modes&, int,
                           Blocks<float, 3, 6>&);
template void lower_energy(const Blocks<float, 6, 6>&, const std::vector<double>&, const Modes&, int,
                           Blocks<float, 6, 6>&);

}  // namespace msml::fe
