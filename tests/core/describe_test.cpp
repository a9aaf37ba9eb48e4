// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges, slots and records.
#include "msml/core/describe.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace msml {
namespace {

TEST(Range, EndsBelongToItWhereItIsClosed) {
  EXPECT_TRUE(closed(0, 30).contains(0) && closed(0, 30).contains(30));
  EXPECT_FALSE(open(-1, 0.5).contains(-1) || open(-1, 0.5).contains(0.5));
  EXPECT_TRUE(half_open(0, 1).contains(0));
  EXPECT_FALSE(half_open(0, 1).contains(1));
  EXPECT_FALSE(positive().contains(0));
  EXPECT_TRUE(nonnegative().contains(0));
}

TEST(Range, NeverContainsNanOrInfinity) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(Range{}.contains(x));
    EXPECT_FALSE(positive().contains(x));
  }
  EXPECT_TRUE(Range{}.contains(1e308));
}

TEST(Range, ReadsAsAPhraseAfterIsNot) {
  EXPECT_EQ(positive().str(), "> 0");
  EXPECT_EQ(nonnegative().str(), ">= 0");
  EXPECT_EQ(open(-1, 0.5).str(), "in (-1, 0.5)");
  EXPECT_EQ(closed(0, 30).str(), "in [0, 30]");
  EXPECT_EQ(half_open(0, 1).str(), "in [0, 1)");
  EXPECT_EQ((Range{.high = 3}).str(), "<= 3");
  EXPECT_EQ(Range{}.str(), "finite");
}

TEST(Description, SlotIsRequiredWithoutADefault) {
  Description tag("Tag", "operator", "A tag.");
  tag.parameter("a", {.doc = "x"});
  tag.parameter("b", {.fallback = 2.0, .doc = "x"});
  tag.parameter("c", {.optional = true, .doc = "x"});
  tag.input<Mesh>("d", "x");
  tag.input<Mesh>("e", "x", true);
  std::vector<bool> required;
  for (const Slot& slot : tag.slots()) required.push_back(slot.required);
  EXPECT_EQ(required, (std::vector<bool>{true, false, false, true, false}));
  EXPECT_EQ(tag.slots()[3].type, Type::mesh);
  EXPECT_EQ(tag.find("c"), 2);
  EXPECT_EQ(tag.find("z"), -1);
}

TEST(Record, ValueOfAnAbsentAttributeIsAnErrorThatNamesIt) {
  Description tag("Tag", "operator", "A tag.");
  const auto a = tag.parameter("a", {.optional = true, .doc = "x"});
  const auto b = tag.parameter<Integer>("b", {.fallback = 2, .doc = "x"});
  const Record record{.description = &tag,
                      .where = {"s.xml", 4},
                      .id = "",
                      .values = {Value{}, Value{Integer{7}}},
                      .given = {false, true},
                      .children = {}};
  EXPECT_FALSE(record.has(a));
  EXPECT_EQ(record[b], 7);
  try {
    static_cast<void>(record[a]);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.str(), "s.xml:4: Tag has no a");
  }
}

}  // namespace
}  // namespace msml
