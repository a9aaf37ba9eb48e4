// SPDX-License-Identifier: GPL-3.0-or-later
// The real language: every description is documented and sound, and reaches help, lists and schema.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "msml/commands/help.hpp"
#include "msml/commands/schema.hpp"
#include "msml/compile/literal.hpp"
#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

std::vector<const Description*> all_descriptions() {
  std::vector<const Description*> all;
  for (const auto& op : real_language().operators()) all.push_back(op.get());
  for (const auto& description : real_language().descriptions()) all.push_back(description.get());
  return all;
}

TEST(Language, EveryTagIsASentence) {
  for (const Description* each : all_descriptions()) {
    ASSERT_FALSE(each->doc().empty()) << each->tag();
    EXPECT_EQ(each->doc().back(), '.') << each->tag() << ": " << each->doc();
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(each->doc().front())) || each->doc().front() == '`')
        << each->tag() << ": " << each->doc();
  }
}

TEST(Language, EveryAttributeAndOutputIsExplained) {
  for (const Description* each : all_descriptions())
    for (const Slot& slot : each->slots()) {
      EXPECT_FALSE(trimmed(slot.doc).empty()) << each->tag() << " " << slot.name;
      EXPECT_EQ(slot.doc, trimmed(slot.doc)) << each->tag() << " " << slot.name;
      EXPECT_FALSE(slot.doc.ends_with('.')) << each->tag() << " " << slot.name << ": a phrase, not a sentence";
    }
}

TEST(Language, NoNumberMayBeNanOrInfinite) {
  for (const Description* each : all_descriptions())
    for (const Slot& slot : each->slots())
      if (slot.role != Role::output && (slot.type == Type::number || slot.type == Type::numbers)) {
        for (const char* text : {"nan", "inf", "-inf", "1e999"})
          EXPECT_FALSE(parse_literal(slot, text, slot.indexes).problem.empty()) << each->tag() << " " << slot.name;
      }
}

TEST(Language, EveryDefaultIsAllowed) {
  for (const Description* each : all_descriptions())
    for (const Slot& slot : each->slots())
      if (type(slot.fallback) != Type::nothing) {
        EXPECT_EQ(type(slot.fallback), slot.type) << each->tag() << " " << slot.name;
        EXPECT_EQ(value_problem(slot, slot.fallback), "") << each->tag();
      }
}

TEST(Language, EveryTagMayStandSomewhere) {
  std::set<std::string> allowed{"msml", "operator"};
  for (const Description* each : all_descriptions())
    for (const ChildRule& rule : each->children()) allowed.insert(rule.category);
  for (const Description* each : all_descriptions())
    EXPECT_TRUE(allowed.contains(each->category())) << each->tag() << " of category " << each->category();
}

TEST(Help, ExplainsEveryTagWithEveryAttribute) {
  for (const Description* each : all_descriptions()) {
    const std::string text = help_text(real_language(), each->tag());
    for (const Slot& slot : each->slots())
      EXPECT_NE(text.find("  " + slot.name + "  ("), std::string::npos) << each->tag() << " " << slot.name;
  }
}

TEST(Help, OfAnUnknownTagShowsTheNearest) {
  try {
    help_text(real_language(), "fixedConstrain");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "no tag is called fixedConstrain (did you mean 'fixedConstraint'?); `msml list` shows all");
  }
}

TEST(List, HoldsEveryTag) {
  const std::string text = list_text(real_language(), "");
  for (const Description* each : all_descriptions())
    EXPECT_NE(text.find("  " + each->tag() + " "), std::string::npos) << each->tag();
}

TEST(List, OfACategoryMayBeSingularOrPlural) {
  EXPECT_EQ(list_text(real_language(), "materials"), list_text(real_language(), "material"));
  EXPECT_EQ(list_text(real_language(), "materials").find("fixedConstraint"), std::string::npos);
  EXPECT_THROW(list_text(real_language(), "bananas"), Error);
}

/// xmllint's verdict on a scene: 0 = valid.
class Schema : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("xmllint --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "xmllint is not installed";
    folder_.add("msml.xsd", schema_text(real_language()));
  }
  int verdict(const std::string& scene) const {
    const std::string folder = folder_.path().string();
    return std::system(
        ("xmllint --noout --schema '" + folder + "/msml.xsd' '" + scene + "' >'" + folder + "/log' 2>&1").c_str());
  }
  int verdict_of_text(const std::string& text) const {
    folder_.add("s.xml", text);
    return verdict((folder_.path() / "s.xml").string());
  }
  std::string log() const {
    std::ifstream in(folder_.path() / "log");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string scene(const std::string& tasks) {
    return "<msml:msml xmlns:msml=\"http://sfb125.de/msml\"><workflow>" + tasks + "</workflow></msml:msml>";
  }
  tiny::Folder folder_;
};

TEST_F(Schema, AcceptsTheOriginalScenes) {
  const auto scenes = original_scenes();
  if (scenes.empty()) GTEST_SKIP() << "the original scenes are not there";
  for (const auto& path : scenes) EXPECT_EQ(verdict(path.string()), 0) << log();
}

TEST_F(Schema, RefusesWhatTheCompilerRefuses) {
  ASSERT_EQ(verdict_of_text(scene("<GenerateSpheres id=\"a\" centers=\"0 0 0\" radius=\"2\"/>")), 0) << log();
  EXPECT_NE(verdict_of_text(scene("<GenerateSphere5/>")), 0);
  EXPECT_NE(verdict_of_text(scene("<GenerateSpheres id=\"a\" centres=\"0 0 0\"/>")), 0);
  EXPECT_NE(verdict_of_text(scene("<GenerateSpheres id=\"a\" centers=\"0 0 0\" radius=\"big\"/>")), 0);
  EXPECT_NE(verdict_of_text(scene("<GenerateSpheres id=\"a\" centers=\"0 0 0\" radius=\"-2\"/>")), 0);
  EXPECT_NE(
      verdict_of_text(scene("<ComputeIndicesFromBoxROI id=\"a\" mesh=\"m.vtk\" box=\"0 0 0 1 1 1\" select=\"all\"/>")),
      0);
}

TEST_F(Schema, AcceptsReferencesWhereverAValueStands) {
  EXPECT_EQ(verdict_of_text(scene("<GenerateSpheres id=\"a\" centers=\"${c}\" radius=\" ${r} \"/>")), 0) << log();
}

}  // namespace
}  // namespace msml
