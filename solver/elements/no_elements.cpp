// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes without elements.
#include "solver/elements/no_elements.hpp"

namespace msml::fe {
namespace {

class NoElements final : public Elements {
 public:
  explicit NoElements(const Model& model)
      : numbering_(number(model)), pattern_(make_pattern(numbering_.nodes(), {}, 1, numbering_.links)) {}
  Assembled add_internal(const Vector&, Want, Vector&, BlockMatrix* matrix) const override {
    if (matrix) matrix->set_zero();
    return {};
  }
  void add_mass(bool, ScalarMatrix&) const override {}
  std::size_t bytes() const override { return numbering_.bytes(); }
  void visit_points(const Vector&, const PointsVisitor&) const override {}
  const Numbering& numbering() const override { return numbering_; }
  const PatternPtr& pattern() const override { return pattern_; }

 private:
  Numbering numbering_;
  PatternPtr pattern_;
};

}  // namespace

std::unique_ptr<Elements> make_no_elements(const Model& model) { return std::make_unique<NoElements>(model); }

}  // namespace msml::fe
