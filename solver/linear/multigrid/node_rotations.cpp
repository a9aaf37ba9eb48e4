// SPDX-License-Identifier: GPL-3.0-or-later
// Fits rotations to the neighbours of nodes, eight nodes at a time.
#include "solver/linear/multigrid/node_rotations.hpp"

#include "solver/linear/multigrid/blocks.hpp"
#include "solver/materials/polar.hpp"

namespace msml::fe {
namespace {

using Ends = std::vector<std::array<int, 2>>;

bool is_held(const Mask& fixed, std::size_t n) { return fixed[3 * n] || fixed[3 * n + 1] || fixed[3 * n + 2]; }

void set_identity(float* R) {
  for (std::size_t k = 0; k < 9; ++k) R[k] = k % 4 == 0 ? 1.0f : 0.0f;
}

/// Sum of the products of a node's edges before and after.
void fit(const Pattern& pattern, const Vector& X, const Vector& x, int n, double (&sum)[9]) {
  for (int p = pattern.offsets[static_cast<std::size_t>(n)]; p < pattern.offsets[static_cast<std::size_t>(n) + 1];
       ++p) {
    const int m = pattern.columns[static_cast<std::size_t>(p)];
    const Vec3 now = x.segment<3>(3 * m) - x.segment<3>(3 * n), then = X.segment<3>(3 * m) - X.segment<3>(3 * n);
    for (int k = 0; k < 9; ++k) sum[k] += now[k / 3] * then[k % 3];
  }
}

/// Nearly a rotation where those of the ends are near each other; where they are a quarter turn apart, the first.
void take_mean(const float* a, const float* b, float* R) {
  float cosines = 0;  // trace of a^T b = 1 + 2 cos of the angle between them
  for (int k = 0; k < 9; ++k) cosines += a[k] * b[k];
  for (int k = 0; k < 9; ++k) R[k] = cosines > 1 ? 0.5f * (a[k] + b[k]) : a[k];
}

}  // namespace

void node_rotations(const Pattern& pattern, const Vector& X, const Vector& x, const Mask& fixed, const Ends& ends,
                    std::vector<float>& rotations) {
  std::vector<int> corners;
  for (int n = 0; n < pattern.nodes(); ++n)
    if (ends.empty() || ends[static_cast<std::size_t>(n)][0] < 0) corners.push_back(n);
  const int count = static_cast<int>(corners.size());
  rotations.resize(9 * static_cast<std::size_t>(pattern.nodes()));
  const auto of = [&](int n) { return rotations.data() + 9 * static_cast<std::size_t>(n); };
  for_rows((count + lanes - 1) / lanes, 64, [&](int batch) {
    Tensor<Lanes> S{};
    for (int lane = 0; lane < lanes; ++lane) {
      double sum[9] = {};
      fit(pattern, X, x, corners[static_cast<std::size_t>(std::min(count - 1, lanes * batch + lane))], sum);
      for (int k = 0; k < 9; ++k) S.c[k][lane] = sum[k];
    }
    const Tensor<Lanes> R = polar_rotation(S);
    for (int lane = 0; lane < lanes && lanes * batch + lane < count; ++lane) {
      const int n = corners[static_cast<std::size_t>(lanes * batch + lane)];
      for (int k = 0; k < 9; ++k) of(n)[k] = static_cast<float>(R.c[k][lane]);
      if (is_held(fixed, static_cast<std::size_t>(n))) set_identity(of(n));
    }
  });
  for_rows(static_cast<int>(ends.size()), 2048, [&](int n) {
    const auto [a, b] = ends[static_cast<std::size_t>(n)];
    if (a >= 0 && is_held(fixed, static_cast<std::size_t>(n))) return set_identity(of(n));
    if (a >= 0) take_mean(of(a), of(b), of(n));
  });
}

}  // namespace msml::fe
