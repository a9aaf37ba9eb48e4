// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of operators that exclude each other: found when a scene is compiled, all at once.
#include <gtest/gtest.h>

#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

std::string faults(const std::string& workflow) {
  return tiny::lines(compile_text("<msml><workflow>\n" + workflow + "</workflow></msml>", "/nonexistent/s.xml",
                                  real_language(), {.output_folder = "/nonexistent"})
                         .faults);
}

TEST(EarlyChecks, NameAllThatExcludesEachOther) {
  EXPECT_EQ(
      faults("<GenerateSphereMesh id=\"a\" radius=\"1\" innerRadius=\"2\"/>\n"
             "<GenerateCylinderMesh id=\"b\" radius=\"1\" innerRadius=\"1\" height=\"1\"/>\n"
             "<ComputeIndicesFromBoxROI id=\"c\" mesh=\"${a}\" select=\"points\" box=\"0 0 0 1 -1 1\"/>\n"
             "<AddFieldToMesh id=\"d\" mesh=\"${a}\" name=\"E\" values=\"1+t\"/>\n"
             "<GenerateSpheres id=\"e\" centers=\"0 0 0\"/>\n"
             "<CGALSimplificateSurface id=\"f\" inputMeshFile=\"${e}\" box=\"0 0 0 1 1 -1\" stopnr=\"100\"/>\n"
             "<CGALSimplificateSurface id=\"g\" inputMeshFile=\"${e}\"/>\n"
             "<ComputeFieldError id=\"h\" mesh=\"${d}\"/>\n"
             "<ComputeFieldError id=\"i\" mesh=\"${d}\" expected=\"\"/>\n"
             "<VoxelizeSurfaceMesh id=\"j\" surfaceMesh=\"${e}\"/>\n"),
      "s.xml:2: innerRadius = 2 is not below radius = 1\n"
      "s.xml:3: innerRadius = 1 is not below radius = 1\n"
      "s.xml:4: box: ymin = 0 is above ymax = -1; the order is xmin ymin zmin xmax ymax zmax\n"
      "s.xml:5: values depends on t, but a field of a mesh does not change in time: use X, Y and Z alone\n"
      "s.xml:7: box: zmin = 0 is above zmax = -1; the order is xmin ymin zmin xmax ymax zmax\n"
      "s.xml:8: give either stopnr (edges) or vertices, and not both\n"
      "s.xml:9: give either expected or referenceMesh, what the field is to be compared with\n"
      "s.xml:10: expected is empty; one formula for each component of the field is needed\n"
      "s.xml:11: 0 of resolution, isotropicVoxelSize and referenceCoordinateGrid are given; exactly one is needed");
}

// Its value is not known before the other task has run; that it is given is.
TEST(EarlyChecks, CountWhatOtherTasksFeedAsGiven) {
  EXPECT_EQ(faults("<GenerateBoxMesh id=\"a\" size=\"1 1 1\" divisions=\"1 1 1\"/>\n"
                   "<GenerateSpheres id=\"b\" centers=\"0 0 0\"/>\n"
                   "<GenerateEmptyImage3D id=\"c\" dim=\"4 4 4\"/>\n"
                   "<VoxelizeSurfaceMesh id=\"e\" surfaceMesh=\"${b}\" referenceCoordinateGrid=\"${c}\"/>\n"
                   "<ComputeFieldError id=\"d\" mesh=\"${a}\" referenceMesh=\"${a}\"/>\n"),
            "");
}

}  // namespace
}  // namespace msml
