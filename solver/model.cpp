// SPDX-License-Identifier: GPL-3.0-or-later
// Refuses models that cannot be solved, in words for the person who wrote the scene.
#include "solver/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "msml/core/error.hpp"
#include "solver/combinations.hpp"
#include "solver/conditions/rigid.hpp"
#include "solver/elements/assembly.hpp"
#include "solver/elements/shapes.hpp"
#include "solver/materials/law.hpp"

namespace msml::fe {
namespace {

Vec3 centre(const Mesh& mesh, int cell) {
  Vec3 sum = Vec3::Zero();
  const int corners = corner_count(mesh.kinds[static_cast<std::size_t>(cell)]);
  for (int a = 0; a < corners; ++a) sum += mesh.points.row(mesh.cell(cell)[a]).transpose() / corners;
  return sum;
}

std::string place(const Vec3& x) { return fmt::format("({:g} {:g} {:g})", x[0], x[1], x[2]); }

void check_region(const Model& model, const Region& region, CellKind& kind, bool& known) {
  const Mesh& mesh = *model.mesh;
  if (!region.law) throw Error(fmt::format("region '{}' has no material law", region.name));
  const bool dynamic = is_dynamic(model.settings.integrator);
  if (!std::isfinite(region.density) || region.density < 0 || (dynamic && region.density == 0))
    throw Error(fmt::format("region '{}': massDensity = {} is not {}", region.name, region.density,
                            dynamic ? "> 0, as a dynamic simulation needs" : ">= 0"));
  for (const int e : region.elements) {
    if (e < 0 || e >= mesh.cell_count())
      throw Error(fmt::format("region '{}' names element {}, but the mesh has cells 0 to {}", region.name, e,
                              mesh.cell_count() - 1));
    const CellKind found = mesh.kinds[static_cast<std::size_t>(e)];
    if (found == CellKind::vertex)
      throw Error(fmt::format("region '{}' names cell {}, a vertex; a material needs lines, triangles or tetrahedra",
                              region.name, e));
    if (known && found != kind)
      throw Error(fmt::format("cell {} is a {}, others are {}: one mesh kind at a time", e, name(found), name(kind)));
    kind = found;
    known = true;
  }
}

void check_regions(const Model& model) {
  const Mesh& mesh = *model.mesh;
  std::vector<const Region*> owner(mesh.kinds.size(), nullptr);
  CellKind kind = CellKind::tet4;
  bool known = false;
  for (const Region& region : model.regions) {
    check_region(model, region, kind, known);
    for (const int e : region.elements) {
      const Region*& other = owner[static_cast<std::size_t>(e)];
      if (other)
        throw Error(fmt::format("element {} at {} is in region '{}' and in region '{}'", e, place(centre(mesh, e)),
                                other->name, region.name));
      other = &region;
    }
  }
  for (const PointMass& point : model.point_masses) {
    if (point.node < 0 || point.node >= mesh.point_count())
      throw Error(fmt::format("a point mass names node {}, but the mesh has nodes 0 to {}", point.node,
                              mesh.point_count() - 1));
    check_number("a point mass", point.mass, false);
  }
  if (!known && model.point_masses.empty()) throw Error("no region has an element: nothing to simulate");
  int lost = 0, first = -1;
  for (int e = 0; e < mesh.cell_count(); ++e)
    if (mesh.kinds[static_cast<std::size_t>(e)] == kind && !owner[static_cast<std::size_t>(e)] && lost++ == 0)
      first = e;
  if (lost > 0)
    throw Error(fmt::format("{} {} are in no material region, the first is element {} at {}", lost,
                            dimension(kind) == 3 ? "tetrahedra" : fmt::format("{} cells", name(kind)), first,
                            place(centre(mesh, first))));
}

/// Lines must lie along x and triangles in a plane of constant z, since the solver takes the other coordinates as
/// directions without displacement.
void check_flat(const Model& model) {
  const Mesh& mesh = *model.mesh;
  int first = -1;
  double size = 0;
  for (const Region& region : model.regions)
    for (const int e : region.elements) {
      const int count = node_count(mesh.kinds[static_cast<std::size_t>(e)]);
      const int* nodes = mesh.cell(e);
      if (first < 0) first = nodes[0];
      for (int a = 0; a < count; ++a)
        size = std::max(size, (mesh.points.row(nodes[a]) - mesh.points.row(first)).cwiseAbs().maxCoeff());
      for (int a = 0; a < count; ++a)
        for (int c = dimension(element_kind(model)); c < 3; ++c)
          if (std::abs(mesh.points(nodes[a], c) - mesh.points(first, c)) > 1e-9 * size)
            throw Error(fmt::format(
                "node {} at {} and node {} at {} differ in {}: {}", first, place(mesh.points.row(first).transpose()),
                nodes[a], place(mesh.points.row(nodes[a]).transpose()), "xyz"[c],
                dimension(element_kind(model)) == 1 ? "lines lie along x, with the same y and z"
                                                    : "triangles as elements lie in a plane of the same z"));
    }
}

/// Smallest det(dX/dxi) at the quadrature points and the corners, relative to that power of the longest edge.
template <int dimension, int nodes>
double reference_shape(const Mesh& mesh, int cell) {
  const int* ids = mesh.cell(cell);
  double longest = 0, smallest = std::numeric_limits<double>::infinity();
  for (int a = 0; a <= dimension; ++a)
    for (int b = 0; b < a; ++b) longest = std::max(longest, (mesh.points.row(ids[a]) - mesh.points.row(ids[b])).norm());
  Rule<dimension> places = stiffness_rule<dimension, nodes>();
  places.push_back({{}, 0});
  for (std::size_t d = 0; d < dimension; ++d) {
    places.push_back({{}, 0});
    places.back().xi[d] = 1;
  }
  for (const auto& q : places)
    smallest = std::min(smallest, jacobian<dimension, nodes>(mesh.points, ids, q.xi).determinant());
  return longest > 0 ? smallest / std::pow(longest, dimension) : 0;
}

double reference_shape(const Mesh& mesh, int cell) {
  switch (mesh.kinds[static_cast<std::size_t>(cell)]) {
    case CellKind::line2:
      return reference_shape<1, 2>(mesh, cell);
    case CellKind::line3:
      return reference_shape<1, 3>(mesh, cell);
    case CellKind::tri3:
      return reference_shape<2, 3>(mesh, cell);
    case CellKind::tri6:
      return reference_shape<2, 6>(mesh, cell);
    case CellKind::tet4:
      return reference_shape<3, 4>(mesh, cell);
    default:
      return reference_shape<3, 10>(mesh, cell);
  }
}

void check_shapes(const Model& model) {
  const Mesh& mesh = *model.mesh;
  constexpr const char* powers[] = {"", "that", "the square", "the cube"};
  constexpr const char* hints[] = {"", "; lines run from small to large x",
                                   "; triangles run counter-clockwise seen from +z", ""};
  const int mesh_dimension = dimension(element_kind(model));
  int bad = 0, worst = -1;
  double smallest = 1e-12;  // flatter than this, the gradients have no correct digits left
  for (const Region& region : model.regions)
    for (const int e : region.elements) {
      const double shape = reference_shape(mesh, e);
      if (shape >= 1e-12) continue;
      ++bad;
      if (worst < 0 || shape < smallest) worst = e, smallest = shape;
    }
  if (bad > 0)
    throw Error(
        fmt::format("{} elements are inverted or flat in the reference mesh; the worst is element {} at {}: its "
                    "Jacobian is {:g} times {} of its longest edge{}",
                    bad, worst, place(centre(mesh, worst)), smallest, powers[mesh_dimension], hints[mesh_dimension]));
}

void check_nodes(const Mesh& mesh, const char* what, const std::string& label, const std::vector<int>& nodes,
                 const std::vector<Vec3>& values, bool by_function) {
  for (const int n : nodes)
    if (n < 0 || n >= mesh.point_count())
      throw Error(
          fmt::format("{} '{}' names node {}, but the mesh has nodes 0 to {}", what, label, n, mesh.point_count() - 1));
  if (!by_function && values.size() != 1 && values.size() != nodes.size())
    throw Error(fmt::format("{} '{}' has {} values for {} nodes: one for all, or one each", what, label, values.size(),
                            nodes.size()));
  for (const Vec3& v : values)
    if (!v.allFinite()) throw Error(fmt::format("{} '{}' has a value that is not finite: {}", what, label, place(v)));
}

void check_face_values(const FaceLoad& load) {
  const bool by_function = load.traction_function || load.pressure_function;
  if (by_function) return;
  const std::size_t count = load.pressures.empty() ? load.tractions.size() : load.pressures.size();
  if (!load.pressures.empty() && !load.tractions.empty())
    throw Error(fmt::format("load '{}' has both pressures and tractions", load.name));
  if (count != 1 && count != load.faces.size())
    throw Error(fmt::format("load '{}' has {} values for {} faces: one for all, or one each", load.name, count,
                            load.faces.size()));
  for (const double p : load.pressures)
    if (!std::isfinite(p)) throw Error(fmt::format("load '{}' has pressure {}", load.name, p));
  for (const Vec3& t : load.tractions)
    if (!t.allFinite()) throw Error(fmt::format("load '{}' has traction {}", load.name, place(t)));
}

void check_face_load(const Model& model, const FaceLoad& load) {
  const Mesh& mesh = *model.mesh;
  for (const Face& face : load.faces)
    if (face.element < 0 || face.element >= mesh.cell_count() || face.local < 0 ||
        mesh.kinds[static_cast<std::size_t>(face.element)] != element_kind(model) ||
        face.local >= side_count(element_kind(model)))
      throw Error(fmt::format("load '{}' names face {} of cell {}, which is no side of an element (a {})", load.name,
                              face.local, face.element, name(element_kind(model))));
  check_face_values(load);
}

void check_body_force(const Mesh& mesh, const BodyForce& force) {
  for (const int e : force.elements)
    if (e < 0 || e >= mesh.cell_count())
      throw Error(fmt::format("body force '{}' names element {}, but the mesh has cells 0 to {}", force.name, e,
                              mesh.cell_count() - 1));
  if (!force.value.allFinite())
    throw Error(fmt::format("body force '{}' is not finite: {}", force.name, place(force.value)));
}

void check_spring(const Mesh& mesh, const Spring& spring) {
  for (const int node : {spring.first, spring.second})
    if (node >= mesh.point_count() || (node < 0 && node == spring.first))
      throw Error(fmt::format("spring '{}' names node {}, but the mesh has nodes 0 to {}", spring.name, node,
                              mesh.point_count() - 1));
  if (spring.first == spring.second) throw Error(fmt::format("spring '{}' has two ends at one node", spring.name));
  check_number(("stiffness of spring '" + spring.name + "'").c_str(), spring.stiffness, true);
  check_number(("damping of spring '" + spring.name + "'").c_str(), spring.damping, true);
  check_number(("rest length of spring '" + spring.name + "'").c_str(), spring.rest, true);
  if (!spring.point.allFinite()) throw Error(fmt::format("spring '{}' has no finite end", spring.name));
}

void check_inlay(const Model& model, const Inlay& inlay) {
  const std::string& label = inlay.region.name;
  if (dimension(element_kind(model)) != 3 || is_scalar(model))
    throw Error(fmt::format("'{}' embeds a mesh, which needs a body of tetrahedra with displacements", label));
  if (!inlay.mesh) throw Error(fmt::format("'{}' has no mesh", label));
  inlay.mesh->check();
  CellKind kind = CellKind::tet4;
  bool known = false;
  Model alone;  // static, where a density of 0 will do
  alone.mesh = inlay.mesh;
  alone.settings.integrator = Integrator::static_;
  check_region(alone, inlay.region, kind, known);
  if (!known || dimension(kind) != 3) throw Error(fmt::format("the mesh of '{}' has no tetrahedra", label));
  if (!inlay.region.prony.g.empty()) throw Error(fmt::format("'{}' is elastic: it takes no prony", label));
  if (inlay.ties.size() != static_cast<std::size_t>(inlay.mesh->point_count()))
    throw Error(fmt::format("'{}' has {} ties for {} nodes", label, inlay.ties.size(), inlay.mesh->point_count()));
  const auto nodes = static_cast<std::size_t>(node_count(element_kind(model)));
  for (const Tie& tie : inlay.ties)
    if (tie.element >= model.mesh->cell_count() || (tie.element >= 0 && tie.weights.size() != nodes))
      throw Error(fmt::format("'{}' has a tie to element {} with {} weights", label, tie.element, tie.weights.size()));
  for (const int e : inlay.region.elements)
    for (int a = 0; a < node_count(kind); ++a)
      if (inlay.ties[static_cast<std::size_t>(inlay.mesh->cell(e)[a])].element < 0)
        throw Error(fmt::format("node {} of '{}' is tied to nothing", inlay.mesh->cell(e)[a], label));
}

void check_initial(const Model& model, const char* what, const Points& values) {
  if (values.rows() == 0) return;
  if (values.rows() != model.mesh->points.rows())
    throw Error(fmt::format("the initial {} has {} rows for {} nodes", what, values.rows(), model.mesh->points.rows()));
  if (!values.allFinite()) throw Error(fmt::format("the initial {} is not finite", what));
}

void check_step(const Model& model, const Step& step) {
  check_number(("dt of step '" + step.name + "'").c_str(), step.dt, false);
  check_number(("iterations of step '" + step.name + "'").c_str(), step.count, false);
  if (!step.gravity.allFinite())
    throw Error(fmt::format("gravity of step '{}' is not finite: {}", step.name, place(step.gravity)));
  for (const Prescribed& p : step.prescribed)
    check_nodes(*model.mesh, "constraint", p.name, p.nodes, p.values, static_cast<bool>(p.function));
  for (const NodalForce& f : step.forces)
    check_nodes(*model.mesh, "force", f.name, f.nodes, f.values, static_cast<bool>(f.function));
  for (const FaceLoad& load : step.face_loads) check_face_load(model, load);
  for (const BodyForce& force : step.body_forces) check_body_force(*model.mesh, force);
  for (const Slide& slide : step.slides) {
    check_nodes(*model.mesh, "plane", slide.name, slide.nodes, {slide.normal}, false);
    if (!(slide.normal.norm() > 0)) throw Error(fmt::format("the normal of '{}' has no direction", slide.name));
  }
  for (const Spring& spring : step.springs) check_spring(*model.mesh, spring);
}

}  // namespace

void Model::check() const {
  if (!mesh) throw Error("the model has no mesh");
  mesh->check();
  check_settings(settings);
  check_regions(*this);
  check_elements(*this, element_kind(*this));
  for (const Region& region : regions) {
    check_same_unknown(regions.front(), region);
    check_law(*this, region);
    check_prony(*this, region);
  }
  check_problem(*this);
  check_preconditioner(*this, element_kind(*this));
  check_flat(*this);
  check_shapes(*this);
  for (const Inlay& inlay : inlays) check_inlay(*this, inlay);
  check_initial(*this, "displacement", initial_displacement);
  check_initial(*this, "velocity", initial_velocity);
  if (steps.empty()) throw Error("the simulation has no step");
  for (const Step& step : steps) check_step(*this, step);
}

}  // namespace msml::fe
