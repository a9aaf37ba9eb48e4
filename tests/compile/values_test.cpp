// SPDX-License-Identifier: GPL-3.0-or-later
// Literals: types, ranges, choices, lengths, indices.
#include <gtest/gtest.h>

#include "tests/compile/scenes.hpp"

namespace msml {
namespace {

using tiny::task_faults;

/// Faults of one MakeSurface with the attributes given.
std::string of(const std::string& attributes) { return task_faults("<MakeSurface " + attributes + "/>"); }

TEST(Values, NumberMustBeANumber) {
  EXPECT_EQ(of("radius=\"big\""), "s.xml:2: radius = big is not a number");
  EXPECT_EQ(of("radius=\"3mm\""), "s.xml:2: radius = 3mm is not a number");
  EXPECT_EQ(of("radius=\"\""), "s.xml:2: radius = '' is not a number");
  EXPECT_EQ(of("radius=\"1 2\""), "s.xml:2: radius = 1 2 is not a number");
  EXPECT_EQ(of("radius=\"+-3\""), "s.xml:2: radius = +-3 is not a number");
  EXPECT_EQ(of("radius=\"3,5\""), "s.xml:2: radius = 3,5 is not a number");
}

TEST(Values, NumberMustBeFinite) {
  EXPECT_EQ(of("radius=\"nan\""), "s.xml:2: radius = nan is not a finite number");
  EXPECT_EQ(of("radius=\"inf\""), "s.xml:2: radius = inf is not a finite number");
  EXPECT_EQ(of("radius=\"-infinity\""), "s.xml:2: radius = -infinity is not a finite number");
  EXPECT_EQ(of("radius=\"1e999\""), "s.xml:2: radius = 1e999 is out of the range of numbers");
}

TEST(Values, NumberMustLieInItsRange) {
  EXPECT_EQ(of("radius=\"0\""), "s.xml:2: radius = 0 is not > 0");
  EXPECT_EQ(of("radius=\"-3\""), "s.xml:2: radius = -3 is not > 0");
  EXPECT_EQ(of("angle=\"30.5\""), "s.xml:2: angle = 30.5 is not in [0, 30]");
  EXPECT_EQ(of("share=\"1\""), "s.xml:2: share = 1 is not in [0, 1)");
  EXPECT_EQ(of("share=\"-0.001\""), "s.xml:2: share = -0.001 is not in [0, 1)");
}

TEST(Values, EndsOfAClosedRangeAreAllowed) {
  EXPECT_EQ(of("angle=\"0\""), "");
  EXPECT_EQ(of("angle=\" 30 \""), "");
  EXPECT_EQ(of("share=\"0\""), "");
  EXPECT_EQ(of("radius=\"+1.5e-3\""), "");
}

/// The start of every fault of an expression, without the long list of what is allowed.
std::string start_of(const std::string& attributes) {
  const std::string fault = of(attributes);
  return fault.substr(0, fault.find("; an expression may use X, Y, Z"));
}

TEST(Values, FormulaMayBeANumberOrAnExpression) {
  for (const char* text : {"2", " +1e-3 ", "1 + X^2", "2*pi", "min(1, t) + exp(-Z)", "X > 0 ? 1 : 2"})
    EXPECT_EQ(of("height=\"" + std::string(text) + "\""), "") << text;
}

TEST(Values, FaultOfAnExpressionNamesItsPlace) {
  EXPECT_EQ(start_of("height=\"1 + x\""), "s.xml:2: height = 1 + x: 'x' at position 5 is unknown");
  EXPECT_EQ(start_of("height=\"2*(X + Y\""), "s.xml:2: height = 2*(X + Y: a closing parenthesis is missing");
  EXPECT_EQ(start_of("height=\"2*\""), "s.xml:2: height = 2*: it ends too early");
  EXPECT_EQ(start_of("height=\"3mm\""), "s.xml:2: height = 3mm: 'mm' at position 2 is unknown");
  EXPECT_EQ(start_of("height=\"\""), "s.xml:2: height = : it is empty");
  EXPECT_EQ(start_of("height=\"1,5\""), "s.xml:2: height = 1,5: it gives 2 values instead of one");
  EXPECT_EQ(start_of("height=\"X = 3\""),
            "s.xml:2: height = X = 3: '=' at position 3 does not fit there (to compare, ==)");
  EXPECT_EQ(start_of("height=\"sin(1, 2)\""),
            "s.xml:2: height = sin(1, 2): a function before ')' at position 9 has too many arguments");
}

TEST(Values, ExpressionOfNothingIsItsNumber) {
  EXPECT_EQ(of("height=\"-2*pi\""), "s.xml:2: height = -2*pi is not > 0");
  EXPECT_EQ(of("height=\"1/0\""), "s.xml:2: height = 1/0 is not a finite number");
  EXPECT_EQ(of("height=\"-3\""), "s.xml:2: height = -3 is not > 0");
  EXPECT_EQ(of("height=\"inf\""), "s.xml:2: height = inf is not a finite number");
}

TEST(Values, ListOfExpressionsIsSplitAtCommasOrBlanks) {
  for (const char* list : {"0 0 1", "0,0,1", "sin(t) 0 0", "1 - X, 0, 0", "{X, atan2(Y, X), 0}", "max(X, 1) 0 0"})
    EXPECT_EQ(of("normal=\"" + std::string(list) + "\""), "") << list;
  EXPECT_EQ(of("normal=\"X Y\""), "s.xml:2: normal has 2 values, but needs 3");
  EXPECT_EQ(of("weights=\"1 - X\""), "");  // one expression where one value is enough
  EXPECT_EQ(of("weights=\"X, -Y\""), "");
  EXPECT_EQ(start_of("normal=\"0 0 x\""), "s.xml:2: normal: entry 3 of the list = x: 'x' at position 1 is unknown");
  const std::string hint = of("normal=\"1 - X 0 0\"");
  EXPECT_TRUE(hint.ends_with("; entries that hold blanks are separated by commas")) << hint;
}

TEST(Values, WordsAreCheckedOneByOne) {
  EXPECT_EQ(of("sides=\"left, right\""), "");
  EXPECT_EQ(of("sides=\"left rigth\""), "s.xml:2: sides = rigth is not one of left, right (did you mean 'right'?)");
}

TEST(Values, OwnCheckOfASlotIsMade) {
  EXPECT_EQ(of("table=\"1 2\""), "");
  EXPECT_EQ(of("table=\"1 5\""), "s.xml:2: table: 5 does not belong there");
}

TEST(Values, IntegerMustBeAnInteger) {
  EXPECT_EQ(of("count=\"3.5\""), "s.xml:2: count = 3.5 is not an integer");
  EXPECT_EQ(of("count=\"many\""), "s.xml:2: count = many is not an integer");
  EXPECT_EQ(of("count=\"99999999999999999999\""),
            "s.xml:2: count = 99999999999999999999 is out of the range of integers");
  EXPECT_EQ(of("count=\"0\""), "s.xml:2: count = 0 is not in [1, 100]");
  EXPECT_EQ(of("count=\"101\""), "s.xml:2: count = 101 is not in [1, 100]");
}

TEST(Values, BooleanHasEightSpellings) {
  for (const char* text : {"true", "FALSE", "1", "0", "yes", "No", "on", "off"})
    EXPECT_EQ(of("smooth=\"" + std::string(text) + "\""), "") << text;
  EXPECT_EQ(of("smooth=\"maybe\""),
            "s.xml:2: smooth = maybe is not a boolean: true or false, 1 or 0, yes or no, on or off");
}

TEST(Values, ChoiceMustBeOneOfThem) {
  EXPECT_EQ(of("method=\"exakt\""), "s.xml:2: method = exakt is not one of fast, exact (did you mean 'exact'?)");
  EXPECT_EQ(of("method=\"\""), "s.xml:2: method = '' is not one of fast, exact");
}

TEST(Values, ListsMayUseBlanksCommasAndBraces) {
  for (const char* list : {"0 0 1", "0,0,1", "0, 0, 1", "{0.0, 0.2, 0.0}", " { 0 0 1 } ", "0\n0\t1"})
    EXPECT_EQ(of("centers=\"" + std::string(list) + "\""), "") << list;
}

TEST(Values, ListMustHaveTheRightLength) {
  EXPECT_EQ(of("centers=\"1 2 3 4\""), "s.xml:2: centers has 4 values, but needs a multiple of 3");
  EXPECT_EQ(of("centers=\"\""), "s.xml:2: centers has 0 values, but needs a multiple of 3");
  EXPECT_EQ(task_faults("<Fill id=\"f\" surfaceMesh=\"${m}\" cellSize=\"1\"/><MakeSurface id=\"m\"/>\n"
                        "<Pick mesh=\"${f}\" select=\"points\" box=\"1 2 3\"/>"),
            "s.xml:3: box has 3 values, but needs 6");
}

TEST(Values, ListEntriesAreCheckedOneByOne) {
  EXPECT_EQ(of("centers=\"1 two 3\""), "s.xml:2: centers: entry 2 of the list = two is not a number");
  EXPECT_EQ(of("centers=\"1 2 nan\""), "s.xml:2: centers: entry 3 of the list = nan is not a finite number");
  EXPECT_EQ(of("centers=\"1 2 1e400\""),
            "s.xml:2: centers: entry 3 of the list = 1e400 is out of the range of numbers");
  EXPECT_EQ(of("ids=\"1 2.5\""), "s.xml:2: ids: entry 2 of the list = 2.5 is not an integer");
}

TEST(Values, IndicesAreWholeNumbersFromZero) {
  const auto where = [](const std::string& list) { return task_faults("<Paint where=\"" + list + "\"/>"); };
  EXPECT_EQ(where("0 1 2"), "");
  EXPECT_EQ(where(""), "s.xml:2: where = '' is an empty list of indices");
  EXPECT_EQ(where("{}"), "s.xml:2: where = {} is an empty list of indices");
  EXPECT_EQ(where("3 -1"), "s.xml:2: where: entry 2 of the list = -1 is not in [0, 2147483647]");
  EXPECT_EQ(where("3 1.5"), "s.xml:2: where: entry 2 of the list = 1.5 is not an integer");
  EXPECT_EQ(where("2147483648"), "s.xml:2: where: entry 1 of the list = 2147483648 is not in [0, 2147483647]");
}

TEST(Values, FaultInAVariableNamesItsLine) {
  EXPECT_EQ(tiny::faults_of(tiny::with_variables("<var name=\"r\" value=\"-1\"/>\n", "<MakeSurface radius=\"${r}\"/>")),
            "s.xml:4: radius = -1 is not > 0 (from the variable at line 2)");
}

TEST(Values, LiteralIndexListCountsWhatItsVariableSays) {
  const Compilation result = tiny::compiled(tiny::with_variables("<var name=\"f\" value=\"3 1\" logical=\"FaceSet\"/>",
                                                                 "<Paint where=\"${f}\"/><Paint where=\"7\"/>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  const auto set = [&](std::size_t node) {
    return std::get<IndexSetPtr>(std::get<Value>(result.graph.nodes.at(node).args.sources.at(0)));
  };
  EXPECT_EQ(set(0)->kind, Indexed::faces);
  EXPECT_EQ(set(0)->ids, (std::vector<int>{3, 1}));
  EXPECT_EQ(set(1)->kind, Indexed::nodes);
}

TEST(Values, LongValuesAreCutBetweenCharacters) {
  std::string long_word;
  for (int i = 0; i < 50; ++i) long_word += "ö";
  std::string shown;
  for (int i = 0; i < 30; ++i) shown += "ö";
  EXPECT_EQ(of("radius=\"" + long_word + "\""), "s.xml:2: radius = " + shown + "… is not a number");
}

TEST(Values, MessagesStayOnOneLine) {
  EXPECT_EQ(of("radius=\"a\nb&#27;[31m\""), "s.xml:2: radius = a b [31m is not a number");
}

TEST(Values, DefaultsStandWhereTheSceneSaysNothing) {
  const Compilation result = tiny::compiled(tiny::workflow("<MakeSurface angle=\"7\"/>"));
  ASSERT_EQ(tiny::lines(result.faults), "");
  const Binding& args = result.graph.nodes.at(0).args;
  const auto value = [&](const char* name) {
    return std::get<Value>(args.sources.at(static_cast<std::size_t>(args.description->find(name))));
  };
  EXPECT_EQ(std::get<double>(value("radius")), 1.0);
  EXPECT_EQ(std::get<double>(value("angle")), 7.0);
  EXPECT_EQ(std::get<Integer>(value("count")), 8);
  EXPECT_EQ(std::get<std::string>(value("method")), "fast");
  EXPECT_EQ(type(value("label")), Type::nothing);
  EXPECT_FALSE(args.given.at(0));
  EXPECT_TRUE(args.given.at(1));
}

}  // namespace
}  // namespace msml
