// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of one state, made on demand.
#include "operators/simulate/state_fields.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "msml/core/error.hpp"
#include "solver/measure.hpp"

namespace msml::simulation {
namespace {

constexpr fe::ElementRequest of_the_law{.law = true, .J = false, .rotation = false};
constexpr fe::ElementRequest only_fibre_stretch{.law = false, .J = false, .rotation = false, .fibre_stretch = true};

/// The tensor whose eigenvalues a field has; "" of other fields.
std::string tensor_of(const std::string& field) {
  if (field == "principalStress") return "stress";
  if (field == "principalStrain") return "strain";
  if (field == "principalSmallStrain") return "smallStrain";
  return field == "principalGreenLagrange" ? "greenLagrange" : "";
}

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

std::vector<double> principal_values(const std::vector<double>& tensors) {
  std::vector<double> result;
  result.reserve(tensors.size() / 2);
  for (std::size_t i = 0; i + 5 < tensors.size(); i += 6) {
    const double* s = tensors.data() + i;
    Mat3 tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(tensor, Eigen::EigenvaluesOnly);
    for (int k = 2; k >= 0; --k) result.push_back(solver.eigenvalues()[k]);
  }
  return result;
}

std::vector<double> pressure_of(const std::vector<double>& stress) {
  std::vector<double> result(stress.size() / 6);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = -(stress[6 * i] + stress[6 * i + 1] + stress[6 * i + 2]) / 3;
  return result;
}

std::vector<double> StateFields::scalar() const {
  std::vector<double> values(static_cast<std::size_t>(body_.mesh->point_count()), 0);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (body_.solid[i]) values[i] = state_.displacement(static_cast<Eigen::Index>(i), 0);
  return values;
}

Points StateFields::displacement() const {
  Points moved = Points::Zero(body_.mesh->points.rows(), 3);
  if (body_.scalar) return moved;
  for (Eigen::Index i = 0; i < moved.rows(); ++i)
    if (body_.solid[static_cast<std::size_t>(i)]) moved.row(i) = state_.displacement.row(i);
  return moved;
}

Points StateFields::positions() const { return body_.mesh->points + displacement(); }

const fe::ElementResults& StateFields::law() {
  if (!law_) law_ = measure(of_the_law), std::vector<double>().swap(law_->strain);  // room that few scenes want
  return *law_;
}

const std::vector<double>& StateFields::strain() {
  if (!strain_) {
    fe::ElementResults found = measure(of_the_law);
    strain_ = std::move(found.strain);
    if (!law_) law_ = std::move(found);
  }
  return *strain_;
}

const fe::ElementResults& StateFields::tensors() {
  if (!tensors_) tensors_ = measure({.law = false, .J = false, .rotation = false, .tensors = true});
  return *tensors_;
}

std::vector<double> StateFields::J() const {
  std::vector<double> J = measure({.law = false, .J = true, .rotation = false}).J;
  // Cells without unknowns keep their volume.
  for (int c = 0; c < body_.mesh->cell_count(); ++c)
    if (body_.mesh->kinds[static_cast<std::size_t>(c)] != body_.kind) J[static_cast<std::size_t>(c)] = 1;
  return J;
}

std::vector<double> StateFields::at_elements(const std::string& name) {
  if (name == "stress") return law().cauchy;
  if (name == "strain") return strain();
  if (name == "energyDensity") return law().energy_density;
  if (name == "vonMises") return von_mises(law().cauchy);
  if (const std::string tensor = tensor_of(name); !tensor.empty()) return principal_values(at_elements(tensor));
  if (name == "smallStrain") return fe::small_strains(model_, state_);
  if (name == "pressure" || name == "hydrostaticPressure") return pressure_of(law().cauchy);
  if (name == "firstPiola") return tensors().first_piola;
  if (name == "secondPiola") return tensors().second_piola;
  if (name == "greenLagrange") return tensors().green_lagrange;
  if (name == "deformationGradient") return tensors().deformation_gradient;
  if (name == "J") return J();
  if (name == "fiberStretch") return measure(only_fibre_stretch).fibre_stretch;
  if (name == "region") return std::vector<double>(model_.mesh->regions.begin(), model_.mesh->regions.end());
  throw Error("no field '" + name + "'", {}, Failure::internal);
}

/// What is not linear in a tensor is taken of the recovered one.
std::vector<double> StateFields::recovered(const std::string& name) {
  if (name == "vonMises") return von_mises(recovered("stress"));
  if (const std::string tensor = tensor_of(name); !tensor.empty()) return principal_values(recovered(tensor));
  return fe::recover_at_nodes(model_, at_elements(name), facts_of(name, mixed()).components);
}

std::vector<double> StateFields::nodal(const std::string& name) {
  if (name == "displacement") return rows(displacement());
  if (name == "value") return scalar();
  if (name == "velocity") return rows(state_.velocity);
  if (name == "acceleration") return rows(state_.acceleration);
  if (name == "reaction") return rows(state_.reaction);
  if (is_multiplier(name)) return state_.pressure;
  return recovered(name.substr(0, name.size() - std::string("_nodal").size()));
}

bool StateFields::is_multiplier(const std::string& name) const {
  return mixed() && (name == "pressure" || name == "pressure_nodal");
}

double StateFields::multiplier(int cell, std::span<const double> weights) const {
  const fe::Numbering& numbering = state_.elements->numbering();
  const auto found = std::ranges::find(numbering.elements, cell);
  if (found == numbering.elements.end()) return 0;
  const auto element = static_cast<std::size_t>(found - numbering.elements.begin());
  const std::array<double, 10> pressures = fe::element_pressures(numbering, element, state_.acting_pressure);
  return std::inner_product(weights.begin(), weights.end(), pressures.begin(), 0.0);
}

Field StateFields::field(const std::string& name) {
  const FieldFacts facts = facts_of(name, mixed());
  return {name, facts.components, facts.nodal ? nodal(name) : at_elements(name)};
}

void StateFields::add_to(Mesh& mesh, const std::string& name) {
  if (name == "region") return;
  if (name == "displacement" && body_.scalar) return add_to(mesh, "value");
  (facts_of(name, mixed()).nodal ? mesh.point_fields : mesh.cell_fields).push_back(field(name));
}

}  // namespace msml::simulation
