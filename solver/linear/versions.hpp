// SPDX-License-Identifier: GPL-3.0-or-later
// Versions of the libraries that solve linear systems, each told by the file that calls it.
#pragma once
#include <string>

namespace msml::fe {

std::string suitesparse_version();  ///< "5.12.0", with that of CHOLMOD
std::string mumps_version();        ///< "5.5.1"
std::string openblas_version();     ///< release and kernels, as the library itself says

}  // namespace msml::fe
