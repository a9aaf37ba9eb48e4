// SPDX-License-Identifier: GPL-3.0-or-later
// Units of the columns of a study, in the labels of its scene.
#pragma once
#include <string>

namespace msml {

/// The unit of a field of results in the words of the descriptions: "length" for displacement, "stress", "1", …; "" for
/// a field that is not known.
std::string field_unit(const std::string& field);

/// A unit such as "force/length" in the labels of a scene, such as "mm N s MPa": "N/mm". Words for which there is no
/// label stay.
std::string in_labels(const std::string& unit, const std::string& labels);

}  // namespace msml
