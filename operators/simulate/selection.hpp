// SPDX-License-Identifier: GPL-3.0-or-later
// What an index set means on a body: nodes, boundary faces or elements.
#pragma once
#include <vector>

#include "msml/core/describe.hpp"
#include "msml/core/operator.hpp"
#include "operators/simulate/body.hpp"

namespace msml::simulation {

/// Throws Error unless every id is in the range of the mesh and the set counts things of the body's mesh. `record` is
/// the tag that the attribute `indices` stands on, for the message.
void check_indices(const Record& record, const IndexSet& set, const Mesh& mesh);

/// Solid nodes, with the position in the set that each came from.
struct NodeSelection {
  std::vector<int> nodes;
  std::vector<int> positions;  ///< #nodes; empty where nodes do not stand for entries of the set (faces, elements)
  int listed = 0;              ///< entries of the set
};

/// The nodes of a constraint: listed ones, or all those of the listed faces or elements. Points that belong to no
/// element are left out, with a note. Throws Error for an empty selection and for a node listed twice.
NodeSelection select_nodes(const Record& record, const Body& body, Reporter& reporter);

/// Boundary faces, in the order of the set where it lists faces.
struct FaceSelection {
  std::vector<fe::Face> faces;
  bool listed = false;  ///< one face for each entry of the set, in its order
};

/// The boundary faces of a load. Listed triangle cells are matched by their nodes, or by place where the triangles have
/// points of their own; listed nodes give the boundary faces with all corners among them. Throws Error for triangles
/// without a face (with their count) and for an empty selection.
FaceSelection select_faces(const Record& record, const Body& body);

/// The same for triangles of a separate surface mesh, matched by place.
FaceSelection select_faces_on(const Record& record, const Body& body, const Mesh& surface);

/// The elements of a region: listed ones, or those with all corners among the listed nodes.
std::vector<int> select_elements(const Record& record, const Body& body);

}  // namespace msml::simulation
