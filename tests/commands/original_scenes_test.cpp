// SPDX-License-Identifier: GPL-3.0-or-later
// The original scenes compile; and however they are damaged, the compiler answers.
#include <gtest/gtest.h>

#include <random>

#include "msml/plan/plan.hpp"
#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

class OriginalScenes : public testing::Test {
 protected:
  void SetUp() override {
    if (original_scenes().empty()) GTEST_SKIP() << "the original scenes are not there";
  }
  /// Every answer is a graph with an order of all its nodes, or at least one fault with a text.
  static void expect_answer(const std::string& text, const std::filesystem::path& path) {
    const Compilation result = compile_text(text, path.string(), real_language(), {{}, "/nonexistent", false});
    if (result.faults.empty()) {
      EXPECT_EQ(result.graph.order.size(), result.graph.nodes.size());
      EXPECT_NO_THROW(describe(result.graph, make_plan(result.graph)));
    }
    for (const Fault& fault : result.faults) EXPECT_FALSE(fault.message.empty());
  }
  static std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(OriginalScenes, CompileUnchangedExceptTheOneThatNeedsTetGen) {
  for (const auto& path : original_scenes()) {
    const Compilation result = compile_file(path, real_language(), {{}, "/nonexistent", false});
    std::string faults;
    for (const Fault& fault : result.faults) faults += fault.message + "\n";
    if (path.filename() == "bunny.msml.xml")
      EXPECT_NE(faults.find("TetgenCreateVolumeMesh is not available yet"), std::string::npos) << faults;
    else
      EXPECT_EQ(faults, "") << path;
  }
}

TEST_F(OriginalScenes, CutAnywhereAreAnsweredWithFaults) {
  std::mt19937 random(1);
  for (const auto& path : original_scenes()) {
    const std::string text = content(path);
    const std::size_t last = text.rfind('>');
    for (int i = 0; i < 200; ++i) {
      const std::string cut = text.substr(0, random() % last);
      const Compilation result = compile_text(cut, path.string(), real_language(), {{}, "/nonexistent", false});
      EXPECT_FALSE(result.faults.empty()) << cut.size() << " bytes of " << path;
    }
  }
}

TEST_F(OriginalScenes, WithFlippedBytesAreAnswered) {
  std::mt19937 random(2);
  for (const auto& path : original_scenes()) {
    const std::string text = content(path);
    for (int i = 0; i < 300; ++i) {
      std::string damaged = text;
      for (unsigned k = 0; k <= random() % 4; ++k)
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      expect_answer(damaged, path);
    }
  }
}

TEST_F(OriginalScenes, WithSwappedLettersAndLostPartsAreAnswered) {
  std::mt19937 random(3);
  const std::string alphabet = "${}.*<>/\"'= 0-9eaNi";
  for (const auto& path : original_scenes()) {
    const std::string text = content(path);
    for (int i = 0; i < 300; ++i) {
      std::string damaged = text;
      damaged[random() % damaged.size()] = alphabet[random() % alphabet.size()];
      const std::size_t at = random() % damaged.size();
      damaged.erase(at, random() % 30);
      damaged.insert(random() % damaged.size(), text.substr(random() % text.size(), random() % 30));
      expect_answer(damaged, path);
    }
  }
}

}  // namespace
}  // namespace msml
