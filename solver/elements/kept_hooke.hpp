// SPDX-License-Identifier: GPL-3.0-or-later
// Tangents R K R^T of quadratic tetrahedra that are kept as what they are made of.
#pragma once
#include <tbb/parallel_for.h>

#include <optional>

#include "solver/elements/hooke_points.hpp"
#include "solver/elements/node_parts.hpp"
#include "solver/elements/simplex_batch.hpp"

namespace msml::fe {

/// With one rotation for each element, or one at each of its four points.
template <std::size_t distinct>
class KeptHooke final : public KeptTangent {
 public:
  using Batch = SimplexBatch<3, 10, 4>;
  using Points = std::array<HookePoint, distinct>;
  /// The elements, of which add_internal() makes the matrix, and their batches outlive this.
  KeptHooke(const Elements& elements, const std::vector<Batch>& batches, const std::vector<std::vector<Chunk>>& colours)
      : elements_(elements), batches_(batches), colours_(colours) {}

  /// The tangent at u follows: at() of every batch has to be set.
  void begin(const Vector& u) {
    u_ = u;
    points_.resize(batches_.size());
  }
  Points& at(std::size_t batch) { return points_[batch]; }

  /// Elements write what nodes gather: two loops in parallel, where colours would be one each.
  void multiply(double s, const ScalarMatrix& M, const Vector& x, Vector& y) const override {
    if (!parts_) parts_.emplace(elements_.numbering());
    y.resize(x.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batches_.size(), 16), [&](const auto& range) {
      for (std::size_t b = range.begin(); b < range.end(); ++b) {
        SimplexResult<3, 10> result;
        apply(points_[b], gather_nodes<3, 10>(batches_[b], x), result);
        parts_->set(batches_[b], result.force);
      }
    });
    tbb::parallel_for(tbb::blocked_range<int>(0, elements_.numbering().nodes(), 128), [&](const auto& range) {
      fe::multiply(M, range.begin(), range.end(), x, y, s);
      parts_->add(range.begin(), range.end(), y);
    });
  }
  /// One element after the other, as eight vectors fill the lanes.
  void multiply(double s, const ScalarMatrix& M, const std::vector<Eight>& X, std::vector<Eight>& Y) const override {
    fe::multiply(M, X, Y, s);
    for_batches(colours_, [&](std::size_t b) {
      for (int lane = 0; lane < batches_[b].count; ++lane) {
        Points points;
        for (std::size_t q = 0; q < distinct; ++q) points[q] = points_[b][q].lane(lane);
        add_eight(points, batches_[b].node[lane], X, Y);
      }
    });
  }
  void assemble(BlockMatrix& matrix) const override {
    Vector force = Vector::Zero(u_.size());
    elements_.add_internal(u_, Want::single_tangent, force, &matrix);
  }
  std::size_t bytes() const { return fe::bytes(u_) + points_.size() * sizeof(Points) + (parts_ ? parts_->bytes() : 0); }

 private:
  static void add_eight(const Points& points, const int (&node)[10], const std::vector<Eight>& X,
                        std::vector<Eight>& Y) {
    NodeValues<3, 10> x;
    SimplexResult<3, 10> result;
    for (int a = 0; a < 10; ++a) std::memcpy(x.u[a], &X[3 * static_cast<std::size_t>(node[a])], sizeof x.u[a]);
    apply(points, x, result);
    for (int a = 0; a < 10; ++a) {
      Eight* out = &Y[3 * static_cast<std::size_t>(node[a])];
      Lanes sum[3];
      std::memcpy(sum, out, sizeof sum);
      for (int i = 0; i < 3; ++i) sum[i] += result.force[a][i];
      std::memcpy(out, sum, sizeof sum);
    }
  }

  const Elements& elements_;
  const std::vector<Batch>& batches_;
  const std::vector<std::vector<Chunk>>& colours_;
  Vector u_;
  std::vector<Points> points_;  ///< of each batch
  mutable std::optional<NodeParts<10>> parts_;
};

}  // namespace msml::fe
