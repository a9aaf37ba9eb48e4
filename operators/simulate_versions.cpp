// SPDX-License-Identifier: GPL-3.0-or-later
// Versions of the libraries that decide results.
#include <CGAL/version.h>
#include <fmt/format.h>
#include <tbb/version.h>
#include <vtkVersionMacros.h>

#include <Eigen/Core>

#include "operators/registry.hpp"
#include "solver/linear/versions.hpp"

namespace msml {

std::map<std::string, std::string> library_versions() {
  return {{"CGAL", CGAL_VERSION_STR},
          {"VTK", fmt::format("{}.{}.{}", VTK_MAJOR_VERSION, VTK_MINOR_VERSION, VTK_BUILD_VERSION)},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"SuiteSparse", fe::suitesparse_version()},
          {"MUMPS", fe::mumps_version()},
          {"OpenBLAS", fe::openblas_version()},
          {"oneTBB", TBB_VERSION_STRING},
          {"compiler", __VERSION__}};
}

}  // namespace msml
