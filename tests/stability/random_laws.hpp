// SPDX-License-Identifier: GPL-3.0-or-later
// Laws drawn at random: every material of the language, with a Young's modulus of about 1000 at rest.
#pragma once
#include <fmt/format.h>

#include <array>

#include "solver/materials/linear_elastic.hpp"
#include "tests/solver/law_by_name.hpp"
#include "tests/stability/draw.hpp"

namespace msml::fe::testing {

/// The laws that can be drawn; rubber are those that may be incompressible.
enum class Family {
  small,
  corotated,
  st_venant,
  log,
  cubic,
  stable,
  isochoric,
  mooney,
  yeoh,
  ogden,
  fibres,
  hgo,
  heart
};
constexpr int families = 13;

constexpr const char* name(Family family) {
  constexpr std::array<const char*, families> names{
      "small", "corotated", "St. Venant-Kirchhoff",   "log",       "cubic",   "stable", "isochoric", "Mooney-Rivlin",
      "Yeoh",  "Ogden",     "transversely isotropic", "Holzapfel", "Guccione"};
  return names[static_cast<std::size_t>(family)];
}
constexpr bool is_rubber(Family family) { return family >= Family::isochoric && family != Family::fibres; }
constexpr bool is_fibrous(Family family) { return family >= Family::fibres; }

using Attributes = std::vector<std::pair<std::string, Value>>;

inline std::string text_of(const Vec3& x) { return fmt::format("{} {} {}", x[0], x[1], x[2]); }

/// Rubbers and muscle with the shear modulus mu and their volumes held by kappa, or for good.
inline std::shared_ptr<const Law> draw_rubber(Draw& draw, Family family, double mu, Attributes attributes) {
  const auto with = [&](Attributes own) {
    attributes.insert(attributes.end(), own.begin(), own.end());
    return attributes;
  };
  const double share = draw.number(0, 1);
  if (family == Family::mooney)
    return law_by_name("mooneyRivlinMaterial", with({{"c1", mu / 2 * share}, {"c2", mu / 2 * (1 - share)}}));
  if (family == Family::yeoh)
    return law_by_name("reducedPolynomialMaterial",
                       with({{"c", std::vector<double>{mu / 2, -mu / 20 * share, mu / 200}}}));
  if (family == Family::ogden)
    return law_by_name("ogdenMaterial", with({{"mu", std::vector<double>{mu * share, -mu * (1 - share)}},
                                              {"alpha", std::vector<double>{2, -2}}}));
  attributes.emplace_back("fiber", text_of(draw.direction()));
  if (family == Family::hgo)
    return law_by_name("holzapfelGasserOgdenMaterial", with({{"mu", mu},
                                                             {"k1", mu * draw.power(0.1, 100)},
                                                             {"k2", draw.power(0.1, 10)},
                                                             {"kappa", draw.number(0, 1.0 / 3)},
                                                             {"fiber2", text_of(draw.direction())}}));
  return law_by_name(
      "guccioneMaterial",
      with({{"C", mu / 10}, {"bf", draw.power(5, 40)}, {"bt", draw.power(2, 10)}, {"bfs", draw.power(2, 10)}}));
}

/// A ratio of 0 to .4999, or rubber that keeps its volume if `mixed`.
inline std::shared_ptr<const Law> draw_law(Draw& draw, Family family, bool mixed, std::string& words) {
  const double nu = draw.chance(0.2) ? draw.number(0.45, 0.4999) : draw.number(0, 0.45);
  const bool incompressible = mixed && is_rubber(family) && draw.chance(0.5);
  const bool clamped = !incompressible && family >= Family::st_venant && !is_fibrous(family) && draw.chance(0.15);
  words += incompressible ? "incompressible, " : fmt::format("nu {:.3f}{}, ", nu, clamped ? " clamped" : "");
  Attributes moduli{{"youngModulus", drawn_young}}, inversion;
  if (clamped) inversion = {{"inversion", std::string("clamped")}};
  if (!incompressible) moduli.emplace_back("poissonRatio", nu);
  const auto with = [&](Attributes own) {
    own.insert(own.end(), moduli.begin(), moduli.end());
    own.insert(own.end(), inversion.begin(), inversion.end());
    return own;
  };
  const double mu = drawn_young / (2 * (1 + nu)), kappa = drawn_young / (3 * (1 - 2 * nu));
  switch (family) {
    case Family::small:
    case Family::corotated:
      return make_linear_elastic({.youngs_modulus = drawn_young,
                                  .poisson_ratio = nu,
                                  .strain = family == Family::small ? Strain::small : Strain::corotated});
    case Family::st_venant:
      return law_by_name("stVenantKirchhoffMaterial", with({}));
    case Family::log:
    case Family::cubic:
    case Family::stable:
      return law_by_name("neoHookeanMaterial", with({{"form", std::string(name(family))}}));
    case Family::isochoric:
      return law_by_name("neoHookeanMaterial", with({{"form", std::string(incompressible ? "log" : "isochoric")},
                                                     {"incompressible", incompressible}}));
    case Family::fibres:
      return law_by_name(
          "transverselyIsotropicMaterial",
          with({{"k1", mu * draw.power(0.1, 100)}, {"k2", draw.power(0.1, 10)}, {"fiber", text_of(draw.direction())}}));
    default: {
      constexpr std::array<const char*, 3> volumetric{"lnJ2", "J1", "I3"};
      Attributes volume{{"incompressible", incompressible}};
      if (!incompressible) {
        volume.emplace_back("bulkModulus", kappa);
        volume.emplace_back("volumetric", std::string(volumetric[static_cast<std::size_t>(draw.index(3))]));
      }
      volume.insert(volume.end(), inversion.begin(), inversion.end());
      return draw_rubber(draw, family, mu, volume);
    }
  }
}

}  // namespace msml::fe::testing
