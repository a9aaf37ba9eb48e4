// SPDX-License-Identifier: GPL-3.0-or-later
// ConvertLinearToQuadraticTetrahedralMesh: tet4 becomes tet10, with curved boundaries where a surface is given.
#include <fmt/format.h>

#include "msml/core/operator.hpp"
#include "operators/cgal_surface.hpp"
#include "operators/mesh_quadratic.hpp"
#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

void project(Mesh& mesh, const Surface& surface, Reporter& reporter) {
  const NearestPoint nearest(surface);
  const Projection done = project_mid_nodes(mesh, [&](const Vec3& p) { return nearest(p); });
  reporter.note(fmt::format("{} mid nodes of the boundary placed on the surface, the farthest moved by {:g}",
                            with_commas(done.moved), done.farthest));
  if (done.kept_straight > 0)
    reporter.warn(
        fmt::format("{} of {} mid nodes of the boundary stay on straight edges: bent ones would invert an element",
                    with_commas(done.kept_straight), with_commas(done.moved + done.kept_straight)));
}

}  // namespace

Operator convert_to_quadratic() {
  Operator op("ConvertLinearToQuadraticTetrahedralMesh", "Give every edge of a tetrahedral mesh a mid node.");
  op.source("mid nodes on edges; inversion is excluded by the Bernstein coefficients of the cubic Jacobian");
  const auto linear = op.input<Mesh>(
      "mesh", "tet4, or a flat mesh of triangles or lines; triangles and lines beside tet4 become quadratic too");
  const auto surface = op.input<Surface>(
      "projectOnto",
      "mid nodes of boundary edges move to its nearest points, except where an element would be inverted", true);
  const auto quadratic = op.output<Mesh>(
      "quadraticMesh", "tet10 in VTK's order; point ids, regions and fields kept, point fields interpolated");
  op.target("meshFilename", quadratic, "file to write the mesh to");
  op.note("MSML has this conversion in its library, without an operator.");
  op.run([=](Context& c) {
    const Mesh& given = c.get(linear);
    const bool flat = given.count(CellKind::tri3) + given.count(CellKind::line2) > 0 && !c.has(surface);
    if (given.count(CellKind::tet4) == 0 && !flat) require_tets(given, "ConvertLinearToQuadraticTetrahedralMesh");
    Mesh mesh = to_quadratic(given);
    if (c.has(surface)) project(mesh, c.get(surface), c.reporter());
    c.set(quadratic, std::move(mesh));
  });
  return op;
}

}  // namespace msml::operators
