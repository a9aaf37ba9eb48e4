// SPDX-License-Identifier: GPL-3.0-or-later
// Fits rotations to the neighbours of nodes, eight nodes at a time.
#include "solver/linear/multigrid/node_rotations.hpp"

#include "solver/linear/multigrid/blocks.hpp"
#include "solver/materials/polar.hpp"

namespace msml::fe {

void node_rotations(const Pattern& pattern, const Vector& X, const Vector& x, const Mask& fixed,
                    std::vector<float>& rotations) {
  const int nodes = pattern.nodes();
  rotations.resize(9 * static_cast<std::size_t>(nodes));
  for_rows((nodes + lanes - 1) / lanes, 64, [&](int batch) {
    Tensor<Lanes> S{};
    for (int lane = 0; lane < lanes; ++lane) {
      const int n = std::min(nodes - 1, lanes * batch + lane);
      double sum[9] = {};
      for (int p = pattern.offsets[static_cast<std::size_t>(n)]; p < pattern.offsets[static_cast<std::size_t>(n) + 1];
           ++p) {
        const int m = pattern.columns[static_cast<std::size_t>(p)];
        const Vec3 now = x.segment<3>(3 * m) - x.segment<3>(3 * n), then = X.segment<3>(3 * m) - X.segment<3>(3 * n);
        for (int k = 0; k < 9; ++k) sum[k] += now[k / 3] * then[k % 3];
      }
      for (int k = 0; k < 9; ++k) S.c[k][lane] = sum[k];
    }
    const Tensor<Lanes> R = polar_rotation(S);
    for (int lane = 0; lane < lanes && lanes * batch + lane < nodes; ++lane) {
      const auto n = static_cast<std::size_t>(lanes * batch + lane);
      const bool free = !fixed[3 * n] && !fixed[3 * n + 1] && !fixed[3 * n + 2];
      for (std::size_t k = 0; k < 9; ++k)
        rotations[9 * n + k] = static_cast<float>(free ? R.c[k][lane] : (k % 4 == 0 ? 1.0 : 0.0));
    }
  });
}

}  // namespace msml::fe
