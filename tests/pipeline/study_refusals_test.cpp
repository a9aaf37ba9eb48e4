// SPDX-License-Identifier: GPL-3.0-or-later
// Studies whose scene refuses some settings, or all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/program.hpp"
#include "tests/study/bar.hpp"

namespace msml::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The column with Poisson's ratio and the solver as variables.
fs::path scene(const Folder& folder, const std::string& studies) {
  std::string text = studies::bar(studies);
  const auto put = [&](const std::string& old, const std::string& now) {
    text.replace(text.find(old), old.size(), now);
  };
  put("<variables>", R"(<variables><var name="nu" value="0"/><var name="solver" value="direct"/>)");
  put("poissonRatio=\"0\"", "poissonRatio=\"${nu}\"");
  put("linearSolver=\"direct\"", "linearSolver=\"${solver}\"");
  return folder.write("s.msml.xml", text);
}

const std::string some =
    R"xml(<study id="some"><vary variable="nu E solver" values="0 10 direct; 0.5 10 direct; 0 -3 direct; 0 10 LU; 0.3 10 CG"/>
<measure probe="tip" component="z"/></study>)xml";
const std::string none =
    R"xml(<study id="none"><vary variable="nu" values="0.5 0.6"/><measure probe="tip" component="z"/></study>)xml";

TEST(StudyRefusals, AreToldBeforeTheFirstRunAndStandInTheTable) {
  const Folder folder;
  const fs::path file = scene(folder, some);
  const Finished run = run_msml("study " + quoted(file) + " -o " + quoted(folder / "out"));
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string before = run.err.substr(0, run.err.find("study some: 5 runs"));
  EXPECT_THAT(before, HasSubstr("warning: study 'some': 3 of 5 settings are refused; they stand in the table"));
  EXPECT_THAT(before, HasSubstr("nu=0.5 E=10 solver=direct: "));
  EXPECT_THAT(before, HasSubstr("poissonRatio = 0.5 is not in "));
  EXPECT_THAT(before, HasSubstr("youngModulus = -3 is not > 0"));
  EXPECT_THAT(before, HasSubstr("nu=0 E=10 solver=LU: "));
  EXPECT_THAT(before, Not(HasSubstr("[1/5]")));
  const std::string table = content(folder / "out/some/results.csv");
  EXPECT_THAT(table, HasSubstr("0.5,10,direct,refused,"));
  EXPECT_THAT(table, HasSubstr("0,10,LU,refused,"));
  EXPECT_THAT(table, HasSubstr("0.3,10,CG,done,"));
}

TEST(StudyRefusals, OfAllSettingsEndEveryStudyBeforeItStarts) {
  const Folder folder;
  const fs::path file = scene(folder, some + none);
  const Finished run = run_msml("study " + quoted(file) + " -o " + quoted(folder / "out"));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("no run of study 'none' can be carried out: all of its 2 settings are refused"));
  EXPECT_THAT(run.err, HasSubstr("\n  nu=0.6: "));
  EXPECT_THAT(run.err, HasSubstr("3 of 5 settings are refused"));
  EXPECT_FALSE(fs::exists(folder / "out"));
  const Finished other = run_msml("study " + quoted(file) + " some -o " + quoted(folder / "out"));
  EXPECT_EQ(other.code, 0) << other.err;
  const Finished plan = run_msml("study " + quoted(file) + " none --dry-run -o " + quoted(folder / "plan"));
  EXPECT_EQ(plan.code, 2);
  EXPECT_THAT(plan.out, HasSubstr("[2/2] nu=0.6: refused: "));
}

TEST(StudyRefusals, AreFoundByCheck) {
  const Folder folder;
  const Finished warned = run_msml("check " + quoted(scene(folder, some)));
  EXPECT_EQ(warned.code, 0);
  EXPECT_THAT(warned.err, HasSubstr("warning: study 'some': 3 of 5 settings are refused"));
  EXPECT_THAT(warned.out, HasSubstr("no faults"));
  const Finished refused = run_msml("check " + quoted(scene(folder, none)));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("no run of study 'none' can be carried out"));
}

}  // namespace
}  // namespace msml::testing
