// SPDX-License-Identifier: GPL-3.0-or-later
// What is no scene at all: broken XML, bytes that are no text, files that are none.
#include "msml/document/document.hpp"

#include <gtest/gtest.h>

#include "tests/compile/scenes.hpp"

namespace msml {
namespace {

using tiny::faults_of;

TEST(Document, TruncatedTagIsRefused) {
  EXPECT_EQ(faults_of("<msml>\n<workflow"), "s.xml:2: malformed or unclosed tag: the file may end too early");
}

TEST(Document, UnclosedRootIsRefused) {
  EXPECT_EQ(faults_of("<msml>\n<workflow>\n</workflow>\n"),
            "s.xml:1: a tag is malformed, or not closed by the end of the file");
}

TEST(Document, MismatchedTagsAreRefused) {
  EXPECT_EQ(faults_of("<msml>\n<workflow>\n</scene>\n</msml>"),
            "s.xml:2: a tag is not closed, or is closed by another name");
}

TEST(Document, UnclosedQuoteIsRefused) {
  EXPECT_EQ(faults_of("<msml>\n<workflow a=\"3>\n</workflow></msml>"),
            "s.xml:2: malformed attribute: expected name=\"value\", each name once in a tag");
}

TEST(Document, DuplicateAttributeIsRefused) {
  EXPECT_EQ(faults_of("<msml><workflow>\n<MakeSurface radius=\"1\" radius=\"2\"/></workflow></msml>"),
            "s.xml:2: malformed attribute: expected name=\"value\", each name once in a tag");
}

TEST(Document, UnclosedCommentIsRefused) {
  EXPECT_EQ(faults_of("<msml>\n<!-- never ends\n</msml>"), "s.xml:2: a comment <!-- is not closed by -->");
}

TEST(Document, EntityBombIsRefusedWithoutExpanding) {
  const std::string bomb =
      "<!DOCTYPE msml [\n<!ENTITY a \"ha\">\n<!ENTITY b \"&a;&a;&a;&a;\">\n<!ENTITY c \"&b;&b;&b;&b;\">\n]>\n"
      "<msml><workflow>\n<MakeSurface label=\"&c;\"/></workflow></msml>";
  EXPECT_EQ(faults_of(bomb),
            "s.xml:1: document type and entity declarations (<!…>) are not allowed in a scene\n"
            "s.xml:3: &a is no character XML knows; write &amp; for an ampersand\n"
            "s.xml:4: &b is no character XML knows; write &amp; for an ampersand\n"
            "s.xml:7: &c is no character XML knows; write &amp; for an ampersand");
}

TEST(Document, EntityDeclarationInsideIsRefused) {
  EXPECT_EQ(faults_of("<msml>\n<!ENTITY a 'b'>\n</msml>"),
            "s.xml:2: a declaration (<!…>) inside msml is not allowed in a scene");
}

TEST(Document, BareAmpersandIsRefused) {
  EXPECT_EQ(tiny::task_faults("<MakeSurface label=\"salt & pepper\"/>"),
            "s.xml:2: & is no character XML knows; write &amp; for an ampersand");
}

TEST(Document, KnownEntitiesAndCommentsAreFine) {
  EXPECT_EQ(tiny::task_faults("<!-- a & b --><MakeSurface label=\"&lt;&amp;&gt;&#65;\"/>"), "");
}

TEST(Document, BytesOfAnotherEncodingAreRefused) {
  EXPECT_EQ(faults_of("<msml>\n<!-- Gr\xF6\xDF"
                      "e -->\n</msml>"),
            "s.xml:2: a byte here is not UTF-8 text");
}

TEST(Document, OverlongAndSurrogateSequencesAreNotUtf8) {
  for (const char* bytes : {"\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF0\x80\x80\xAF"})
    EXPECT_EQ(faults_of(std::string("<msml>") + bytes + "</msml>"), "s.xml:1: a byte here is not UTF-8 text");
}

TEST(Document, ControlCharactersAreRefused) {
  EXPECT_EQ(faults_of("<msml>\n\n\x01</msml>"), "s.xml:3: a byte here is not UTF-8 text");
  EXPECT_EQ(faults_of(std::string("<msml>\0</msml>", 14)), "s.xml:1: a byte here is not UTF-8 text");
}

TEST(Document, EmptyTextIsRefused) {
  EXPECT_EQ(faults_of(""), "s.xml:1: the file is empty, but a scene starts with <msml>");
  EXPECT_EQ(faults_of("  \n \n"), "s.xml:1: the file is empty, but a scene starts with <msml>");
  EXPECT_EQ(faults_of("<?xml version=\"1.0\"?>\n<!-- nothing -->"),
            "s.xml:1: the file holds no tag, but a scene starts with <msml>");
}

TEST(Document, MissingFileIsNamed) {
  std::vector<Fault> faults;
  read_document("nowhere/scene.xml", faults);
  EXPECT_EQ(tiny::lines(faults), "nowhere/scene.xml: no such file");
}

TEST(Document, FolderIsNoScene) {
  const tiny::Folder folder;
  std::vector<Fault> faults;
  read_document(folder.path(), faults);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].str(), folder.path().string() + ": is a folder, not a scene");
}

