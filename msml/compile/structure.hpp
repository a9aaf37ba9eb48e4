// SPDX-License-Identifier: GPL-3.0-or-later
// Tags of a document matched with their descriptions.
#pragma once
#include "msml/core/registry.hpp"
#include "msml/document/document.hpp"

namespace msml {

/// A tag that is known and stands where it may stand.
struct Tag {
  const Description* description = nullptr;
  const Element* element = nullptr;
  std::vector<Tag> children;
  std::vector<const Tag*> of_category(const std::string& category) const;
  const Tag* only(const std::string& category) const;  ///< the first of the category, or null
};

/// Matches the whole tree. Unknown or misplaced tags, too many or too few, and what is not available yet are faults.
Tag match_tags(const Registry& registry, const Document& document, std::vector<Fault>& faults);

}  // namespace msml
