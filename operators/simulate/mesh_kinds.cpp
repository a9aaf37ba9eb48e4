// SPDX-License-Identifier: GPL-3.0-or-later
// The tags that say which elements a mesh is used with, and the mass.
#include "operators/simulate/records.hpp"
#include "operators/simulate/settings.hpp"

namespace msml::simulation {
namespace {

constexpr const char* converter = "ConvertLinearToQuadraticTetrahedralMesh";

void check_kind(const Record& record, const Mesh& mesh, CellKind wanted) {
  const CellKind other = wanted == CellKind::tet4 ? CellKind::tet10 : CellKind::tet4;
  const int wrong = mesh.count(other);
  if (wrong > 0 && wanted == CellKind::tet10)
    refuse(record, fmt::format("the mesh has {} tet4 cells, but tet10 are needed; convert it with {}",
                               with_commas(wrong), converter));
  if (wrong > 0)
    refuse(record,
           fmt::format("the mesh has {} tet10 cells, but tet4 are needed; use quadraticTet, or the mesh before {}",
                       with_commas(wrong), converter));
  if (!mesh.has(wanted))
    refuse(record, fmt::format("the mesh has no tetrahedra ({}); fill a surface with CGALMeshVolumeFromSurface first",
                               mesh.summary()));
}

Factory<MeshChoice> tetrahedra(const char* name, CellKind kind, const std::string& doc) {
  Factory<MeshChoice> tag(name, "mesh", doc);
  const auto mesh = tag.input<Mesh>("mesh", std::string("its ") + msml::name(kind) +
                                                " cells are the body; other cells are carried along to the results");
  tag.parameter<std::string>("formulation",
                             {.fallback = "standard", .choices = {"standard"}, .doc = "standard: isoparametric"});
  tag.build([=](const Record& record) {
    check_kind(record, record[mesh], kind);
    return MeshChoice{record.share(mesh), kind};
  });
  return tag;
}

/// The points of a mesh, each with a cell of its own.
std::shared_ptr<const Mesh> with_vertices(const Points& points) {
  auto mesh = std::make_shared<Mesh>();
  mesh->points = points;
  for (int n = 0; n < mesh->point_count(); ++n) mesh->add_cell(CellKind::vertex, &n);
  return mesh;
}

Factory<MeshChoice> particles() {
  Factory<MeshChoice> tag("particles", "mesh", "Points with masses and no elements, for springs to hold.");
  const auto mesh = tag.input<Mesh>("mesh", "its points are the particles; its cells do not count", true);
  const auto points = tag.parameter<std::vector<double>>(
      "points",
      {.unit = "length", .optional = true, .multiple_of = 3, .doc = "the particles, x y z each, instead of a mesh"});
  tag.note("Their regions hold a pointMass instead of a law and a density.");
  tag.build([=](const Record& record) {
    if (record.has(mesh) == record.has(points)) refuse(record, "needs either mesh or points");
    if (record.has(mesh)) return MeshChoice{with_vertices(record[mesh].points), CellKind::vertex};
    const std::vector<double>& list = record[points];
    return MeshChoice{
        with_vertices(Eigen::Map<const Points>(list.data(), static_cast<Eigen::Index>(list.size() / 3), 3)),
        CellKind::vertex};
  });
  return tag;
}

}  // namespace

std::vector<Factory<MeshChoice>> mesh_kinds() {
  return {tetrahedra("linearTet", CellKind::tet4, "Linear tetrahedra: constant strain, one point."),
          tetrahedra("quadraticTet", CellKind::tet10, "Quadratic tetrahedra: linear strain, four points."),
          particles()};
}

Factory<double> mass() {
  Factory<double> tag("mass", "mass", "The density of a region.");
  const auto density = tag.parameter(
      "massDensity", {.unit = "mass/volume", .range = positive(), .fallback = 1.0, .doc = "per reference volume"});
  tag.build([=](const Record& record) { return record[density]; });
  return tag;
}

Factory<double> point_mass() {
  Factory<double> tag("pointMass", "material", "What particles are made of: a mass each, and no law.");
  const auto mass =
      tag.parameter("mass", {.unit = "mass", .range = positive(), .doc = "of each particle of the region"});
  tag.build([=](const Record& record) { return record[mass]; });
  return tag;
}

}  // namespace msml::simulation
