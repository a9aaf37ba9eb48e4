// SPDX-License-Identifier: GPL-3.0-or-later
// Places, messages and nearest names.
#include "msml/core/error.hpp"

#include <gtest/gtest.h>

namespace msml {
namespace {

TEST(Location, IsFileAndLineFileOrNothing) {
  EXPECT_EQ((Location{"a.xml", 3}).str(), "a.xml:3");
  EXPECT_EQ((Location{"a.xml", 0}).str(), "a.xml");
  EXPECT_EQ(Location{}.str(), "");
}

TEST(Error, SaysPlaceThenMessage) {
  EXPECT_EQ(Error("x = 3 is not > 4", {"a.xml", 3}).str(), "a.xml:3: x = 3 is not > 4");
  EXPECT_EQ(Error("x = 3 is not > 4").str(), "x = 3 is not > 4");
  EXPECT_EQ(Error("m").failure(), Failure::input);
}

TEST(Nearest, CountsAddedRemovedChangedAndSwappedLettersOnce) {
  for (const char* typo : {"workflo", "workfloww", "worcflow", "wrokflow", "WORKFLOW"})
    EXPECT_EQ(nearest(typo, {"scene", "workflow", "variables"}), "workflow") << typo;
}

TEST(Nearest, AllowsAThirdOfTheLettersAtLeastOne) {
  EXPECT_EQ(nearest("bse", {"base"}), "base");
  EXPECT_EQ(nearest("abcdef", {"abcxyf"}), "abcxyf");
  EXPECT_EQ(nearest("abcdef", {"abxyzf"}), "");
  EXPECT_EQ(nearest("ab", {"xy"}), "");
  EXPECT_EQ(nearest("a", {"b"}), "");
  EXPECT_EQ(nearest("", {"a"}), "");
  EXPECT_EQ(nearest("liver", {}), "");
}

TEST(Nearest, PrefersTheFirstOfEquallyNear) { EXPECT_EQ(nearest("test", {"rest", "best"}), "rest"); }

TEST(Nearest, DidYouMeanIsEmptyWithoutANeighbour) {
  EXPECT_EQ(did_you_mean("livre", {"liver"}), " (did you mean 'liver'?)");
  EXPECT_EQ(did_you_mean("banana", {"liver"}), "");
}

TEST(Shortened, KeepsShortTextAndCutsBetweenCharacters) {
  EXPECT_EQ(shortened("short"), "short");
  EXPECT_EQ(shortened("abcdef", 3), "abc…");
  EXPECT_EQ(shortened("äöü", 4), "äö…");
  EXPECT_EQ(shortened("äöü", 3), "ä…");
  EXPECT_EQ(shortened("äöü", 6), "äöü");
}

TEST(Shortened, ReplacesControlCharacters) { EXPECT_EQ(shortened("a\nb\x1B[0m\x7F"), "a b [0m "); }

}  // namespace
}  // namespace msml