TEST(Document, RootOfAnotherLanguageIsRefused) {
  EXPECT_EQ(faults_of("<?xml version=\"1.0\"?>\n<html/>"),
            "s.xml:2: the root is <html>, but a scene starts with <msml>");
}

TEST(Document, NamespaceOfAnotherLanguageIsRefused) {
  EXPECT_EQ(faults_of("<m:msml\n xmlns:m=\"http://example.org\"/>"),
            "s.xml:2: namespace 'http://example.org' is not 'http://sfb125.de/msml'");
}

TEST(Document, NamespaceMayBeAbsentPrefixedOrDefault) {
  for (const char* root : {"<msml/>", "<msml xmlns=\"http://sfb125.de/msml\"/>",
                           "<x:msml xmlns:x=\"http://sfb125.de/msml\"/>", "\xEF\xBB\xBF<msml/>"})
    EXPECT_EQ(faults_of(root), "") << root;
}

TEST(Document, StrayTextIsRefused) {
  EXPECT_EQ(tiny::task_faults("<MakeSurface>\n  radius 3\n</MakeSurface>"),
            "s.xml:3: text 'radius 3' inside MakeSurface has no meaning; values stand in attributes");
  EXPECT_EQ(faults_of("hello\n<msml/>"), "s.xml:1: text 'hello' stands outside the scene");
}

TEST(Document, SecondRootIsRefused) {
  EXPECT_EQ(faults_of("<msml/>\n<msml/>"), "s.xml:2: <msml> stands after the end of the scene");
}

TEST(Document, TagsNestedThousandDeepAreRefused) {
  std::string deep = "<msml>";
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  for (int i = 0; i < 1000; ++i) deep += "</a>";
  EXPECT_EQ(faults_of(deep + "</msml>"), "s.xml:1: tags are nested more than 100 deep");
}

TEST(Document, AttributeOf100MegabytesIsRefused) {
  EXPECT_EQ(faults_of("<msml a=\"" + std::string(100'000'000, '1') + "\"/>"),
            "s.xml: the file has 95 MiB, more than the 64 MiB allowed; put large data in files of their own");
}

TEST(Document, LargeAttributeBelowTheLimitIsReadAndCutInMessages) {
  EXPECT_EQ(tiny::task_faults("<MakeSurface radius=\"" + std::string(20'000'000, 'x') + "\"/>"),
            "s.xml:2: radius = " + std::string(60, 'x') + "… is not a number");
}

TEST(Document, MoreThanAMillionTagsAreRefused) {
  std::string many = "<msml>";
  for (int i = 0; i < 2'000'001; ++i) many += "<a/>";
  EXPECT_EQ(faults_of(many + "</msml>"), "s.xml: the file has more than the 1000000 tags allowed");
}

TEST(Document, EveryTagAndAttributeKnowsItsLine) {
  std::vector<Fault> faults;
  const Document document = parse_document(
      "<msml>\n  <workflow>\n    <Fill id=\"a\"\n          cellSize=\"3\"/>\n"
      "  </workflow>\n</msml>",
      "dir/s.xml", faults);
  ASSERT_TRUE(faults.empty());
  const Element& fill = document.root.children.at(0).children.at(0);
  EXPECT_EQ(fill.where.line, 3);
  EXPECT_EQ(fill.find("cellSize")->where.line, 4);
  EXPECT_EQ(fill.find("id")->where.str(), "dir/s.xml:3");
  EXPECT_EQ(document.folder, "dir");
  EXPECT_EQ(fill.find("absent"), nullptr);
}

}  // namespace
}  // namespace msml
