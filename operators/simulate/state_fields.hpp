// SPDX-License-Identifier: GPL-3.0-or-later
// The named fields of one state of a simulation.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "operators/simulate/body.hpp"

namespace msml::simulation {

/// Fields of a state, each computed when first asked for.
class StateFields {
 public:
  StateFields(const fe::Model& model, const Body& body, const fe::State& state)
      : model_(model), body_(body), state_(state) {}

  /// Points of the mesh in the state: X + u; points of no element stay.
  Points positions() const;
  /// Adds a field to the points or cells of a mesh with the body's points and cells. `name` is one of field_names();
  /// "region" adds nothing, since meshes carry it anyway.
  void add_to(Mesh& mesh, const std::string& name);

 private:
  Points displacement() const;
  const fe::ElementResults& elements();
  std::optional<Field> point_field(const std::string& name);
  std::optional<Field> cell_field(const std::string& name);

  const fe::Model& model_;
  const Body& body_;
  const fe::State& state_;
  std::optional<fe::ElementResults> elements_;
};

/// Von Mises stress sqrt(3/2 s:s), s the deviator, of `count` tensors of 6 components xx yy zz xy yz xz.
std::vector<double> von_mises(const std::vector<double>& stress);

}  // namespace msml::simulation
