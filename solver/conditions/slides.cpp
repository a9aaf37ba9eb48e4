// SPDX-License-Identifier: GPL-3.0-or-later
// Projections on planes.
#include "solver/conditions/slides.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "msml/core/error.hpp"

namespace msml::fe {
namespace {

using Block = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

Block block(BlockMatrix& A, int position) { return Block(A.values.data() + 9 * static_cast<std::size_t>(position)); }

/// The part of a normal that supports do not hold already.
Vec3 free_part(const Slide& slide, int point, int node, const Mask& fixed, const Mask& moves) {
  Vec3 n = slide.normal.normalized();
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(3 * node + c);
    if (!fixed[k]) continue;
    if (moves[k] && std::abs(n[c]) > 1e-12)
      throw Error(
          fmt::format("node {} is in the plane of '{}', but a support moves it out of it along {}; take it out "
                      "of the indices of one",
                      point, slide.name, "xyz"[c]));
    n[c] = 0;
  }
  return n;
}

}  // namespace

void Slides::project(Vector& v) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3 kept = projection[i] * v.segment<3>(3 * nodes[i]);
    v.segment<3>(3 * nodes[i]) = kept;
  }
}

Vector Slides::removed(const Vector& v) const {
  Vector kept = v;
  project(kept);
  return v - kept;
}

void Slides::project(BlockMatrix& A) const {
  const Pattern& pattern = *A.pattern;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int node = nodes[i];
    const Mat3& P = projection[i];
    const Block own = block(A, pattern.diagonal[static_cast<std::size_t>(node)]);
    const double size = own.cwiseAbs().maxCoeff();
    for (int p = pattern.offsets[static_cast<std::size_t>(node)];
         p < pattern.offsets[static_cast<std::size_t>(node) + 1]; ++p) {
      Block row = block(A, p);
      row = (P * row).eval();
      Block column = block(A, pattern.find(pattern.columns[static_cast<std::size_t>(p)], node));
      column = (column * P).eval();
    }
    block(A, pattern.diagonal[static_cast<std::size_t>(node)]) += (size > 0 ? size : 1) * (Mat3::Identity() - P);
  }
}

Slides make_slides(const Step& step, const Numbering& numbering, const Mask& fixed, const Mask& moves) {
  std::map<int, Mat3> held;  // sum of n n^T over orthonormal normals
  for (const Slide& slide : step.slides)
    for (const int point : slide.nodes) {
      const int node = numbering.number_of[static_cast<std::size_t>(point)];
      if (node < 0) continue;
      Mat3& N = held.try_emplace(node, Mat3::Zero()).first->second;
      Vec3 n = free_part(slide, point, node, fixed, moves);
      n -= N * n;
      if (n.norm() < 1e-6) continue;  // held already
      n.normalize();
      N += n * n.transpose();
    }
  Slides slides;
  for (const auto& [node, N] : held) {
    if (N.isZero()) continue;
    slides.nodes.push_back(node);
    slides.projection.push_back(Mat3::Identity() - N);
  }
  return slides;
}

}  // namespace msml::fe
