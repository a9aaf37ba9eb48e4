// SPDX-License-Identifier: GPL-3.0-or-later
// A second mesh embedded in the body.
#include "operators/simulate/conditions/condition.hpp"
#include "operators/simulate/records.hpp"
#include "operators/simulate/spots.hpp"
#include "solver/materials/linear_elastic.hpp"

namespace msml::simulation {
namespace {

/// The cells of the mesh that are embedded: its linear tetrahedra, or its quadratic ones.
Body inner_body(const Record& record, const std::shared_ptr<const Mesh>& mesh) {
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10})
    if (mesh->has(kind)) return make_body(mesh, kind);
  refuse(record, fmt::format("the mesh has no tetrahedra ({}); fill a surface with CGALMeshVolumeFromSurface first",
                             mesh->summary()));
}

/// Where each node of the inner body lies in the outer one. A node outside follows the element that is nearest in
/// shape, if it lies within a hundredth of the body's diagonal.
std::vector<fe::Tie> ties_of(const Record& record, const Body& inner, const Body& outer, Reporter& reporter) {
  const SpotFinder finder(outer);
  const double near = 0.01 * diagonal(*outer.mesh);
  std::vector<fe::Tie> ties(inner.solid.size());
  long long outside = 0;
  for (std::size_t n = 0; n < ties.size(); ++n) {
    if (!inner.solid[n]) continue;
    const Vec3 x = inner.mesh->points.row(static_cast<Eigen::Index>(n)).transpose();
    Spot spot = finder.find(x);
    if (spot.outside > 1e-8) {
      const double distance = distance_to(outer, x);
      if (distance > near)
        refuse(record, fmt::format("its node {} at {} lies {:.3g} outside the body, which spans {}; an embedded mesh "
                                   "lies inside, up to {:.3g}",
                                   n, place(x), distance, bounds(outer), near));
      ++outside;
    }
    ties[n] = {spot.element, std::move(spot.weights)};
  }
  if (outside > 0)
    reporter.warn(fmt::format("{}: {} just outside the body and follow the nearest element", located(record),
                              counted(outside, "node") + (outside == 1 ? " lies" : " lie")));
  return ties;
}

}  // namespace

ConditionFactory supporting_mesh() {
  ConditionFactory tag("supportingMesh", "constraint",
                       "A second mesh embedded in the main one, such as vessels or bone.");
  const auto young = tag.parameter("youngModulus", {.unit = "stress", .range = positive(), .doc = "of its material"});
  const auto poisson = tag.parameter("poissonRatio", {.range = open(-1, 0.5), .doc = "of its material"});
  const auto density = tag.parameter(
      "massDensity", {.unit = "mass/volume", .range = nonnegative(), .fallback = 0.0, .doc = "mass that it adds"});
  const auto mesh = tag.input<Mesh>("filename", "its tetrahedra, inside the body");
  tag.parameter<std::string>("forStep", {.optional = true, .doc = "it acts in all steps: name the only one, or none"});
  tag.note(
      "Its nodes move with the elements of the main mesh that hold them, so that it adds no unknowns: its forces, "
      "stiffness and mass come on top of those of the tissue in its place.");
  tag.note(
      "Its stresses act on the main mesh at its nodes: a uniform stress is met exactly where its linear elements nest "
      "in "
      "linear ones of the main mesh, else as its own elements shrink.");
  tag.note("Its material is linearElasticMaterial: of small strain where that of all regions is, else corotated.");
  tag.note(
      "Its forces, energy and mass count in sections, energies and the check; fields and volumes are those of the main "
      "mesh.");
  tag.build([=](const Record& record) -> ConditionBuilder {
    return [=, &record](const Body& body, Reporter& reporter) -> Condition {
      const Body inner = inner_body(record, record.share(mesh));
      const fe::LinearElastic data{.youngs_modulus = record[young],
                                   .poisson_ratio = record[poisson],
                                   .strain = body.small_strain ? fe::Strain::small : fe::Strain::corotated};
      fe::Inlay inlay;
      inlay.mesh = inner.mesh;
      inlay.region = {.name = label(record), .law = fe::make_linear_elastic(data), .density = record[density]};
      inlay.region.elements = inner.elements;
      inlay.ties = ties_of(record, inner, body, reporter);
      return {inlay};
    };
  });
  return tag;
}

}  // namespace msml::simulation
