// SPDX-License-Identifier: GPL-3.0-or-later
// Ties inner meshes to the unknowns of the body that holds them.
#include "solver/elements/inlaid_elements.hpp"

#include <algorithm>

namespace msml::fe {
namespace {

/// What an inner node follows.
struct Holder {
  int node;  ///< number in the body
  double weight;
};
using Holders = std::vector<Holder>;

Holders holders_of(const Mesh& body, const Tie& tie, const Numbering& numbering) {
  Holders holders;
  for (std::size_t a = 0; tie.element >= 0 && a < tie.weights.size(); ++a)
    if (tie.weights[a] != 0)
      holders.push_back({numbering.number_of[static_cast<std::size_t>(body.cell(tie.element)[a])], tie.weights[a]});
  return holders;
}

Model model_of(const Model& body, const Inlay& inlay) {
  Model model;
  model.mesh = inlay.mesh;
  model.regions = {inlay.region};
  model.settings = body.settings;
  return model;
}

/// One inlay, assembled in its own numbering.
class Inner {
 public:
  Inner(const Model& model, const Inlay& inlay, const Elements& body)
      : elements_(make_elements(model_of(model, inlay))), outer_(body.pattern()) {
    const Numbering& numbering = elements_->numbering();
    for (const int point : numbering.node_of)
      holders_.push_back(holders_of(*model.mesh, inlay.ties[static_cast<std::size_t>(point)], body.numbering()));
  }

  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const {
    Vector inner = Vector::Zero(3 * elements_->numbering().nodes()), inner_force = inner;
    for_holders([&](Eigen::Index n, const Holder& holder) {
      inner.segment<3>(3 * n) += holder.weight * u.segment<3>(3 * holder.node);
    });
    std::optional<BlockMatrix> K;
    if (matrix) K.emplace(elements_->pattern());
    Assembled found = elements_->add_internal(inner, want, inner_force, K ? &*K : nullptr);
    for_holders([&](Eigen::Index n, const Holder& holder) {
      force.segment<3>(3 * holder.node) += holder.weight * inner_force.segment<3>(3 * n);
    });
    if (K) spread(*elements_->pattern(), K->values, 9, matrix->values);
    return found;
  }

  void add_mass(bool lumped, ScalarMatrix& mass) const {
    ScalarMatrix inner(elements_->pattern());
    elements_->add_mass(lumped, inner);
    if (!lumped) return spread(*elements_->pattern(), inner.values, 1, mass.values);
    for (std::size_t n = 0; n < holders_.size(); ++n) {
      double sum = 0;
      for (const Holder& holder : holders_[n]) sum += std::max(0.0, holder.weight);
      const double own = inner.values[static_cast<std::size_t>(inner.pattern->diagonal[n])];
      for (const Holder& holder : holders_[n])
        mass.values[static_cast<std::size_t>(outer_->diagonal[static_cast<std::size_t>(holder.node)])] +=
            std::max(0.0, holder.weight) / sum * own;
    }
  }

  std::size_t bytes() const {
    std::size_t sum = elements_->bytes() + holders_.size() * sizeof(Holders);
    for (const Holders& holders : holders_) sum += holders.size() * sizeof(Holder);
    return sum;
  }

 private:
  template <class Visit>
  void for_holders(const Visit& visit) const {
    for (std::size_t n = 0; n < holders_.size(); ++n)
      for (const Holder& holder : holders_[n]) visit(static_cast<Eigen::Index>(n), holder);
  }

  /// outer += T^T inner T for matrices with `width` numbers per pair of nodes.
  void spread(const Pattern& pattern, const Numbers<double>& inner, std::size_t width, Numbers<double>& outer) const {
    for (std::size_t row = 0; row < holders_.size(); ++row)
      for (int p = pattern.offsets[row]; p < pattern.offsets[row + 1]; ++p) {
        const double* block = inner.data() + width * static_cast<std::size_t>(p);
        for (const Holder& left : holders_[row])
          for (const Holder& right : holders_[static_cast<std::size_t>(pattern.columns[static_cast<std::size_t>(p)])]) {
            const double weight = left.weight * right.weight;
            double* out = outer.data() + width * static_cast<std::size_t>(outer_->find(left.node, right.node));
            for (std::size_t k = 0; k < width; ++k) out[k] += weight * block[k];
          }
      }
  }

  std::unique_ptr<Elements> elements_;
  PatternPtr outer_;              ///< of the body
  std::vector<Holders> holders_;  ///< of each inner node, in the inner numbering
};

class InlaidElements final : public Elements {
 public:
  InlaidElements(const Model& model, std::unique_ptr<Elements> body) : body_(std::move(body)) {
    for (const Inlay& inlay : model.inlays) inner_.emplace_back(model, inlay, *body_);
  }
  Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const override {
    Assembled found = body_->add_internal(u, want, force, matrix);  // sets the matrix, to which the inner ones add
    for (const Inner& inner : inner_) {
      const Assembled more = inner.add_internal(u, want, force, matrix);
      found.energy += more.energy;
      found.finite = found.finite && more.finite;
    }
    return found;
  }
  void add_mass(bool lumped, ScalarMatrix& mass) const override {
    body_->add_mass(lumped, mass);
    for (const Inner& inner : inner_) inner.add_mass(lumped, mass);
  }
  void visit_points(const Vector& u, const PointsVisitor& visit) const override { body_->visit_points(u, visit); }
  void begin_step(double dt) override { body_->begin_step(dt); }
  void end_step(const Vector& u) override { body_->end_step(u); }
  std::shared_ptr<const std::vector<double>> history_stress() const override { return body_->history_stress(); }
  std::size_t bytes() const override {
    std::size_t sum = body_->bytes();
    for (const Inner& inner : inner_) sum += inner.bytes();
    return sum;
  }
  std::shared_ptr<const std::vector<double>> history_energy() const override { return body_->history_energy(); }
  double stored_beside() const override { return body_->stored_beside(); }
  Vector acting(const Vector& u) const override { return body_->acting(u); }
  const Numbering& numbering() const override { return body_->numbering(); }
  const PatternPtr& pattern() const override { return body_->pattern(); }

 private:
  std::unique_ptr<Elements> body_;
  std::vector<Inner> inner_;
};

}  // namespace

std::unique_ptr<Elements> make_inlaid_elements(const Model& model, std::unique_ptr<Elements> body) {
  return std::make_unique<InlaidElements>(model, std::move(body));
}

std::vector<std::array<int, 2>> inlay_links(const Model& model, const Numbering& numbering) {
  std::vector<std::array<int, 2>> links;
  for (const Inlay& inlay : model.inlays)
    for (const int element : inlay.region.elements) {
      std::vector<int> nodes;
      for (int a = 0; a < node_count(inlay.mesh->kinds[static_cast<std::size_t>(element)]); ++a)
        for (const Holder& holder :
             holders_of(*model.mesh, inlay.ties[static_cast<std::size_t>(inlay.mesh->cell(element)[a])], numbering))
          nodes.push_back(holder.node);
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t j = i + 1; j < nodes.size(); ++j) links.push_back({nodes[i], nodes[j]});
    }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

}  // namespace msml::fe
