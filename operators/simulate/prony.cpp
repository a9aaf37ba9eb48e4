// SPDX-License-Identifier: GPL-3.0-or-later
// The tag that makes a region's law viscoelastic.
#include <numeric>

#include "msml/core/faults.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/settings.hpp"
#include "solver/fields_attribute.hpp"

namespace msml::simulation {

namespace {

/// Of constant expressions: what varies has been worked out before.
std::vector<double> numbers(const Formulas& formulas) {
  std::vector<double> values;
  for (const Formula& formula : formulas) values.push_back(formula.number);
  return values;
}

}  // namespace

Factory<fe::Prony> prony() {
  Factory<fe::Prony> tag("prony", "prony",
                         "Makes the law of the region relax: quasi-linear viscoelasticity with a series of terms.");
  tag.source("Fung 1993, Biomechanics; update by Taylor, Pister and Goudreau 1970, doi 10.1002/nme.1620020106");
  const auto g = tag.parameter<Formulas>(
      "g",
      {.range = half_open(0, 1),
       .doc = "share of the instantaneous stress that each term loses, 0 where it does not act; their sum is below 1"});
  const auto tau =
      tag.parameter<Formulas>("tau", {.unit = "time", .range = positive(), .doc = "relaxation time of each term"});
  const auto given = tag.parameter<std::string>(
      "given", {.fallback = "instantaneous",
                .choices = {"instantaneous", "longTerm"},
                .doc = "which stiffness the law beside it has: that of a sudden load, or that after a long time"});
  fe::describe_fields(tag);
  tag.note(
      "The second Piola stress is the convolution of G(t) = 1 - sum g (1 - exp(-t / tau)) with the rate of the law's.");
  tag.note(
      "Time passes in statics too: each step takes dt times iterations, over which the loads grow. The stress of the "
      "law "
      "is taken as linear in time over each time step, or each of loadSteps: choose them shorter than tau.");
  tag.build([=](const Record& record) {
    fe::Prony series{numbers(record[g]), numbers(record[tau]), record[given] == "longTerm"};
    Faults faults(record);
    if (series.g.size() != series.tau.size())
      faults.add(fmt::format("prony: g has {} and tau {}: one of each per term",
                             counted(static_cast<long long>(series.g.size()), "number"), series.tau.size()));
    const double sum = std::accumulate(series.g.begin(), series.g.end(), 0.0);
    if (sum >= 1) faults.add(fmt::format("prony: the sum of g = {} is not < 1", sum));
    faults.raise();
    return series;
  });
  return tag;
}

}  // namespace msml::simulation
