// SPDX-License-Identifier: GPL-3.0-or-later
// The law of an energy written in invariants, with an energy of volume changes beside it.
#pragma once
#include <type_traits>
#include <utility>
#include <vector>

#include "solver/materials/invariants.hpp"
#include "solver/materials/nilpotent.hpp"
#include "solver/materials/semidefinite.hpp"
#include "solver/materials/volumetric.hpp"

namespace msml::fe {

/// What a law says of itself.
struct LawFacts {
  std::string name;          ///< the tag
  double shear_modulus = 0;  ///< of the small-strain limit, stress
  double poisson_ratio = 0;  ///< of the small-strain limit
  bool survives_inversion = false;
  bool isotropic = true;
  bool incompressible = false;
};

/// The variables of a kernel, which hold its fibre directions where it has any.
template <class Kernel, class T>
auto variables_of(const Kernel& kernel, const Invariants<T>& invariants) {
  if constexpr (requires { kernel.variables(invariants); })
    return kernel.variables(invariants);
  else
    return typename Kernel::Variables(invariants);
}

/// Energy, stress and (if wanted) tangent of `kernel` + `volumetric` at F = I + H. A Kernel<T> names its `Variables`,
/// and kernel(variables) is the energy as a jet in them. At rest the jet's slope by j must be 0. All in one function,
/// so that without tangent nobody computes second derivatives.
template <bool tangent, class Kernel, class T>
[[gnu::flatten]] void respond(const Kernel& kernel, const Volumetric<T>& volumetric, const Tensor<T>& H,
                              ResponseOf<T>& out) {
  using Variables = typename Kernel::Variables;
  constexpr int count = Variables::count, volume = Variables::volume;
  const Invariants<T> invariants(H);
  const Variables variables = variables_of(kernel, invariants);
  auto w = kernel(variables);
  const Function<T> U = volumetric.at(invariants.j);
  w += Jet<T, count>::of_variable(volume, U.value, U.slope, U.curvature);
  Tensor<T> slopes[count];
  variables.slopes(invariants, slopes);
  out.energy = w.value;
  for (int k = 0; k < 9; ++k) {
    out.P.c[k] = w.first[0] * slopes[0].c[k];
    for (int x = 1; x < count; ++x) out.P.c[k] += w.first[x] * slopes[x].c[k];
  }
  if constexpr (tangent) {
    for (T& entry : out.tangent) entry = T{};
    add_products(w, slopes, out.tangent);
    variables.add_curvature(invariants, w, out.tangent);
  }
}

/// Cauchy stress P F^T / J and Green-Lagrange strain (F^T F - I)/2 at F = I + H from energy and P.
void measure_hyperelastic(const Gradients& H, const Response& response, Measures& out);

/// The volume measure g of a split as if it were an energy.
std::shared_ptr<const Law> make_volume_constraint(VolumeMeasure measure);

/// The law of a kernel (a class template over the scalar; `map<U>(f)` makes the kernel over U with f of each
/// parameter).
template <template <class> class Kernel>
class PotentialLaw final : public Law, public StretchLaw {
 public:
  PotentialLaw(Kernel<Lanes> kernel, Volumetric<Lanes> volumetric, LawFacts facts)
      : kernel_(std::move(kernel)), volumetric_(volumetric), facts_(std::move(facts)) {}

  void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      if (want == Want::stress)
        respond<false>(kernel_, volumetric_, gradients[i], responses[i]);
      else
        respond<true>(kernel_, volumetric_, gradients[i], responses[i]);
      if (want == Want::definite_tangent) make_semidefinite(responses[i]);
    }
  }
  void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const override {
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      Response response;
      respond<false>(kernel_, volumetric_, gradients[i], response);
      measure_hyperelastic(gradients[i], response, measures[i]);
    }
  }
  std::string name() const override { return facts_.name; }
  double poisson_ratio() const override { return facts_.poisson_ratio; }
  double shear_modulus() const override { return facts_.shear_modulus; }
  bool survives_inversion() const override { return facts_.survives_inversion; }
  bool isotropic() const override { return facts_.isotropic; }
  bool incompressible() const override { return facts_.incompressible; }
  std::optional<std::array<Lanes, 3>> fibre() const override {
    if constexpr (requires { kernel_.fibre(); })
      return kernel_.fibre();
    else
      return std::nullopt;
  }

  Jet<Nilpotent, 3> of_stretches([[maybe_unused]] const Nilpotent (&s)[3], [[maybe_unused]] int lane) const override {
    using Variables = typename Kernel<Nilpotent>::Variables;
    if constexpr (std::is_same_v<Variables, TwoInvariants<Nilpotent>> ||
                  std::is_same_v<Variables, ThreeInvariants<Nilpotent>>) {
      const auto at = [lane](const Lanes& x) { return Nilpotent(x[lane]); };
      const auto x = invariants_of_stretches(s);  // a, j, b
      const auto kernel = kernel_.template map<Nilpotent>(at);
      const Volumetric<Nilpotent> volumetric{volumetric_.measure, at(volumetric_.modulus)};
      const Function<Nilpotent> U = volumetric.at(x[1].value);
      if constexpr (Variables::count == 2) {
        auto w = kernel(Variables(x[0].value, x[1].value));
        w += Jet<Nilpotent, 2>::of_variable(1, U.value, U.slope, U.curvature);
        return compose(w, {x[0], x[1]});
      } else {
        auto w = kernel(Variables(x[0].value, x[2].value, x[1].value));
        w += Jet<Nilpotent, 3>::of_variable(2, U.value, U.slope, U.curvature);
        return compose(w, {x[0], x[2], x[1]});
      }
    }
    return {};  // fibres: never asked for
  }

  std::optional<Split> split() const override {
    if (volumetric_.measure == VolumeMeasure::none) return std::nullopt;
    LawFacts facts = facts_;
    facts.incompressible = false;
    Split split{.rest = std::make_shared<PotentialLaw>(kernel_, Volumetric<Lanes>{}, facts),
                .constraint = make_volume_constraint(volumetric_.measure)};
    if (!facts_.incompressible) split.modulus = volumetric_.modulus;
    return split;
  }

  std::shared_ptr<const Law> merged(std::span<const std::shared_ptr<const Law>> others) const override {
    std::vector<Lanes> mixed = parameters();
    for (std::size_t lane = 0; lane < others.size(); ++lane) {
      const auto* other = dynamic_cast<const PotentialLaw*>(others[lane].get());
      if (other == nullptr || other->volumetric_.measure != volumetric_.measure) return {};
      const std::vector<Lanes> own = other->parameters();
      if (own.size() != mixed.size()) return {};
      for (std::size_t p = 0; p < own.size(); ++p) mixed[p][lane] = own[p][lane];
    }
    std::size_t next = 0;
    Volumetric<Lanes> volumetric{volumetric_.measure, mixed[next++]};
    const auto kernel = kernel_.template map<Lanes>([&](const Lanes&) { return mixed[next++]; });
    return std::make_shared<PotentialLaw>(kernel, volumetric, facts_);
  }

 private:
  std::vector<Lanes> parameters() const {
    std::vector<Lanes> all{volumetric_.modulus};
    kernel_.template map<Lanes>([&](const Lanes& parameter) { return all.push_back(parameter), parameter; });
    return all;
  }

  Kernel<Lanes> kernel_;
  Volumetric<Lanes> volumetric_;
  LawFacts facts_;
};

}  // namespace msml::fe
