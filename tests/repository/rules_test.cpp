// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps the rules of the repository true, and shows for each rule that it notices what it forbids.
#include "tests/repository/rules.hpp"

#include <gmock/gmock.h>

namespace msml::repository {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const Files& tree() {
  static const Files files = read_tree(MSML_SOURCE_DIR);
  return files;
}

const std::string licence = "// SPDX-License-Identifier: GPL-3.0-or-later\n";

TEST(Repository, TheWholeTreeIsRead) {
  std::set<std::string> paths;
  for (const auto& file : tree()) paths.insert(file.path);
  for (const char* known : {"dev", ".ci/run", "CMakeLists.txt", "msml/core/mesh.hpp", "solver/model.hpp", "README.md",
                            "operators/registry.cpp.in", "tests/repository/rules_test.cpp"})
    EXPECT_TRUE(paths.contains(known)) << known;
}

TEST(Repository, IncludesAreWrittenFromTheRoot) { EXPECT_THAT(includes_from_the_root(tree()), IsEmpty()); }
TEST(Repository, LayersIncludeOnlyWhatTheyMay) { EXPECT_THAT(layers(tree()), IsEmpty()); }
TEST(Repository, OperatorsDoNotIncludeEachOther) {
  EXPECT_THAT(operators_apart(tree(), listed_operators(tree())), IsEmpty());
}
TEST(Repository, ThirdPartyLibrariesEnterByTheirDoors) { EXPECT_THAT(third_party_doors(tree()), IsEmpty()); }
TEST(Repository, FilesStayShort) { EXPECT_THAT(short_files(tree()), IsEmpty()); }
TEST(Repository, CodeNamesItsLicence) { EXPECT_THAT(licence_lines(tree()), IsEmpty()); }
TEST(Repository, NoFileNamesAFolderOfOneMachine) { EXPECT_THAT(no_machine_paths(tree()), IsEmpty()); }

TEST(RepositoryRules, AnIncludeRelativeToTheFileIsFound) {
  const Files files = {parse("solver/model.cpp", "#include <vector>\n\n#include \"model.hpp\"\n"),
                       parse("solver/model.hpp", "")};
  EXPECT_THAT(includes_from_the_root(files), ElementsAre("solver/model.cpp:3: no file \"model.hpp\" below the root"));
}

TEST(RepositoryRules, AnOwnHeaderInAngleBracketsIsFound) {
  const Files files = {parse("solver/a.cpp", "#include <solver/a.hpp>\n"), parse("solver/a.hpp", "")};
  EXPECT_THAT(includes_from_the_root(files), SizeIs(1));
}

TEST(RepositoryRules, EachForbiddenLayerIsFound) {
  const auto breaks = [](const std::string& path, const std::string& header) {
    return layers({parse(path, "#include \"" + header + "\"\n")}).size() == 1;
  };
  EXPECT_TRUE(breaks("msml/core/mesh.cpp", "msml/document/document.hpp"));
  EXPECT_TRUE(breaks("msml/core/mesh.cpp", "solver/model.hpp"));
  EXPECT_TRUE(breaks("solver/newton.cpp", "operators/registry.hpp"));
  EXPECT_TRUE(breaks("solver/newton.cpp", "msml/run/run.hpp"));
  EXPECT_TRUE(breaks("operators/copy_file.cpp", "solver/model.hpp"));
  EXPECT_TRUE(breaks("operators/copy_file.cpp", "msml/compile/compile.hpp"));
  EXPECT_TRUE(breaks("msml/compile/compile.cpp", "operators/registry.hpp"));
  EXPECT_TRUE(breaks("msml/run/run.cpp", "solver/model.hpp"));
  EXPECT_TRUE(breaks("solver/newton.cpp", "tests/helpers.hpp"));
  EXPECT_FALSE(breaks("operators/simulate/fill.cpp", "solver/model.hpp"));
  EXPECT_FALSE(breaks("msml/main.cpp", "operators/registry.hpp"));
  EXPECT_FALSE(breaks("tests/solver/newton_test.cpp", "solver/model.hpp"));
}

TEST(RepositoryRules, AnOperatorThatIncludesAnotherIsFound) {
  const Files files = {
      parse("operators/CMakeLists.txt", "# list\nset(OPERATORS\n  one  # first\n  two\n)\nset(HELPERS\n three.cpp)\n"),
      parse("operators/one.cpp", "#include \"operators/two.hpp\"\n#include \"operators/three.hpp\"\n"),
      parse("operators/two.cpp", "#include \"operators/two.hpp\"\n")};
  EXPECT_THAT(listed_operators(files), ElementsAre("one", "two"));
  EXPECT_THAT(operators_apart(files, listed_operators(files)),
              ElementsAre("operators/one.cpp:1: includes the operator two"));
}

TEST(RepositoryRules, EachWrongDoorIsFound) {
  const auto count = [](const std::string& path, const std::string& header) {
    return third_party_doors({parse(path, "#include <" + header + ">\n")}).size();
  };
  EXPECT_EQ(count("msml/document/document.cpp", "tinyxml2.h"), 0U);
  EXPECT_EQ(count("msml/compile/compile.cpp", "tinyxml2.h"), 1U);
  EXPECT_EQ(count("solver/linear/cholmod.cpp", "cholmod.h"), 0U);
  EXPECT_EQ(count("operators/mesh.cpp", "suitesparse/cholmod.h"), 1U);
  EXPECT_EQ(count("operators/cgal_refine.hpp", "CGAL/make_mesh_3.h"), 0U);
  EXPECT_EQ(count("solver/newton.cpp", "CGAL/make_mesh_3.h"), 1U);
  EXPECT_EQ(count("operators/vtk_convert.cpp", "vtkPolyData.h"), 0U);
  EXPECT_EQ(count("operators/vtk_convert.hpp", "vtkPolyData.h"), 1U);
  EXPECT_EQ(count("msml/run/run.cpp", "vtkPolyData.h"), 1U);
  EXPECT_EQ(count("msml/core/mesh.cpp", "vector"), 0U);
  EXPECT_EQ(count("msml/core/mesh.cpp", "Eigen/Dense"), 0U);
  EXPECT_EQ(count("msml/core/mesh.cpp", "tbb/parallel_for.h"), 1U);
}

TEST(RepositoryRules, ASecondDoorOfTheSameLibraryIsFound) {
  const Files files = {parse("msml/document/a.cpp", "#include <tinyxml2.h>\n"),
                       parse("msml/document/b.cpp", "#include <tinyxml2.h>\n")};
  EXPECT_THAT(third_party_doors(files), SizeIs(2));
}

TEST(RepositoryRules, AFileOf401LinesIsFound) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += "\n";
  EXPECT_THAT(short_files({parse("solver/a.cpp", text)}), IsEmpty());
  EXPECT_THAT(short_files({parse("solver/a.cpp", text + "\n")}), ElementsAre("solver/a.cpp: 401 lines"));
}

TEST(RepositoryRules, AMissingLicenceLineIsFound) {
  EXPECT_THAT(licence_lines({parse("solver/a.cpp", licence), parse("a.md", "text")}), IsEmpty());
  EXPECT_THAT(licence_lines({parse("dev", "#!/bin/bash\n"), parse("solver/b.cpp", "\n\n" + licence)}), SizeIs(2));
}

TEST(RepositoryRules, AMachinePathIsFound) {
  const std::string folder = std::string("/") + "home/me";
  EXPECT_THAT(no_machine_paths({parse("README.md", "see\n" + folder + "\n")}),
              Contains(AllOf(HasSubstr("README.md:2"), HasSubstr("one machine"))));
}

}  // namespace
}  // namespace msml::repository
