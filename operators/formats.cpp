// SPDX-License-Identifier: GPL-3.0-or-later
// The file formats that the program reads and writes.
#include "msml/core/registry.hpp"

namespace msml::operators {

void add_formats(Registry&);

void add_formats(Registry&) {}

}  // namespace msml::operators
