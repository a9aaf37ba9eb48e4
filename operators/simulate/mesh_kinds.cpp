// SPDX-License-Identifier: GPL-3.0-or-later
// The tags that say which elements a mesh is used with, and the mass.
#include "operators/simulate/records.hpp"
#include "operators/simulate/settings.hpp"

namespace msml::simulation {
namespace {

constexpr const char* converter = "ConvertLinearToQuadraticTetrahedralMesh";

/// The linear kind for a quadratic one, and the other way round.
CellKind other_order(CellKind kind) {
  constexpr CellKind linear[] = {CellKind::vertex, CellKind::line2, CellKind::tri3, CellKind::tet4};
  constexpr CellKind quadratic[] = {CellKind::vertex, CellKind::line3, CellKind::tri6, CellKind::tet10};
  return kind == linear[dimension(kind)] ? quadratic[dimension(kind)] : linear[dimension(kind)];
}

void check_kind(const Record& record, const Mesh& mesh, CellKind wanted) {
  constexpr const char* nouns[] = {"", "lines", "triangles", "tetrahedra"};
  constexpr const char* makers[] = {"", "make them with GenerateSegmentMesh", "make them with GenerateRectangleMesh",
                                    "fill a surface with CGALMeshVolumeFromSurface first"};
  constexpr const char* quadratic_tags[] = {"", "quadraticLine", "quadraticTriangle", "quadraticTet"};
  const CellKind other = other_order(wanted);
  const int wrong = mesh.count(other);
  const bool up = node_count(wanted) > node_count(other), solid = dimension(wanted) == 3;
  if (wrong > 0 && up)
    refuse(record, fmt::format("the mesh has {} {} cells, but {} are needed{}", with_commas(wrong), name(other),
                               name(wanted), solid ? fmt::format("; convert it with {}", converter) : ""));
  if (wrong > 0)
    refuse(record, fmt::format("the mesh has {} {} cells, but {} are needed; use {}{}", with_commas(wrong), name(other),
                               name(wanted), quadratic_tags[dimension(wanted)],
                               solid ? fmt::format(", or the mesh before {}", converter) : ""));
  if (!mesh.has(wanted))
    refuse(record, fmt::format("the mesh has no {} ({}); {}", nouns[dimension(wanted)], mesh.summary(),
                               makers[dimension(wanted)]));
}

struct FormulationName {
  const char* name;
  fe::Formulation formulation;
  const char* doc;
};

/// What `formulation` may say for a kind of element; the first is the default.
std::vector<FormulationName> formulations(CellKind kind) {
  std::vector<FormulationName> found{{"standard", fe::Formulation::standard, "standard: isoparametric"}};
  if (kind == CellKind::tet4)
    found.push_back(
        {"fbar", fe::Formulation::fbar,
         "fbar: volume changes averaged over patches of about eight elements (mean dilatation, de Souza Neto, Andrade "
         "Pires and Owen 2005, doi 10.1002/nme.1187, in a form that has an energy, so that the tangent is symmetric), "
         "does not lock for poissonRatio near 0.5"});
  if (kind == CellKind::tet10)
    found.push_back(
        {"mixed", fe::Formulation::mixed,
         "mixed: with a pressure linear in each element (Taylor and Hood 1973, doi 10.1016/0045-7930(73)90027-3), for "
         "materials near incompressible or incompressible; the "
         "pressure is continuous inside a region and jumps between regions, so give what jumps a region of its own "
         "rather than an entry of `fields`"});
  if (kind == CellKind::tet10)
    found.push_back({"singleRotation", fe::Formulation::single_rotation,
                     "singleRotation: linear elasticity turned with the four corners, stiffness made once (tet10SR)"});
  return found;
}

void add_formulation(Description& tag, CellKind kind) {
  std::vector<std::string> names;
  std::string doc;
  for (const FormulationName& each : formulations(kind)) {
    names.emplace_back(each.name);
    doc += (doc.empty() ? "" : "; ") + std::string(each.doc);
  }
  tag.parameter<std::string>("formulation", {.fallback = names.front(), .choices = names, .doc = doc});
}

struct KindOfMesh {
  const char* tag;
  CellKind kind;
  const char* doc;
};

constexpr KindOfMesh kinds[] = {
    {"linearTet", CellKind::tet4, "Linear tetrahedra: constant strain, one point."},
    {"quadraticTet", CellKind::tet10, "Quadratic tetrahedra: linear strain, four points."},
    {"linearTriangle", CellKind::tri3, "Linear triangles in the plane: constant strain, one point."},
    {"quadraticTriangle", CellKind::tri6, "Quadratic triangles in the plane: three points."},
    {"triangularTet", CellKind::tri3, "MSML's older name of linearTriangle."},
    {"linearLine", CellKind::line2, "Linear elements on a line along x: one point."},
    {"quadraticLine", CellKind::line3, "Quadratic elements on a line along x: two points."}};

Factory<MeshChoice> kind_of_mesh(const KindOfMesh& facts) {
  Factory<MeshChoice> tag(facts.tag, "mesh", facts.doc);
  const CellKind kind = facts.kind;
  const auto mesh = tag.input<Mesh>("mesh", std::string("its ") + msml::name(kind) +
                                                " cells are the body; other cells are carried along to the results");
  add_formulation(tag, kind);
  if (kind == CellKind::tet10)
    tag.parameter<std::string>(
        "quadrature", {.fallback = "4",
                       .choices = {"4", "8"},
                       .doc = "points: 4 integrate straight elements exactly, 8 also the stresses of curved ones; 8 of "
                              "formulation standard and mixed"});
  Key<double> thickness;
  if (dimension(kind) == 2) {
    tag.parameter<std::string>("plane", {.fallback = "strain",
                                         .choices = {"strain", "stress"},
                                         .doc = "strain: held along z; stress: free to change its thickness"});
    tag.note("The triangles lie in a plane of constant z and run counter-clockwise seen from +z.");
  }
  if (dimension(kind) < 3)
    thickness = tag.parameter(dimension(kind) == 2 ? "thickness" : "crossSection",
                              {.unit = dimension(kind) == 2 ? "length" : "length^2",
                               .range = positive(),
                               .fallback = 1.0,
                               .doc = dimension(kind) == 2 ? "along z; forces are for all of it"
                                                           : "area across x; forces are for all of it"});
  if (dimension(kind) == 1)
    tag.note("The lines lie along x and do not strain across it: their stiffness is lambda + 2 mu.");
  tag.build([=](const Record& record) {
    check_kind(record, record[mesh], kind);
    MeshChoice choice = words_of_mesh(record);
    choice.mesh = record.share(mesh);
    if (dimension(kind) < 3) choice.thickness = record[thickness];
    return choice;
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
    check_mesh(record);
    if (record.has(mesh)) return MeshChoice{with_vertices(record[mesh].points), CellKind::vertex};
    const std::vector<double>& list = record[points];
    return MeshChoice{
        with_vertices(Eigen::Map<const Points>(list.data(), static_cast<Eigen::Index>(list.size() / 3), 3)),
        CellKind::vertex};
  });
  return tag;
}

}  // namespace

void check_mesh(const Record& record) {
  if (record.tag() != "particles") return;
  const auto given = [&](const char* name) {
    return record.given[static_cast<std::size_t>(record.description->find(name))];
  };
  if (given("mesh") == given("points")) refuse(record, "needs either mesh or points");
}

MeshChoice words_of_mesh(const Record& record) {
  MeshChoice choice{.mesh = nullptr, .kind = CellKind::vertex};
  for (const KindOfMesh& each : kinds)
    if (record.tag() == each.tag) choice.kind = each.kind;
  for (const FormulationName& each : formulations(choice.kind))
    if (text_of(record, "formulation") == each.name) choice.formulation = each.formulation;
  if (text_of(record, "quadrature") == "8") choice.quadrature = 8;
  if (text_of(record, "plane") == "stress") choice.plane = fe::Plane::stress;
  return choice;
}

std::vector<Factory<MeshChoice>> mesh_kinds() {
  std::vector<Factory<MeshChoice>> all;
  for (const KindOfMesh& each : kinds) all.push_back(kind_of_mesh(each));
  all.push_back(particles());
  return all;
}

Factory<double> mass() {
  Factory<double> tag("mass", "mass", "The density of a region.");
  const auto density =
      tag.parameter<Formula>("massDensity", {.unit = "mass/volume",
                                             .range = positive(),
                                             .fallback = 1.0,
                                             .doc = "per reference volume: a number, or an expression in X, Y, Z"});
  tag.parameter<std::string>(
      "fields", {.optional = true,
                 .doc = "\"massDensity=rho\": the density of each element from the cell field rho of the mesh"});
  tag.build([=](const Record& record) { return record[density].number; });
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
