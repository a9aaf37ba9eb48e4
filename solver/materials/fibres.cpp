// SPDX-License-Identifier: GPL-3.0-or-later
// The tags of laws with fibres.
#include "solver/materials/fibres.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "msml/core/error.hpp"
#include "solver/materials/guccione.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/registry.hpp"

namespace msml::fe {
namespace {

constexpr const char* field_note =
    "A direction is three numbers, of any length but 0; three expressions in X, Y and Z, apart by commas where they "
    "hold "
    "blanks; or the name of a cell field of the mesh with three components: the direction in each element. Opposite "
    "directions mean the same.";

Key<std::string> describe_direction(Description& material, const std::string& name, bool optional,
                                    const std::string& doc) {
  Options<std::string> options{.unit = "direction", .optional = optional, .doc = doc};
  return material.parameter<std::string>(name, options);
}

/// The unit vector of a direction; a name that no one has replaced by an element's own numbers is a fault. Along x
/// where it is one.
Direction<Lanes> direction(const Record& record, Key<std::string> key, Faults& faults) {
  const std::string& name = record.description->slots()[static_cast<std::size_t>(key.slot)].name;
  const std::string& text = record[key];
  std::vector<double> numbers = direction_numbers(text);
  const bool none = numbers.empty();
  if (none)
    faults.add(fmt::format("{}: {} = '{}' is neither three numbers or expressions nor a cell field of the mesh",
                           record.tag(), name, text));
  double length = none ? 0 : std::hypot(numbers[0], numbers[1], numbers[2]);
  if (!(length > 0) || !std::isfinite(length)) {
    if (!none) faults.add(fmt::format("{}: {} = '{}' has no direction", record.tag(), name, text));
    numbers = {1, 0, 0};
    length = 1;
  }
  return {lanes_of(numbers[0] / length), lanes_of(numbers[1] / length), lanes_of(numbers[2] / length)};
}

/// Adds a fault where the sheets would lie along the fibres.
void check_across(const Record& record, const Direction<Lanes>& fiber, const Direction<Lanes>& sheet, Faults& faults) {
  const double cosine = std::abs(fiber[0][0] * sheet[0][0] + fiber[1][0] * sheet[1][0] + fiber[2][0] * sheet[2][0]);
  if (cosine > 1 - 1e-9)
    faults.add(record.tag() + ": sheet lies along fiber; give a direction across the fibres, or leave sheet out");
}

}  // namespace

std::vector<double> direction_numbers(const std::string& text) {
  std::string plain = text;
  for (char& c : plain)
    if (c == ',' || c == '{' || c == '}') c = ' ';
  std::istringstream stream(plain);
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double x = 0; stream >> x;) numbers.push_back(x);
  if (!stream.eof() || numbers.size() != 3) return {};
  return numbers;
}

MaterialFactory transversely_isotropic_material() {
  MaterialFactory material("transverselyIsotropicMaterial", "material",
                           "A neo-Hookean matrix with one family of fibres that bear tension alone.");
  material.source(
      "W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2 + k1/(2 k2) (exp(k2 <f>^2) - 1), f = g . C g - 1 with the fibre "
      "g "
      "and <f> = max(f, 0)");
  const auto young = material.parameter(
      "youngModulus", {.unit = "stress", .range = positive(), .doc = "Young's modulus of the matrix"});
  const auto poisson =
      material.parameter("poissonRatio", {.range = open(-1, 0.5), .doc = "Poisson's ratio of the matrix"});
  const auto k1 = material.parameter(
      "k1", {.unit = "stress", .range = nonnegative(), .doc = "stiffness of the fibres: 4 k1 at rest in tension"});
  const auto k2 = material.parameter("k2", {.range = positive(), .fallback = 1.0, .doc = "how fast they stiffen"});
  const auto fiber = describe_direction(material, "fiber", false, "direction of the fibres");
  material.note(field_note);
  material.build([=](const Record& record) -> std::shared_ptr<const Law> {
    const Lame lame = lame_of(record[young], record[poisson]);
    Faults faults(record);
    const TransverselyIsotropic<Lanes> kernel{lanes_of(lame.mu), lanes_of(record[k1]), lanes_of(record[k2]),
                                              direction(record, fiber, faults)};
    faults.raise();
    const LawFacts facts{
        .name = record.tag(), .shear_modulus = lame.mu, .poisson_ratio = record[poisson], .isotropic = false};
    return std::make_shared<PotentialLaw<TransverselyIsotropic>>(
        kernel, Volumetric<Lanes>{VolumeMeasure::logarithm, lanes_of(lame.lambda)}, facts);
  });
  return material;
}

