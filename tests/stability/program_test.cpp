// SPDX-License-Identifier: GPL-3.0-or-later
// What the program says where a method fails: the right words, status and exit code, and the last good state on disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/pipeline/program.hpp"

namespace msml::testing {
namespace {

using ::testing::HasSubstr;

/// A bar [0,2] x [0,1] x [0,1] held at x = 0, and what a row of the atlas does to it.
struct Row {
  std::string name;
  std::string law, constraint, solver, step;
  int code;           ///< 0 done, 2 refused before anything runs, 3 stopped
  std::string words;  ///< on standard error
  std::string elements = "linearTet";
  friend std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }
};

constexpr auto elastic = R"(<linearElasticMaterial youngModulus="1000" poissonRatio="0.3"/>)";
constexpr auto pull = R"(<surfaceTraction indices="${end}" traction="0 0 1"/>)";
constexpr auto at_rest = R"(gravity="0 0 0")";

std::string scene(const Row& row) {
  return R"(<msml><workflow>
<GenerateBoxMesh id="bar" size="2 1 1" divisions="4 2 2" quadratic=")" +
         std::string(row.elements == "linearTet" ? "false" : "true") + R"("/>
<ComputeIndicesFromBoxROI id="all" mesh="${bar}" select="elements" box="-9 -9 -9 9 9 9"/>
<ComputeIndicesFromBoxROI id="wall" mesh="${bar}" select="points" box="-1e-6 -9 -9 1e-6 9 9"/>
<ComputeIndicesFromBoxROI id="end" mesh="${bar}" select="points" box="1.999999 -9 -9 9 9 9"/>
</workflow><scene><object id="body"><mesh><)" +
         row.elements + R"( mesh="${bar}"/></mesh>
<material><region indices="${all}">)" +
         row.law + R"(<mass massDensity="1"/></region></material>
<constraints>)" +
         (row.name == "free body" ? "" : R"(<constraint><fixedConstraint indices="${wall}"/></constraint>)") +
         "<constraint>" + row.constraint + R"(</constraint></constraints>
<output><displacement id="disp" timestep="1"/><energies id="energy"/></output></object></scene>
<environment><solver )" +
         row.solver + R"(/><simulation><step name="load" )" + row.step + R"(/></simulation></environment></msml>)";
}

const Row rows[] = {
    {"small strain turned far", R"(<linearElasticMaterial youngModulus="1000" poissonRatio="0.3" strain="small"/>)",
     R"(<surfaceTraction indices="${end}" traction="0 0 100"/>)", R"(timeIntegration="static")", at_rest, 0,
     R"(but strain = "small" holds up to about 10)"},
    {"tet4 near one half", R"(<linearElasticMaterial youngModulus="1000" poissonRatio="0.4999"/>)", pull,
     R"(timeIntegration="static")", at_rest, 0, "lock (are too stiff) from 0.45"},
    {"St. Venant-Kirchhoff crushed", R"(<stVenantKirchhoffMaterial youngModulus="1000" poissonRatio="0.3"/>)",
     R"(<surfaceTraction indices="${end}" traction="-300 0 0"/>)", R"(timeIntegration="static" loadSteps="10")",
     at_rest, 3, "stopped at"},
    {"neo-Hookean pushed through itself", R"(<neoHookeanMaterial youngModulus="1000" poissonRatio="0.3" form="log"/>)",
     R"(<displacementConstraint indices="${end}" displacement="-2.6 0 0"/>)",
     R"(timeIntegration="static" loadSteps="10")", at_rest, 3, "stopped at"},
    {"corotated pushed through itself in time", elastic,
     R"(<displacementConstraint indices="${end}" displacement="-3 0 0"/>)", R"(timeIntegration="Newmark")",
     R"(dt="0.01" iterations="10" gravity="0 0 0")", 3, "inverted element"},
    {"single rotation turned inside out", elastic,
     R"(<displacementConstraint indices="${end}" displacement="-3 0 0"/>)",
     R"(timeIntegration="static" loadSteps="10")", at_rest, 3, "stopped at",
     R"(quadraticTet formulation="singleRotation")"},
    {"symplectic Euler over its limit", elastic, pull, R"(timeIntegration="symplecticEuler")",
     R"(dt="0.1" iterations="10" gravity="0 0 0")", 3, "is unstable above"},
    {"central difference over its limit", elastic, pull, R"(timeIntegration="centralDifference")",
     R"(dt="0.1" iterations="10" gravity="0 0 0")", 3, "is unstable above"},
    {"central difference over its limit all the same", elastic, pull,
     R"(timeIntegration="centralDifference" allowUnstable="true")", R"(dt="0.1" iterations="1000" gravity="0 0 0")", 3,
     "stopped"},
    {"forward Euler", elastic, pull, R"(timeIntegration="forwardEuler")",
     R"(dt="0.0001" iterations="10" gravity="0 0 0")", 2, "is unstable at any dt without damping"},
    {"implicit Euler in long steps", elastic, pull, R"(timeIntegration="dynamicImplicitEuler")",
     R"(dt="0.1" iterations="10" gravity="0 0 0")", 0, "damps the lowest period"},
    {"gradients near one half", R"(<linearElasticMaterial youngModulus="1000" poissonRatio="0.4999" strain="small"/>)",
     pull, R"(timeIntegration="static" linearSolver="CG" preconditioner="none")", at_rest, 0, "missed linearTolerance",
     "quadraticTet"},
    {"free body", elastic, pull, R"(timeIntegration="static")", at_rest, 2, "rigid"},
};

