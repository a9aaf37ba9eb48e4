// SPDX-License-Identifier: GPL-3.0-or-later
// The record of a simulation turned into the solver's model.
#pragma once
#include <string>
#include <vector>

#include "operators/simulate/body.hpp"
#include "operators/simulate/settings.hpp"
#include "operators/simulate/surroundings.hpp"

namespace msml::simulation {

/// All that a run needs.
struct Simulation {
  std::string name;  ///< id of the object, or "object"
  Location where;    ///< of the object
  Body body;
  fe::Model model;
  std::vector<OutputRequest> outputs;  ///< in document order
};

/// Builds the model from the record of the operator: `object`, `solver` and `simulation` below it. What old scenes may
/// do and new ones should not is warned of; what has no meaning throws Error at its tag's place. `threads` is used
/// where the solver tag says nothing.
Simulation build_model(const Record& args, Reporter& reporter, int threads);

/// The regions of a body: each element belongs to the last region that claims it; a single region extends to the whole
/// body; with several, elements that none claims are an Error that counts and locates them. Overlaps and regions
/// without elements are warned of.
/// A body of particles has point masses instead; see build_masses.
std::vector<fe::Region> build_regions(const std::vector<const Record*>& records, const Body& body, Reporter& reporter);

/// Tells, at the step's place, where it gives a gravity other than 0 to a scalar problem, or along an axis that
/// the elements (vertex: particles) do not move along.
void check_gravity(const Record& step, bool scalar, CellKind kind, const fe::Tell& tell = fe::raise);

/// Throws Error at the region's place where its indices, listed in place, count faces.
void check_region_indices(const Record& region);

/// Tells, where arc length is to follow the loads, of steps (at their places) all of whose loads are 0.
void check_arc_loads(const Record& args, const Surroundings& around, const fe::Tell& tell);

/// Tells, in statics, of steps (at their places) where gravity or a source alone pushes a body that no tag holds.
void check_held(const Record& args, const Surroundings& around, const fe::Tell& tell);

/// Its label, or "region2" for the second without one.
std::string region_name(const Record& region, std::size_t position);

/// Throws Error at the material's place where it is no law for elements, or no pointMass for particles.
void check_material(const Record& material, bool particles);

/// The masses of the particles of a body: the pointMass of the region that each belongs to.
std::vector<fe::PointMass> build_masses(const std::vector<const Record*>& records, const Body& body,
                                        Reporter& reporter);

/// A condition's tag with the step it acts in, "" = every.
struct Placed {
  const Record* record;
  std::string step;
};
/// The conditions under `root`, in document order: forStep of the tag wins over that of the constraint around it.
std::vector<Placed> placed_conditions(const Record& root);

/// The names of the steps under `root`: those of the scene, or step1, step2, ….
std::vector<std::string> step_names(const Record& root);

/// Throws Error at the condition's place where it acts in all steps, but names one of several.
void check_steps(const Placed& condition, const std::vector<std::string>& steps);

/// Adds the conditions under `root` to the model: initial states, and the others to the steps they act in: forStep of
/// the tag, else of the constraint around it, else every step. A name that is no step is warned of.
void add_conditions(const Record& root, const Body& body, Reporter& reporter, fe::Model& model);

}  // namespace msml::simulation
