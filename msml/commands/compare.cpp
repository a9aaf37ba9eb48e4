// SPDX-License-Identifier: GPL-3.0-or-later
// compare: differences of the fields of two meshes.
#include "msml/commands/commands.hpp"

namespace msml {

int compare_command(const Registry&, const CompareArguments&) { throw Error("compare is not available yet"); }

}  // namespace msml
