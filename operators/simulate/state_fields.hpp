// SPDX-License-Identifier: GPL-3.0-or-later
// The named fields of one state of a simulation.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "operators/simulate/body.hpp"
#include "operators/simulate/fields.hpp"

namespace msml::simulation {

/// Fields of a state, each computed when first asked for.
class StateFields {
 public:
  StateFields(const fe::Model& model, const Body& body, const fe::State& state)
      : model_(model), body_(body), state_(state) {}

  /// Points of the mesh in the state: X + u; points of no element stay.
  Points positions() const;
  /// A field by its name, one of field_names() but "region": values at all points or all cells of the body's mesh.
  Field field(const std::string& name);
  /// True for the pressure of mixed elements: the unknown, which has a value of its own in each region.
  bool is_multiplier(const std::string& name) const;
  /// That pressure at a place in a cell, given by the weights of its ten nodes; 0 in cells without unknowns.
  double multiplier(int cell, std::span<const double> weights) const;
  /// Adds a field to the points or cells of a mesh with the body's points and cells. "region" adds nothing, since
  /// meshes carry it anyway; scalar problems add "value" in the place of "displacement".
  void add_to(Mesh& mesh, const std::string& name);
  /// Of all cells, what a request for measures of the elements asks for.
  fe::ElementResults measure(const fe::ElementRequest& request) const {
    return fe::element_results(model_, state_, request);
  }

 private:
  bool mixed() const { return model_.formulation == fe::Formulation::mixed; }
  Points displacement() const;
  std::vector<double> scalar() const;
  const fe::ElementResults& law();  ///< without strain
  const std::vector<double>& strain();
  const fe::ElementResults& tensors();
  std::vector<double> J() const;
  std::vector<double> nodal(const std::string& name);
  std::vector<double> at_elements(const std::string& name);
  std::vector<double> recovered(const std::string& name);

  const fe::Model& model_;
  const Body& body_;
  const fe::State& state_;
  std::optional<fe::ElementResults> law_, tensors_;
  std::optional<std::vector<double>> strain_;
};

/// Von Mises stress sqrt(3/2 s:s), s the deviator, of tensors of 6 components xx yy zz xy yz xz.
std::vector<double> von_mises(const std::vector<double>& stress);
/// Eigenvalues of such tensors, three each, the largest first.
std::vector<double> principal_values(const std::vector<double>& tensors);
/// Minus a third of the trace of such tensors.
std::vector<double> pressure_of(const std::vector<double>& stress);

}  // namespace msml::simulation
