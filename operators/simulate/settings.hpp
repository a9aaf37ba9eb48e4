// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptions of what stands around the conditions: mesh kinds, mass, solver, steps and output requests.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msml/core/operator.hpp"
#include "solver/model.hpp"

namespace msml::simulation {

/// A mesh with the kind of element that the scene asks for.
struct MeshChoice {
  std::shared_ptr<const Mesh> mesh;
  CellKind kind = CellKind::tet4;
  fe::Formulation formulation = fe::Formulation::standard;
  int quadrature = 4;
  fe::Plane plane = fe::Plane::strain;
  double thickness = 1;  ///< of triangles; cross-section of lines
};
/// linearTet, quadraticTet, linearTriangle, quadraticTriangle, triangularTet, linearLine and quadraticLine. Building
/// throws Error unless all cells of that dimension are of the kind, and there are some.
std::vector<Factory<MeshChoice>> mesh_kinds();

/// What the tag of a mesh says, without the mesh and the thickness: kind (vertex of particles), formulation, quadrature
/// and plane.
MeshChoice words_of_mesh(const Record& record);

/// Throws Error at the place of the tag where it is of particles and says both mesh and points, or neither.
void check_mesh(const Record& record);

/// The tag `mass`: mass per reference volume.
Factory<double> mass();
/// The tag `pointMass`: the mass of each particle of a region.
Factory<double> point_mass();

/// The tag `prony`: a region's viscoelasticity.
Factory<fe::Prony> prony();

/// Settings of the solver; what is accepted for old scenes is noted. `threads` is used where the scene says nothing.
using SettingsBuilder = std::function<fe::Settings(Reporter&, int threads)>;
Factory<SettingsBuilder> solver();

/// Throws Error at the solver's place where an explicit integrator is asked for a full mass matrix.
void check_mass_matrix(const Record& solver, const fe::Settings& settings);

/// A step without conditions.
Factory<fe::Step> step();

/// series: the deformed mesh with fields; probe: a field at a place; energies: sums over the body; section: area, force
/// and moment on a plane; volume: of the regions.
enum class OutputKind { series, probe, energies, section, volume };

/// What is written of a simulation.
struct OutputRequest {
  std::string id;                   ///< start of the file names
  int every = 1;                    ///< states 0, every, 2 every, … and the last
  std::vector<std::string> fields;  ///< in the order written; of a series always with "displacement"; of a probe one
  Location where;
  OutputKind kind = OutputKind::series;
  /// Of a probe, a place in the reference configuration, or the start of a line (absent: its indices count); of a
  /// section.
  std::optional<Vec3> point;
  Vec3 end = Vec3::Zero();         ///< of the line of a probe
  int count = 1;                   ///< of a probe: places on the line
  Vec3 normal = Vec3::UnitX();     ///< of a section, of any length but 0
  const Record* record = nullptr;  ///< of a probe or section: its tag
  bool wants(const std::string& field) const;
};
/// `displacement` (as in MSML), `result` (any fields), `probe`, `energies`, `section` and `volume`.
std::vector<Factory<OutputRequest>> outputs();

/// Tags of the language that parse but are refused for now.
std::vector<Description> future_tags();

}  // namespace msml::simulation
