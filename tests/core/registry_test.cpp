// SPDX-License-Identifier: GPL-3.0-or-later
// Look-ups by tag and extension; files that appear whole or not at all.
#include "msml/core/registry.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "msml/core/atomic_file.hpp"
#include "tests/compile/tiny_registry.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  AtomicFile() {
    std::string name = (fs::temp_directory_path() / "msml_core_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~AtomicFile() override { fs::remove_all(folder_); }
  std::string content(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t count() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }
  fs::path folder_;
};

TEST_F(AtomicFile, AppearsWithItsFolders) {
  write_whole(folder_ / "a/b/c.txt", "words");
  EXPECT_EQ(content("a/b/c.txt"), "words");
}

TEST_F(AtomicFile, LeavesNothingWhereTheWriterThrows) {
  EXPECT_THROW(write_whole(folder_ / "a.txt",
                           [](const fs::path& path) {
                             std::ofstream(path) << "half";
                             throw Error("disk full");
                           }),
               Error);
  EXPECT_EQ(count(), 0u);
}

TEST_F(AtomicFile, KeepsTheOldFileWhereTheWriterThrows) {
  write_whole(folder_ / "a.txt", "old");
  EXPECT_THROW(write_whole(folder_ / "a.txt", [](const fs::path&) { throw Error("disk full"); }), Error);
  EXPECT_EQ(content("a.txt"), "old");
  EXPECT_EQ(count(), 1u);
}

TEST_F(AtomicFile, ReplacesTheOldFile) {
  write_whole(folder_ / "a.txt", "a longer old text");
  write_whole(folder_ / "a.txt", "new");
  EXPECT_EQ(content("a.txt"), "new");
  EXPECT_EQ(count(), 1u);
}

TEST_F(AtomicFile, RefusesAFolderAndNamesIt) {
  fs::create_directories(folder_ / "a.txt/inside");
  try {
    write_whole(folder_ / "a.txt", "x");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("cannot write " + (folder_ / "a.txt").string()), 0u) << error.what();
  }
  EXPECT_EQ(count(), 1u);
}

TEST_F(AtomicFile, RefusesAFileInThePlaceOfAFolder) {
  write_whole(folder_ / "a", "x");
  EXPECT_THROW(write_whole(folder_ / "a/b.txt", "y"), Error);
}

TEST_F(AtomicFile, RefusesAWriterThatWritesNothing) {
  EXPECT_THROW(write_whole(folder_ / "a.txt", [](const fs::path&) {}), Error);
  EXPECT_EQ(count(), 0u);
}

TEST(Registry, FindsTheLongestExtensionInAnyCase) {
  const Registry registry = tiny::registry();
  EXPECT_EQ(registry.extension("scan.IMG.gz"), ".img.gz");
  EXPECT_EQ(registry.extension("a/b.c/scan.img"), ".img");
  EXPECT_EQ(registry.extension("scan"), "");
  EXPECT_EQ(registry.extension(".img"), "");
  EXPECT_EQ(registry.format("x.doc"), nullptr);
}

TEST(Registry, RefusesATagDescribedTwice) {
  Registry registry = tiny::registry();
  EXPECT_THROW(registry.add(tiny::fill()), Error);
}

TEST(Registry, FindsTagsByCategory) {
  const Registry registry = tiny::registry();
  EXPECT_NE(registry.find("mass", {"material", "mass"}), nullptr);
  EXPECT_EQ(registry.find("mass", {"material"}), nullptr);
  EXPECT_EQ(registry.find("Fill", {"operator"}), registry.find_operator("Fill"));
}

TEST(Registry, ErrorsOfFilesNameTheFileAndTheExtensions) {
  const Registry registry = tiny::registry();
  const auto message = [](auto call) {
    try {
      call();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message([&] { registry.read("a.tri", Type::mesh); }),
            "cannot read a.tri as a Mesh; files that hold one end in .tet");
  EXPECT_EQ(message([&] { registry.read("nowhere.tet", Type::mesh); }), "no such file: nowhere.tet");
  EXPECT_EQ(message([&] { registry.write(Value{std::make_shared<const Image>()}, "a.tet"); }),
            "cannot write an Image to a.tet; files that hold one end in .img .img.gz");
}

}  // namespace
}  // namespace msml
