// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of one state, made on demand.
#include "operators/simulate/state_fields.hpp"

#include <cmath>

#include "msml/core/error.hpp"

namespace msml::simulation {
namespace {

std::vector<double> rows(const Points& points) { return {points.data(), points.data() + points.size()}; }

}  // namespace

std::vector<double> von_mises(const std::vector<double>& stress) {
  std::vector<double> result(stress.size() / 6);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double* s = stress.data() + 6 * i;
    const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    result[i] = std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * shear);
  }
  return result;
}

Points StateFields::displacement() const {
  Points moved = Points::Zero(body_.mesh->points.rows(), 3);
  for (Eigen::Index i = 0; i < moved.rows(); ++i)
    if (body_.solid[static_cast<std::size_t>(i)]) moved.row(i) = state_.displacement.row(i);
  return moved;
}

Points StateFields::positions() const { return body_.mesh->points + displacement(); }

const fe::ElementResults& StateFields::elements() {
  if (elements_) return *elements_;
  elements_ = fe::element_results(model_, state_);
  // Cells without unknowns keep their volume.
  for (int c = 0; c < body_.mesh->cell_count(); ++c)
    if (body_.mesh->kinds[static_cast<std::size_t>(c)] != body_.kind) elements_->J[static_cast<std::size_t>(c)] = 1;
  return *elements_;
}

std::optional<Field> StateFields::point_field(const std::string& name) {
  if (name == "displacement") return Field{name, 3, rows(displacement())};
  if (name == "velocity") return Field{name, 3, rows(state_.velocity)};
  if (name == "acceleration") return Field{name, 3, rows(state_.acceleration)};
  if (name == "reaction") return Field{name, 3, rows(state_.reaction)};
  if (name == "stress_nodal") return Field{name, 6, fe::recover_at_nodes(model_, elements().cauchy, 6)};
  if (name == "strain_nodal") return Field{name, 6, fe::recover_at_nodes(model_, elements().strain, 6)};
  if (name == "vonMises_nodal") return Field{name, 1, von_mises(fe::recover_at_nodes(model_, elements().cauchy, 6))};
  return std::nullopt;
}

std::optional<Field> StateFields::cell_field(const std::string& name) {
  if (name == "stress") return Field{name, 6, elements().cauchy};
  if (name == "strain") return Field{name, 6, elements().strain};
  if (name == "vonMises") return Field{name, 1, von_mises(elements().cauchy)};
  if (name == "energyDensity") return Field{name, 1, elements().energy_density};
  if (name == "J") return Field{name, 1, elements().J};
  return std::nullopt;
}

void StateFields::add_to(Mesh& mesh, const std::string& name) {
  if (name == "region") return;
  if (auto field = point_field(name))
    mesh.point_fields.push_back(std::move(*field));
  else if (auto cells = cell_field(name))
    mesh.cell_fields.push_back(std::move(*cells));
  else
    throw Error("no field '" + name + "'", {}, Failure::internal);
}

}  // namespace msml::simulation
