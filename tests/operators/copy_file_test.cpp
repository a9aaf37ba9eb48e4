// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/operators/shared/files.hpp"
#include "tests/operators/shared/run_operator.hpp"

namespace msml {
namespace {

TEST(CopyFile, HandsTheFileOnToItsTarget) {
  const test::Folder folder("msml_copy");
  test::put_bytes(folder / "a.txt", "abc");
  const Value copy = test::run("copyFile", {{"filename_in", File{folder / "a.txt"}}});
  EXPECT_EQ(std::get<File>(copy).path, folder / "a.txt");
  const Registry registry = test::all();
  const Operator& op = *registry.find_operator("copyFile");
  const Slot& target = op.slots()[static_cast<std::size_t>(op.find("filename_out"))];
  EXPECT_EQ(target.role, Role::target);
  EXPECT_EQ(target.written_output, op.first_output());
}

TEST(CopyFile, NamesTheFileThatIsMissing) {
  EXPECT_EQ(test::error_of("copyFile", {{"filename_in", File{"no/such/file.vtu"}}}), "no such file: no/such/file.vtu");
}

TEST(CopyFile, RefusesAFolder) {
  const test::Folder folder("msml_copy_folder");
  EXPECT_THAT(test::error_of("copyFile", {{"filename_in", File{folder.path()}}}),
              testing::EndsWith("is a folder, not a file"));
}

}  // namespace
}  // namespace msml
