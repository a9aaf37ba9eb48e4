// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the stretch across the plane and condenses the tangent.
#include "solver/materials/plane_stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "msml/core/error.hpp"

namespace msml::fe {
namespace {

constexpr int packed(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }
constexpr int across = 8;  // 3 i + k of F_33

/// Whether the shears of P across the plane are zero where F has none.
bool keeps_plane(const Law& law) {
  Gradients H{};  // stretched in every direction of space, so that fibres that bear tension alone are seen
  for (const auto& [i, k, value] : {std::tuple(0, 0, 0.3), {1, 1, 0.2}, {2, 2, 0.1}, {0, 1, 0.1}, {1, 0, 0.05}})
    H(i, k) += value;
  Response response;
  law.evaluate(Want::stress, {&H, 1}, {&response, 1});
  for (const int shear : {2, 5, 6, 7})
    for (int lane = 0; lane < lanes; ++lane)
      if (std::abs(response.P.c[shear][lane]) > 1e-9 * law.shear_modulus()) return false;
  return true;
}

/// A step that changes the thickness by half at most.
double bounded(double step, double thickness) {
  const double limit = 0.5 * std::max(std::abs(thickness), 0.1);
  return std::clamp(step, -limit, limit);
}

/// One law evaluation per step. A lane's step is halved while |P_33| does not fall, and dropped at round-off of F.
void complete_with(const Law& law, Gradients& H) {
  Response response;
  Lanes good = H(2, 2), step{}, best = lanes_of(std::numeric_limits<double>::infinity());
  for (int iteration = 0; iteration < 80; ++iteration) {
    law.evaluate(Want::tangent, {&H, 1}, {&response, 1});
    bool moving = false;
    for (int lane = 0; lane < lanes; ++lane) {
      const double P = response.P(2, 2)[lane], A = response.tangent[packed(across, across)][lane];
      if (std::abs(P) < best[lane]) {
        best[lane] = std::abs(P);
        good[lane] = H(2, 2)[lane];
        step[lane] = bounded(-P / (A > 0 ? A : 2 * law.shear_modulus()), 1 + good[lane]);
      } else {
        step[lane] *= 0.5;
      }
      if (std::abs(step[lane]) < 4e-16 && !law.small_strain()) step[lane] = 0;
      H(2, 2)[lane] = good[lane] + step[lane];
      moving = moving || step[lane] != 0;
    }
    if (!moving || law.small_strain()) return;  // one step is exact where P is linear
  }
  H(2, 2) = good;
}

class PlaneStress final : public Law {
 public:
  explicit PlaneStress(std::shared_ptr<const Law> law) : law_(std::move(law)) {}

  void complete(std::span<Gradients> gradients) const override {
    for (Gradients& H : gradients) complete_with(*law_, H);
  }

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Gradients H = gradients[i];
      complete_with(*law_, H);
      law_->evaluate(want, {&H, 1}, responses.subspan(i, 1));
      if (want != Want::stress) condense(responses[i]);
    }
  }

  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Gradients H = gradients[i];
      complete_with(*law_, H);
      law_->measure({&H, 1}, measures.subspan(i, 1));
    }
  }

  std::string name() const override { return law_->name(); }
  double poisson_ratio() const override { return law_->poisson_ratio(); }
  double shear_modulus() const override { return law_->shear_modulus(); }
  bool exact_tangent() const override { return law_->exact_tangent(); }
  bool survives_inversion() const override { return law_->survives_inversion(); }
  bool isotropic() const override { return law_->isotropic(); }
  std::optional<std::array<Lanes, 3>> fibre() const override { return law_->fibre(); }
  bool small_strain() const override { return law_->small_strain(); }

 private:
  static void condense(Response& response) {
    Lanes column[9];
    for (int I = 0; I < 9; ++I) column[I] = response.tangent[packed(I, across)];
    Lanes pivot = column[across];
    for (int lane = 0; lane < lanes; ++lane)
      if (!(std::abs(pivot[lane]) > 0)) pivot[lane] = std::numeric_limits<double>::infinity();
    for (int I = 0; I < 9; ++I)
      for (int J = 0; J <= I; ++J) response.tangent[packed(I, J)] -= column[I] * column[J] / pivot;
  }

  std::shared_ptr<const Law> law_;
};

}  // namespace

Thinning thinning(const Law& law, const Gradients& gradient) {
  Gradients H = gradient;
  complete_with(law, H);
  Response response;
  law.evaluate(Want::tangent, {&H, 1}, {&response, 1});
  Thinning found{H(2, 2) + 1.0, {}};
  for (int I = 0; I < 8; ++I)
    for (int lane = 0; lane < lanes; ++lane) {
      const double pivot = response.tangent[packed(across, across)][lane];
      found.slope[I][lane] = pivot > 0 ? -response.tangent[packed(across, I)][lane] / pivot : 0;
    }
  return found;
}

std::shared_ptr<const Law> make_plane_stress(std::shared_ptr<const Law> law) {
  if (!keeps_plane(*law))
    throw Error(
        fmt::format("fibres of {} are oblique to the plane, so that its free faces would bear shear under "
                    "plane=\"stress\": lay them in the plane or across it, or mesh the plate with tetrahedra",
                    law->name()));
  return std::make_shared<const PlaneStress>(std::move(law));
}

}  // namespace msml::fe
