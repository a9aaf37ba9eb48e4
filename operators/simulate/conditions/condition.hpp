// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints and loads: what a tag of category "constraint" builds, and what their descriptions share.
#pragma once
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "msml/core/formula.hpp"
#include "operators/simulate/body.hpp"
#include "operators/simulate/selection.hpp"
#include "operators/simulate/surroundings.hpp"

namespace msml::simulation {

/// Displacements or velocities at the start of the simulation.
struct InitialState {
  bool velocity = false;  ///< or displacement
  std::vector<int> nodes;
  std::vector<Vec3> values;  ///< one per node
};

/// What acts on a body in the steps that list it; an initial state acts at the start, an inlay always.
struct Condition {
  std::variant<fe::Prescribed, fe::NodalForce, fe::FaceLoad, fe::BodyForce, fe::Slide, std::vector<fe::Spring>,
               InitialState, fe::Inlay>
      what;
  bool lasting = false;  ///< a displacement that holds in later steps too, where they say nothing of its nodes
};

/// Builds the condition on a body. Throws Error at the tag's place where its index set or its numbers do not fit.
using ConditionBuilder = std::function<Condition(const Body&, Reporter&)>;
using ConditionFactory = Factory<ConditionBuilder>;

/// One factory per available tag.
ConditionFactory fixed_constraint();
ConditionFactory displacement_constraint();
ConditionFactory force_constraint();
ConditionFactory surface_pressure();
ConditionFactory surface_pressure_on_mesh();
ConditionFactory surface_traction();
ConditionFactory body_force();
ConditionFactory symmetry_plane();
ConditionFactory roller();
ConditionFactory initial_velocity();
ConditionFactory initial_displacement();
ConditionFactory spring();
ConditionFactory spring_to_point();
ConditionFactory spring_mesh_to_fixed();
ConditionFactory fixed_value();
ConditionFactory flux();
ConditionFactory source();
ConditionFactory supporting_mesh();

/// All of the above.
std::vector<ConditionFactory> conditions();

/// Tells, at the condition's place, each reason why it has no meaning there: it is of displacements, but the unknown is
/// scalar, or the other way round; it acts on elements, but there are particles; it points out of the plane or the line
/// of the body; it ties a node to itself; it gives a velocity to what has no inertia.
void check_condition(const Record& condition, const Surroundings& around, const fe::Tell& tell = fe::raise);

/// Tells, at the condition's place, what arc length does not do with it: what changes with time, supports that move,
/// planes askew.
void check_along_an_arc(const Record& condition, const fe::Tell& tell);
/// Tells, at the tag's place, which of its numbers change with time, for arc length, which has none.
void check_timeless(const Record& record, const fe::Tell& tell);

/// The axis along which a vector lies, to 1e-12 of its length, or -1.
int axis_of(const Vec3& normal);

/// Tells, at the condition's place, where its numbers do not fit each other or the indices that the scene lists in
/// place; what other tasks give is not looked at.
void check_counts(const Record& condition, const fe::Tell& tell);

/// Throws Error where an initial velocity or, in dynamics, displacement changes volumes that a law keeps: its
/// divergence or det F - 1, by accurate differences, is clearly not zero at any of 51 fixed places of three scales.
/// `alone`: no other tag of its kind overwrites it somewhere.
void check_volumes(const Record& condition, const Surroundings& around, bool alone);

/// Throws Error unless the numbers of an attribute are one vector for all nodes (three numbers or expressions), or
/// three numbers for each of the nodes that `indices` lists; `listed` < 0: it is not known how many; `of_nodes`: it
/// counts nodes.
void check_per_node(const Record& record, const std::string& attribute, const Formulas& formulas, bool of_nodes,
                    int listed);
/// The same for pressures: one number or expression, a traction vector, or one number for each face that `indices`
/// lists.
void check_per_face(const Record& record, const std::string& attribute, const Formulas& formulas, bool of_faces,
                    int listed);

/// Attributes that every condition has.
struct CommonKeys {
  Key<IndexSet> indices;
  Key<std::string> for_step;
};
/// Adds `indices` (meaning nodes where the scene lists plain numbers, unless `indexes` says otherwise) and `forStep`.
CommonKeys add_common(Description& description, const std::string& doc, Indexed indexes = Indexed::nodes);

/// Adds `table`, a factor in time on the numbers of the tag, or on what `of` says; of either sign, or not below 0.
Key<std::vector<double>> add_table(Description& description, const std::string& of = "the numbers of this tag",
                                   bool signless = false);
/// The table as a function: linear between its times, constant outside; empty where the tag has none.
fe::TimeFunction read_table(const Record& record, Key<std::vector<double>> table);

/// Adds `components`, the axes that a prescribed displacement holds; absent = all three.
Key<Words> add_components(Description& description);
/// Sets prescribed.components from the attribute.
void read_components(const Record& record, Key<Words> components, fe::Prescribed& prescribed);

/// The label of the tag, or the tag itself.
std::string label(const Record& record);

/// What numbers or expressions mean at nodes.
struct NodeValues {
  std::vector<Vec3> values;     ///< one for all, or one per node of the selection
  fe::VectorFunction function;  ///< set where an expression depends on time; then `values` is empty
};
/// Three numbers or expressions for all, or three numbers for each listed node: the values for selection.nodes.
NodeValues per_node(const Record& record, Key<Formulas> key, const NodeSelection& selection, const Mesh& mesh);

/// Three functions as one.
fe::VectorFunction vector_of(const std::vector<Function>& parts);

/// A load on faces from one number or expression, one number per listed face, or three as a traction vector.
/// `follower` is for pressures.
fe::FaceLoad face_load(const Record& record, Key<Formulas> key, const FaceSelection& selection, bool follower);

/// The follower attribute, whose default depends on the law.
bool follows(const Record& record, Key<bool> follower, const Formulas& pressure, const Body& body);

}  // namespace msml::simulation