MaterialFactory holzapfel_gasser_ogden_material() {
  MaterialFactory material("holzapfelGasserOgdenMaterial", "material",
                           "Artery walls: one or two families of dispersed fibres that bear tension alone, in rubber.");
  material.source(
      "W = mu/2 (J^(-2/3) I1 - 3) + sum of k1/(2 k2) (exp(k2 <E>^2) - 1) + volumetric, E = kappa (J^(-2/3) I1 - 3) + "
      "(1 - "
      "3 kappa) (J^(-2/3) g . C g - 1); Gasser, Ogden and Holzapfel 2006, doi 10.1098/rsif.2005.0073");
  const auto mu =
      material.parameter("mu", {.unit = "stress", .range = positive(), .doc = "shear modulus of the matrix"});
  const auto k1 =
      material.parameter("k1", {.unit = "stress", .range = nonnegative(), .doc = "stiffness of each family of fibres"});
  const auto k2 = material.parameter("k2", {.range = positive(), .doc = "how fast they stiffen"});
  const auto kappa = material.parameter(
      "kappa", {.range = closed(0, 1.0 / 3), .fallback = 0.0, .doc = "dispersion: 0 none, 1/3 in all directions"});
  const auto fiber = describe_direction(material, "fiber", false, "direction of the first family");
  const auto fiber2 =
      describe_direction(material, "fiber2", true, "direction of the second family; absent: one family");
  const VolumeKeys keys = describe_volume(material);
  material.note(field_note);
  material.build([=](const Record& record) {
    const bool two = record.has(fiber2);
    Faults faults(record);
    const Direction<Lanes> first = direction(record, fiber, faults);
    const Direction<Lanes> second = two ? direction(record, fiber2, faults) : first;
    check_volume(record, keys, faults);
    faults.raise();
    return make_isochoric(record, keys,
                          HolzapfelGasserOgden<Lanes>{lanes_of(record[mu]), lanes_of(record[k1]), lanes_of(record[k2]),
                                                      lanes_of(record[kappa]), lanes_of(two ? 1 : 0), first, second},
                          record[mu], false);
  });
  return material;
}

MaterialFactory guccione_material() {
  MaterialFactory material("guccioneMaterial", "material",
                           "Passive heart muscle: exponential in the Green-Lagrange strain, stiffer along the fibres.");
  material.source(
      "W = C/2 (exp(Q) - 1) + volumetric, Q = bf E_ff^2 + bt (E_ss^2 + E_nn^2 + 2 E_sn^2) + 2 bfs (E_fs^2 + E_fn^2); "
      "Guccione, McCulloch and Waldman 1991, doi 10.1115/1.2894084");
  const auto C = material.parameter("C", {.unit = "stress", .range = positive(), .doc = "C"});
  const auto bf = material.parameter("bf", {.range = positive(), .doc = "along the fibres"});
  const auto bt = material.parameter("bt", {.range = positive(), .doc = "across the fibres"});
  const auto bfs = material.parameter("bfs", {.range = positive(), .doc = "in shear between along and across"});
  const auto fiber = describe_direction(material, "fiber", false, "direction of the fibres");
  const auto sheet = describe_direction(
      material, "sheet", true, "a direction across the fibres; may be left out, since it changes nothing (see below)");
  const VolumeKeys keys = describe_volume(material);
  material.note(
      "This is the transversely isotropic form of 1991: with bt and bfs for all directions across the fibres Q is the "
      "same whichever way the sheets lie. A sheet that is given is checked not to lie along the fibres.");
  material.note(field_note);
  material.build([=](const Record& record) {
    Faults faults(record);
    const Direction<Lanes> along = direction(record, fiber, faults);
    const Direction<Lanes> across = record.has(sheet) ? direction(record, sheet, faults) : along;
    if (record.has(sheet) && faults.none()) check_across(record, along, across, faults);
    check_volume(record, keys, faults);
    faults.raise();
    const Guccione<Lanes> kernel{lanes_of(record[C]), lanes_of(record[bf]), lanes_of(record[bt]), lanes_of(record[bfs]),
                                 along};
    return make_isochoric(record, keys, kernel, record[C] * record[bt] / 2, false);
  });
  return material;
}

}  // namespace msml::fe
