// SPDX-License-Identifier: GPL-3.0-or-later
// Materials and formulations of the real language that do not go together: text in, message out.
#include <gtest/gtest.h>

#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

/// Faults of a scene with this mesh tag and, on line 2, this material.
std::string faults(const std::string& mesh, const std::string& material) {
  const std::string scene =
      "<msml><scene><object><mesh>" + mesh + "</mesh><material><region indices=\"${i}\">\n" + material +
      "</region></material></object></scene><workflow><GenerateBoxMesh id=\"b\" size=\"1 1 1\" divisions=\"1 1 1\"/>"
      "<ComputeIndicesFromBoxROI id=\"i\" mesh=\"${b}\" select=\"points\" box=\"0 0 0 1 1 1\"/></workflow></msml>";
  return tiny::lines(
      compile_text(scene, "/nonexistent/s.xml", real_language(), {.output_folder = "/nonexistent"}).faults);
}

TEST(FormulationLanguage, LawsWithoutAVolumetricPartAreRefusedBeforeAnythingRuns) {
  const std::string law = "<stVenantKirchhoffMaterial youngModulus=\"1\" poissonRatio=\"0.3\"/>";
  EXPECT_EQ(faults("<linearTet mesh=\"${b}\"/>", law), "");
  EXPECT_NE(faults("<linearTet mesh=\"${b}\" formulation=\"fbar\"/>", law)
                .find("s.xml:2: region 'stVenantKirchhoffMaterial': stVenantKirchhoffMaterial has no volumetric part"),
            std::string::npos);
}

TEST(FormulationLanguage, IncompressibleLawsNeedAPressure) {
  const std::string law = "<neoHookeanMaterial youngModulus=\"1\" form=\"isochoric\" incompressible=\"true\"/>";
  EXPECT_EQ(faults("<quadraticTet mesh=\"${b}\" formulation=\"mixed\"/>", law), "");
  EXPECT_NE(faults("<quadraticTet mesh=\"${b}\"/>", law).find("needs quadraticTet with formulation=\"mixed\""),
            std::string::npos);
}

TEST(FormulationLanguage, MaterialsThatCannotBeBuiltAreRefusedBeforeAnythingRuns) {
  EXPECT_NE(faults("<linearTet mesh=\"${b}\"/>", "<neoHookeanMaterial youngModulus=\"1\"/>").find("s.xml:2: "),
            std::string::npos);
}

}  // namespace
}  // namespace msml
