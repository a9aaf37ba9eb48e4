// SPDX-License-Identifier: GPL-3.0-or-later
// The tag solver of the real language: text in, message out.
#include <gtest/gtest.h>

#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

/// Faults of a scene with this solver on line 2.
std::string faults(const std::string& attributes) {
  const std::string scene =
      "<msml><environment>\n<solver " + attributes +
      "/>\n<simulation><step name=\"s\"/></simulation></environment><scene><object>"
      "<mesh><linearTet mesh=\"${b}\"/></mesh><material><region indices=\"${i}\"><linearElasticMaterial "
      "youngModulus=\"1\" poissonRatio=\"0.3\"/></region></material></object></scene><workflow>"
      "<GenerateBoxMesh id=\"b\" size=\"1 1 1\" divisions=\"1 1 1\"/>"
      "<ComputeIndicesFromBoxROI id=\"i\" mesh=\"${b}\" select=\"elements\" box=\"0 0 0 1 1 1\"/>"
      "</workflow></msml>";
  return tiny::lines(
      compile_text(scene, "/nonexistent/s.xml", real_language(), {.output_folder = "/nonexistent"}).faults);
}

TEST(SolverLanguage, AMisspeltPreconditionerIsRefusedBeforeAnythingRuns) {
  EXPECT_EQ(faults("preconditioner=\"multigrid\""), "");
  EXPECT_EQ(faults("preconditioner=\"SGAUSS_SEIDEL\""), "");
  EXPECT_EQ(faults("preconditioner=\"blockJacobbi\""),
            "s.xml:2: preconditioner: 'blockJacobbi' is not one of auto, blockJacobi, incompleteCholesky, jacobi, "
            "multigrid, none (did you mean 'blockJacobi'?)");
}

TEST(SolverLanguage, AllFaultsComeAtOnce) {
  EXPECT_EQ(faults("preconditioner=\"multigird\" linearSolver=\"Direct\" tolerance=\"2\" newtonIterations=\"0\""),
            "s.xml:2: preconditioner: 'multigird' is not one of auto, blockJacobi, incompleteCholesky, jacobi, "
            "multigrid, none (did you mean 'multigrid'?)\n"
            "s.xml:2: linearSolver = Direct is not one of direct, iterativeCG, CG, GMRES, auto (did you mean "
            "'direct'?)\ns.xml:2: tolerance = 2 is not in (0, 1)\ns.xml:2: newtonIterations = 0 is not in [1, 1000]");
}

}  // namespace
}  // namespace msml
