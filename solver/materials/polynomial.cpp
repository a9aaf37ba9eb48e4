// SPDX-License-Identifier: GPL-3.0-or-later
// The tags mooneyRivlinMaterial, reducedPolynomialMaterial and polynomialMaterial.
#include "solver/materials/polynomial.hpp"

#include <fmt/format.h>

#include <cmath>

#include "msml/core/error.hpp"
#include "solver/materials/clamped.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/registry.hpp"

namespace msml::fe {
namespace {

constexpr const char* volume_note =
    "The first invariants are those of J^(-1/3) F, so that volume changes are left to the volumetric term. For small "
    "strain it is Hooke's law of kappa = bulkModulus and the mu named above.";

/// The keys that these laws share.
struct CommonKeys {
  VolumeKeys volume;
  InversionKeys inversion;
};

/// Raises these faults and those of the shear modulus at rest (named by a formula), the volume and the inversion.
void check(const Record& record, const CommonKeys& keys, const std::string& formula, double mu, Faults faults) {
  if (!(mu > 0))
    faults.add(fmt::format("{}: the shear modulus at rest, {} = {:g}, is not > 0", record.tag(), formula, mu));
  check_volume(record, keys.volume, faults);
  check_inversion(record, keys.inversion, record[keys.volume.incompressible], faults);
  faults.raise();
}

/// Powers are the same everywhere; only c_ij may be an expression.
std::string powers_are_numbers(const Value& value) {
  const auto* terms = std::get_if<Formulas>(&value);
  for (std::size_t k = 0; terms != nullptr && k < terms->size(); ++k)
    if (k % 3 != 2 && !(*terms)[k].constant())
      return fmt::format("the power {} is no number; only the c_ij may be expressions", (*terms)[k].text);
  return {};
}

Polynomial<Lanes> polynomial_of(const Record& record, const std::vector<double>& terms, Faults& faults) {
  Polynomial<Lanes> kernel;
  for (std::size_t k = 0; k + 2 < terms.size(); k += 3) {
    const double i = terms[k], j = terms[k + 1];
    const auto whole = [](double n) { return n >= 0 && n <= 10 && n == std::floor(n); };
    if (!whole(i) || !whole(j) || i + j == 0)
      faults.add(
          fmt::format("{}: terms holds the powers {:g} {:g}; powers are whole numbers from 0 to 10, not both 0: "
                      "\"1 0 c10 0 1 c01 …\"",
                      record.tag(), i, j));
    else
      kernel.terms.push_back({static_cast<int>(i), static_cast<int>(j), lanes_of(terms[k + 2])});
  }
  return kernel;
}

}  // namespace

MaterialFactory mooney_rivlin_material() {
  MaterialFactory material("mooneyRivlinMaterial", "material",
                           "Mooney-Rivlin rubber, W = c1 (J^(-2/3) I1 - 3) + c2 (J^(-4/3) I2 - 3) + volumetric.");
  material.source("Mooney 1940, doi 10.1063/1.1712836; Rivlin 1948, doi 10.1098/rsta.1948.0024");
  const auto c1 = material.parameter("c1", {.unit = "stress", .doc = "c1; mu = 2 (c1 + c2) is > 0"});
  const auto c2 = material.parameter("c2", {.unit = "stress", .fallback = 0.0, .doc = "c2"});
  const VolumeKeys keys = describe_volume(material);
  const InversionKeys inversion = describe_inversion(material);
  material.note(volume_note);
  material.build([=](const Record& record) {
    const double mu = 2 * (record[c1] + record[c2]);
    check(record, {keys, inversion}, "2 (c1 + c2)", mu, Faults(record));
    return with_inversion(
        record, inversion,
        make_isochoric(record, keys, MooneyRivlin<Lanes>{lanes_of(record[c1]), lanes_of(record[c2])}, mu));
  });
  return material;
}

MaterialFactory reduced_polynomial_material() {
  MaterialFactory material("reducedPolynomialMaterial", "material",
                           "Polynomial in the first invariant, W = sum of c_i (J^(-2/3) I1 - 3)^i + volumetric; three "
                           "terms are Yeoh's law, one is neo-Hookean.");
  material.source("Yeoh 1993, doi 10.5254/1.3538343");
  const auto c = material.parameter<std::vector<double>>("c", {
                                                                  .unit = "stress",
                                                                  .doc = "c_1 c_2 …, up to 10; mu = 2 c_1 is > 0",
                                                              });
  const VolumeKeys keys = describe_volume(material);
  const InversionKeys inversion = describe_inversion(material);
  material.note(volume_note);
  material.build([=](const Record& record) {
    const std::vector<double>& list = record[c];
    Faults faults(record);
    if (list.empty() || list.size() > 10)
      faults.add(fmt::format("{}: c has {} numbers; it takes 1 to 10", record.tag(), list.size()));
    check(record, {keys, inversion}, "2 c_1", list.empty() ? 1 : 2 * list[0], faults);
    ReducedPolynomial<Lanes> kernel;
    for (const double x : list) kernel.c.push_back(lanes_of(x));
    return with_inversion(record, inversion, make_isochoric(record, keys, kernel, 2 * list[0]));
  });
  return material;
}

MaterialFactory polynomial_material() {
  MaterialFactory material("polynomialMaterial", "material",
                           "Polynomial in two invariants, W = sum of c_ij (J^(-2/3) I1 - 3)^i (J^(-4/3) I2 - 3)^j + "
                           "volumetric.");
  material.source("Rivlin and Saunders 1951, doi 10.1098/rsta.1951.0004");
  const auto terms = material.parameter<std::vector<double>>(
      "terms", {.multiple_of = 3,
                .check = powers_are_numbers,
                .doc = "i j c_ij for each term, c_ij a stress; mu = 2 (c_10 + c_01) is > 0"});
  const VolumeKeys keys = describe_volume(material);
  const InversionKeys inversion = describe_inversion(material);
  material.note(volume_note);
  material.build([=](const Record& record) {
    Faults faults(record);
    const Polynomial<Lanes> kernel = polynomial_of(record, record[terms], faults);
    double mu = 0;
    for (const auto& [i, j, c] : kernel.terms)
      if (i + j == 1) mu += 2 * c[0];
    const bool whole = 3 * kernel.terms.size() == record[terms].size();  // else it is not known what was meant
    check(record, {keys, inversion}, "2 (c_10 + c_01)", whole ? mu : 1, faults);
    return with_inversion(record, inversion, make_isochoric(record, keys, kernel, mu));
  });
  return material;
}

}  // namespace msml::fe
