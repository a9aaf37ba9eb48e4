// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes of 2015 run unchanged.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/pipeline/program.hpp"

namespace msml::testing {
namespace {

struct Scene {
  const char* name;                  ///< of the test
  const char* file;                  ///< below the folder of the original scenes
  std::vector<std::string> results;  ///< files that must be there afterwards
};
void PrintTo(const Scene& scene, std::ostream* out) { *out << scene.file; }

class OriginalScene : public ::testing::TestWithParam<Scene> {};

TEST_P(OriginalScene, RunsUnchanged) {
  const fs::path scene = original_scenes() / GetParam().file;
  if (!fs::exists(scene)) GTEST_SKIP() << "the original scenes are not beside the project";
  const Folder folder;
  const Finished run =
      run_msml("exec " + quoted(scene) + " -o " + quoted(folder.path()) + " --log-json " + quoted(folder / "log.json"));
  ASSERT_EQ(run.code, 0) << run.err;
  for (const std::string& file : GetParam().results) EXPECT_TRUE(fs::exists(folder / file)) << file << "\n" << run.err;
  const auto log = nlohmann::json::parse(content(folder / "log.json"));
  EXPECT_EQ(log["status"], "done");
  for (const auto& node : log["nodes"]) EXPECT_EQ(node["status"], "done") << node["id"];
}

INSTANTIATE_TEST_SUITE_P(
    All, OriginalScene,
    ::testing::Values(
        // 20 steps of dt with timestep="1": states 0 to 20.
        Scene{"BeamDisplacement",
              "beam/beamLinearDisp.msml.xml",
              {"disp_0000.vtu", "disp_0020.vtu", "disp.pvd", "disp.json", "referenceDisp.vtu"}},
        Scene{"BeamForce", "beam/beamLinearForceDisp.msml.xml", {"disp_0020.vtu", "referenceDisp.vtu"}},
        Scene{"BeamPressure", "beam/beamLinearSurfacePressure.msml.xml", {"LiverXSTet4Def_0020.vtu"}},
        Scene{"Liver", "liver/liverLinear.msml.xml", {"LiverXSTet4Def_0150.vtu", "LiverXSTet4Def.pvd"}},
        Scene{"BunnyFromSurface", "bunny/bunnyCGAL.msml.xml", {"bunnyVolumeMeshCGAL.vtk", "liver_0100.vtu"}},
        Scene{"BunnyThreeSteps", "bunny/bunnyCGAL_HiFlow3.msml.xml", {"bunnyVolumeMeshCGAL.vtk", "liver_0060.vtu"}},
        Scene{"BunnyFromVoxels",
              "bunny/bunnyVoxelMeshingNoHoles.msml.xml",
              {"BunnyVoxelImage.vti", "bunnyVolumeFromVoxelImage.vtk", "liver_0100.vtu"}},
        Scene{"Spheres", "pipelines/sphere.xml", {"sphere.vtp", "spheres.vti"}},
        Scene{"ImageSum", "pipelines/imageSum.xml", {"sphere1.vtp", "aSphere4.vti", "sum.vti"}}),
    [](const auto& scene) { return scene.param.name; });

TEST(OriginalScenes, TetGenIsRefusedAsNotAvailableYet) {
  const fs::path scene = original_scenes() / "bunny/bunny.msml.xml";
  if (!fs::exists(scene)) GTEST_SKIP() << "the original scenes are not beside the project";
  const Finished run = run_msml("exec " + quoted(scene));
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("TetgenCreateVolumeMesh is not available yet"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace msml::testing
