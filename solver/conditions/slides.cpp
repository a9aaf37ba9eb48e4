// SPDX-License-Identifier: GPL-3.0-or-later
// Projections on planes.
#include "solver/conditions/slides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "msml/core/error.hpp"

namespace msml::fe {
namespace {

using Block = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

Block block(BlockMatrix& A, int position) { return Block(A.values.data() + 9 * static_cast<std::size_t>(position)); }

/// The part of a normal that supports do not hold already.
Vec3 free_part(const Slide& slide, int point, int node, const HeldUnknowns& held) {
  Vec3 n = slide.normal.normalized();
  double first = 0, last = 0, size = 0;  // along the normal, at the start of the step and at its end
  int moved = -1;
  bool follows = false;
  for (int c = 0; c < 3; ++c) {
    const int k = 3 * node + c;
    if (!held.fixed[static_cast<std::size_t>(k)]) continue;
    if (const char moves = held.moves[static_cast<std::size_t>(k)]; moves != 0 && std::abs(n[c]) > 1e-12) {
      moved = c;
      follows = follows || moves > 1;
      first += n[c] * held.first[k];
      last += n[c] * held.last[k];
      size = std::max({size, std::abs(held.first[k]), std::abs(held.last[k])});
    }
    n[c] = 0;
  }
  const bool inside = !follows && n.norm() < 1e-6 && std::max(std::abs(first), std::abs(last)) <= 1e-9 * size;
  if (moved >= 0 && !inside)
    throw Error(
        fmt::format("node {} is in the plane of '{}', but a support moves it out of it along {}; take it out "
                    "of the indices of one",
                    point, slide.name, "xyz"[moved]));
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

Slides make_slides(const Step& step, const Numbering& numbering, const HeldUnknowns& supports) {
  std::map<int, Mat3> held;  // sum of n n^T over orthonormal normals
  for (const Slide& slide : step.slides)
    for (const int point : slide.nodes) {
      const int node = numbering.number_of[static_cast<std::size_t>(point)];
      if (node < 0) continue;
      Mat3& N = held.try_emplace(node, Mat3::Zero()).first->second;
      Vec3 n = free_part(slide, point, node, supports);
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
