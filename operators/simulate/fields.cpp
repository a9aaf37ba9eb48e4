// SPDX-License-Identifier: GPL-3.0-or-later
// The list of fields.
#include "operators/simulate/fields.hpp"

#include "msml/core/error.hpp"

namespace msml::simulation {
namespace {

std::vector<FieldFacts> with_nodal() {
  std::vector<FieldFacts> all{
      {"displacement", 3, true, "x - X"},
      {"value", 1, true, "the unknown of a scalar problem, written in the place of displacement"},
      {"velocity", 3, true, "rate of the displacement"},
      {"acceleration", 3, true, "rate of the velocity"},
      {"reaction", 3, true, "force of the constraints on the body; zero where it is free"},
      {"stress", 6, false, "Cauchy's stress"},
      {"vonMises", 1, false, "equivalent stress sqrt(3/2 s:s), s the deviator of stress"},
      {"principalStress", 3, false, "eigenvalues of stress, the largest first"},
      {"pressure", 1, false,
       "minus a third of the trace of stress; of formulation=\"mixed\" at nodes: the unknown multiplier, minus the "
       "derivative of the volumetric energy by its measure of volume, linear in each element; at nodes where regions "
       "meet the mean of theirs, at a point that of the region around it. pressure_nodal is the same there. It is not "
       "minus a third of the trace of stress where that measure is not J (J times as much by ln J) or where the rest "
       "of the law has a trace: that is hydrostaticPressure"},
      {"hydrostaticPressure", 1, false, "minus a third of the trace of stress, of formulation=\"mixed\" too"},
      {"firstPiola", 9, false, "first Piola stress: force per reference area; of strain=\"small\" stress"},
      {"secondPiola", 6, false, "second Piola stress F^-1 P; of strain=\"small\" stress"},
      {"strain", 6, false,
       "the strain of the law: U - I (corotated), the symmetric gradient (small), greenLagrange otherwise"},
      {"principalStrain", 3, false, "eigenvalues of strain, the largest first"},
      {"smallStrain", 6, false, "the symmetric gradient of the displacement, (F + F^T)/2 - I, of every law"},
      {"principalSmallStrain", 3, false, "eigenvalues of smallStrain, the largest first"},
      {"greenLagrange", 6, false, "Green-Lagrange strain (F^T F - I)/2"},
      {"principalGreenLagrange", 3, false, "eigenvalues of greenLagrange, the largest first"},
      {"deformationGradient", 9, false, "F = dx/dX"},
      {"J", 1, false, "smallest det F of the element"},
      {"energyDensity", 1, false, "stored energy per reference volume"},
      {"fiberStretch", 1, false, "length over reference length of the first family of fibres; 1 where there is none"}};
  const std::size_t count = all.size();
  for (std::size_t i = 0; i < count; ++i)
    if (!all[i].nodal && all[i].name != "J")
      all.push_back({all[i].name + "_nodal", all[i].components, true, all[i].name + " recovered at nodes"});
  all.push_back({"region", 1, false, "number of the region; always there"});
  return all;
}

}  // namespace

const std::vector<FieldFacts>& all_fields() {
  static const std::vector<FieldFacts> fields = with_nodal();
  return fields;
}

const std::vector<std::string>& field_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const FieldFacts& facts : all_fields()) list.push_back(facts.name);
    return list;
  }();
  return names;
}

FieldFacts facts_of(const std::string& field, bool mixed) {
  for (FieldFacts facts : all_fields()) {
    if (facts.name != field) continue;
    facts.nodal = facts.nodal || (mixed && field == "pressure");
    return facts;
  }
  throw Error("no field '" + field + "'", {}, Failure::internal);
}

std::vector<std::string> component_names(const FieldFacts& facts) {
  if (facts.name.starts_with("principal")) return {"1", "2", "3"};
  switch (facts.components) {
    case 3:
      return {"x", "y", "z"};
    case 6:
      return {"xx", "yy", "zz", "xy", "yz", "xz"};
    case 9:
      return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    default:
      return {""};
  }
}

}  // namespace msml::simulation
