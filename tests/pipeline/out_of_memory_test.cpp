// SPDX-License-Identifier: GPL-3.0-or-later
// Where the system gives no more memory, the program says so and leaves whole files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/pipeline/program.hpp"
#include "tests/sanitized.hpp"

namespace msml::testing {
namespace {

using Json = nlohmann::json;
using ::testing::AnyOf;
using ::testing::HasSubstr;

class OutOfMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    if (sanitized) GTEST_SKIP();
  }
};

/// A block of n x n x n cubes of quadratic tetrahedra under gravity, of which a direct solver makes large factors.
std::string block(int n, const std::string& solver, const std::string& formulation = "standard") {
  const std::string divisions = std::to_string(n) + " " + std::to_string(n) + " " + std::to_string(n);
  return R"(<msml><workflow>
<GenerateBoxMesh id="block" size="1 1 1" quadratic="true" divisions=")" +
         divisions + R"("/>
<ComputeIndicesFromBoxROI id="all" mesh="${block}" select="elements" box="-1 -1 -1 2 2 2"/>
<ComputeIndicesFromBoxROI id="wall" mesh="${block}" select="points" box="-1 -1 -1 1e-6 2 2"/>
</workflow><scene><object id="body">
<mesh><quadraticTet mesh="${block}" formulation=")" +
         formulation + R"("/></mesh>
<material><region indices="${all}"><linearElasticMaterial youngModulus="1e5" poissonRatio="0.3"/><mass massDensity="1"/>
</region></material><constraints><constraint><fixedConstraint indices="${wall}"/></constraint></constraints>
<output><displacement id="u" timestep="1"/></output></object></scene>
<environment><solver timeIntegration="static" linearSolver=")" +
         solver + R"("/><simulation><step name="load" gravity="0 0 -10"/></simulation></environment></msml>)";
}

/// Runs a scene in a process that gets so much memory (address space, setrlimit(2)) and not more.
Finished run_within(int megabytes, const Folder& folder, const std::string& scene, int threads = 1) {
  const fs::path file = folder.write("s.msml.xml", scene);
  const std::string limits = "ulimit -v " + std::to_string(1000 * megabytes) +
                             "; export OPENBLAS_NUM_THREADS=" + std::to_string(threads) + "; ";
  return run_msml("exec " + quoted(file) + " -q -o " + quoted(folder / "out") + " --threads " + std::to_string(threads),
                  30, limits);
}

/// What a run left is whole: no temporaries, XML up to its last tag, and a report that can be read.
void expect_whole_files(const Folder& folder) {
  for (const auto& entry : fs::directory_iterator(folder / "out")) {
    const std::string name = entry.path().filename(), text = content(entry.path());
    EXPECT_THAT(name, AnyOf("u.json", "u.pvd", "u_0000.vtu", "u_0001.vtu"));
    EXPECT_TRUE(name == "u.json" ? Json::accept(text) : text.ends_with("</VTKFile>\n")) << name;
  }
}

void expect_factor_without_memory(const Folder& folder, const Finished& run) {
  EXPECT_EQ(run.code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("Simulate 'body': step 1 'load' stopped at 1 of the loads: out of memory"));
  EXPECT_THAT(run.err, HasSubstr("try linearSolver=\"CG\" or a coarser mesh"));
  const Json report = Json::parse(content(folder / "out/u.json"));
  EXPECT_EQ(report["status"], "not converged");
  EXPECT_EQ(report["nodes"].back()["check"]["ended"], "out of memory");
  expect_whole_files(folder);
}

// Measured: 390 MB of the process besides a factor of 330 MB. The advice is good: conjugate gradients need 70 MB.
TEST_F(OutOfMemory, InACholeskyFactorisationIsSaidWithAWayOut) {
  const Folder folder;
  expect_factor_without_memory(folder, run_within(600, folder, block(12, "direct")));
  const Folder other;
  const Finished cg = run_within(600, other, block(12, "CG"));
  EXPECT_EQ(cg.code, 0) << cg.err;
}

TEST_F(OutOfMemory, InAFactorisationOfMixedElementsIsSaidWithAWayOut) {
  const Folder folder;
  expect_factor_without_memory(folder, run_within(700, folder, block(12, "direct", "mixed")));
}

// Whatever fails for want of memory: a thread, a buffer of the dense kernels, a mesh, a matrix, a factor. The last is
// enough for all.
TEST_F(OutOfMemory, NeverMakesTheProgramHang) {
  bool refused = false;
  for (const int megabytes : {200, 250, 350, 2000})
    for (const int threads : {1, 2}) {
      const Folder folder;
      const Finished run = run_within(megabytes, folder, block(6, "direct"), threads);
      if (run.code == 127) continue;  // its libraries do not fit: the system's loader says so
      EXPECT_THAT(run.code, AnyOf(0, 3)) << megabytes << " MB: " << run.err;
      EXPECT_THAT(run.err, AnyOf("", HasSubstr("not enough memory"), HasSubstr("out of memory")));
      EXPECT_EQ(run.err.empty(), run.code == 0);
      if (megabytes == 2000) {
        EXPECT_EQ(run.code, 0);
      }
      refused = refused || run.code == 3;
      if (fs::exists(folder / "out")) expect_whole_files(folder);
    }
  EXPECT_TRUE(refused);
}

}  // namespace
}  // namespace msml::testing
