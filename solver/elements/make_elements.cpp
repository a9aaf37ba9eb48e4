// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the elements of a model by mesh kind and formulation.
#include <algorithm>

#include "solver/elements/inlaid_elements.hpp"
#include "solver/elements/mixed_elements.hpp"
#include "solver/elements/no_elements.hpp"
#include "solver/elements/patch_elements.hpp"
#include "solver/elements/simplex_elements.hpp"
#include "solver/elements/single_rotation.hpp"

namespace msml::fe {
namespace {

std::unique_ptr<Elements> standard_elements(const Model& model, CellKind kind) {
  switch (kind) {
    case CellKind::vertex:
      return make_no_elements(model);
    case CellKind::line2:
      return std::make_unique<SimplexElements<1, 2>>(model);
    case CellKind::line3:
      return std::make_unique<SimplexElements<1, 3>>(model);
    case CellKind::tri3:
      return std::make_unique<SimplexElements<2, 3>>(model);
    case CellKind::tri6:
      return std::make_unique<SimplexElements<2, 6>>(model);
    case CellKind::tet4:
      return std::make_unique<SimplexElements<3, 4>>(model);
    default:
      if (model.quadrature == 8) return std::make_unique<SimplexElements<3, 10, 8>>(model);
      return std::make_unique<SimplexElements<3, 10>>(model);
  }
}

std::unique_ptr<Elements> elements_of_body(const Model& model) {
  if (model.formulation == Formulation::single_rotation) return make_single_rotation_elements(model);
  if (model.formulation == Formulation::mixed && model.quadrature == 8)
    return std::make_unique<MixedElements<8>>(model);
  if (model.formulation == Formulation::mixed) return std::make_unique<MixedElements<4>>(model);
  if (model.formulation == Formulation::fbar) return std::make_unique<PatchElements>(model);
  return standard_elements(model, element_kind(model));
}

}  // namespace

CellKind element_kind(const Model& model) {
  for (const Region& region : model.regions)
    if (!region.elements.empty()) return model.mesh->kinds[static_cast<std::size_t>(region.elements.front())];
  return CellKind::vertex;
}

bool is_scalar(const Model& model) {
  return std::any_of(model.regions.begin(), model.regions.end(), [](const Region& region) {
    return !region.elements.empty() && region.law && region.law->components() == 1;
  });
}

int components(const Model& model) {
  const int dimension = msml::dimension(element_kind(model));
  return is_scalar(model) ? 1 : dimension == 0 ? 3 : dimension;
}

std::unique_ptr<Elements> make_elements(const Model& model) {
  std::unique_ptr<Elements> body = elements_of_body(model);
  return model.inlays.empty() ? std::move(body) : make_inlaid_elements(model, std::move(body));
}

}  // namespace msml::fe