class Atlas : public ::testing::TestWithParam<Row> {};

/// Neither tables nor reports hold what is no number.
void expect_numbers(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    std::istringstream text(content(entry.path()));
    for (std::string word; std::getline(text, word, ',');) {
      EXPECT_EQ(word.find("nan"), std::string::npos) << entry.path();
      EXPECT_EQ(word.find("inf"), std::string::npos) << entry.path();
    }
  }
}

TEST_P(Atlas, TheProgramNotices) {
  const Row& row = GetParam();
  const Folder folder;
  const fs::path file = folder.write("row.msml.xml", scene(row));
  const Finished run = run_msml("exec " + quoted(file) + " -o " + quoted(folder / "out"), 60);
  EXPECT_EQ(run.code, row.code) << run.err;
  EXPECT_THAT(run.err + run.out, HasSubstr(row.words));
  if (row.code == 2) {
    EXPECT_FALSE(fs::exists(folder / "out/disp_0000.vtu"));
    return;
  }
  ASSERT_TRUE(fs::exists(folder / "out/disp.json")) << run.err;
  const auto report = nlohmann::json::parse(content(folder / "out/disp.json"));
  EXPECT_EQ(report["status"], row.code == 0 ? "done" : "not converged");
  EXPECT_TRUE(fs::exists(folder / "out/disp_0000.vtu"));
  EXPECT_TRUE(fs::exists(folder / "out/disp.pvd"));
  expect_numbers(folder / "out");
}

INSTANTIATE_TEST_SUITE_P(Rows, Atlas, ::testing::ValuesIn(rows), [](const auto& found) {
  std::string name = found.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

/// Ascii STL of the tetrahedron with unit edges along the axes, with the first `count` of its four faces.
std::string tetrahedron(int count) {
  const char* faces[] = {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "0 0 0 0 0 1 0 1 0", "1 0 0 0 1 0 0 0 1"};
  std::ostringstream text;
  text << "solid t\n";
  for (int f = 0; f < count; ++f) {
    std::istringstream numbers(faces[f]);
    text << "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) {
      double x, y, z;
      numbers >> x >> y >> z;
      text << "vertex " << x << " " << y << " " << z << "\n";
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid t\n";
  return text.str();
}

Finished meshed(int faces, const std::string& attributes) {
  const Folder folder;
  folder.write("t.stl", tetrahedron(faces));
  const fs::path file = folder.write(
      "mesh.msml.xml",
      "<msml><workflow><ConvertSTLToVTK id=\"surface\" STLMesh=\"t.stl\"/><CGALMeshVolumeFromSurface id=\"volume\" "
      "surfaceMesh=\"${surface}\" meshFilename=\"volume.vtk\" preserveFeatures=\"true\" " +
          attributes + "/></workflow></msml>");
  Finished run = run_msml("exec " + quoted(file) + " -o " + quoted(folder / "out"), 60);
  EXPECT_EQ(fs::exists(folder / "out/volume.vtk"), run.code == 0);
  return run;
}

// Counts of non-manifold edges and of intersections, repairs and lost labels: tests/operators/mesh_volume_from_*_test.
TEST(Atlas, MeshingIsRefusedWhereItCannotEndOrHasNothingToFill) {
  EXPECT_EQ(meshed(4, "cellSize=\"0.5\" facetSize=\"0.5\" facetAngle=\"30\"").code, 0);
  const Finished steep = meshed(4, "facetAngle=\"31\"");
  EXPECT_EQ(steep.code, 2);
  EXPECT_THAT(steep.err, HasSubstr("facetAngle = 31 is not in [0, 30]"));
  const Finished open = meshed(3, "cellSize=\"0.5\"");
  EXPECT_EQ(open.code, 2);
  EXPECT_THAT(open.err, HasSubstr("3 border edges"));
}

}  // namespace
}  // namespace msml::testing
