// SPDX-License-Identifier: GPL-3.0-or-later
// Positions, limits and refusals of the document reader.
#include "core/xml/document.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

struct Read {
  Document document;
  std::string messages;
};

Read read(std::string_view text, const DocumentLimits& limits = {}) {
  Diagnostics d;
  Document doc = parse_document(text, "f.xml", d, limits);
  return {std::move(doc), d.format()};
}

TEST(Document, KeepsEveryPosition) {
  const auto r = read(
      "<?xml version=\"1.0\"?>\n<!-- hi -->\n<scene  title = \"a\"\n    seed='2'>\n\t<body "
      "id=\"x&amp;y\"/>\n</scene>\n");
  ASSERT_TRUE(r.document.root) << r.messages;
  const Element& root = *r.document.root;
  EXPECT_EQ(root.pos.line, 3);
  EXPECT_EQ(root.pos.column, 1);
  ASSERT_EQ(root.attributes.size(), 2u);
  EXPECT_EQ(root.attributes[0].name_pos.column, 9);
  EXPECT_EQ(root.attributes[0].value_pos.column, 18);
  EXPECT_EQ(root.attributes[1].name_pos.line, 4);
  EXPECT_EQ(root.attributes[1].name_pos.column, 5);
  EXPECT_EQ(root.attributes[1].value_pos.column, 11);
  ASSERT_EQ(root.children.size(), 1u);
  EXPECT_EQ(root.children[0]->pos.line, 5);
  EXPECT_EQ(root.children[0]->pos.column, 2);
  EXPECT_EQ(root.children[0]->find("id")->value, "x&y");
  EXPECT_EQ(root.children[0]->find("no"), nullptr);
}

TEST(Document, ColumnsCountCharacters) {
  const auto r = read("\xEF\xBB\xBF<scene title=\"\xC3\xA4\xE2\x82\xAC\" seed=\"1\"/>");
  ASSERT_TRUE(r.document.root) << r.messages;
  EXPECT_EQ(r.document.root->pos.column, 1);
  EXPECT_EQ(r.document.root->attributes[1].name_pos.column, 19);
}

TEST(Document, LineEndsOfAllSystems) {
  for (const char* text : {"<a>\n<b/>\n</a>", "<a>\r\n<b/>\r\n</a>", "<a>\r<b/>\r</a>"}) {
    const auto r = read(text);
    ASSERT_TRUE(r.document.root) << r.messages;
    EXPECT_EQ(r.document.root->children[0]->pos.line, 2);
    EXPECT_EQ(r.document.root->children[0]->pos.column, 1);
  }
}

struct Refused {
  const char* text;
  const char* message;
};

TEST(Document, Refusals) {
  const Refused cases[] = {
      {"", "f.xml:1:1: error: the file is empty"},
      {" \n ", "the file is empty"},
      {"<!-- only a comment -->", "the file ends before its first element"},
      {"<a>", "f.xml:1:4: error: the file ends before <a> of line 1 is closed"},
      {"<a>\n<b>", "the file ends before <b> of line 2 is closed"},
      {"<a>\n</b>", "f.xml:2:1: error: </b> closes <a> of line 1"},
      {"<a x=\"1\" y=\"2\" x=\"3\"/>", "f.xml:1:16: error: attribute \"x\" is written twice"},
      {"<a>\n  text</a>", "f.xml:2:3: error: text \"text\" may not stand here"},
      {"<a><![CDATA[x]]></a>", "text \"x\" may not stand here"},
      {"<a>&amp;</a>", "text \"&\" may not stand here"},
      {"<a/><b/>", "f.xml:1:5: error: nothing may follow the root element"},
      {"<a b=1/>", "f.xml:1:6: error: not well-formed XML: a value must stand in quotes"},
      {"<a b=\"<\"/>", "not well-formed XML: \"<\" may not stand here"},
      {"<a b=\"x & y\"/>", "f.xml:1:10: error: not well-formed XML: write \"&amp;\" for an ampersand"},
      {"<a>&nbsp;</a>", "f.xml:1:4: error: unknown entity"},
      {"<a b=\"&lt;&x;\"/>", "f.xml:1:11: error: unknown entity"},
      {"<!DOCTYPE a><a/>", "f.xml:1:1: error: document types are not allowed in scene files"},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]>\n<a>&b;</a>", "document types are not allowed"},
      {"<!DOCTYPE a SYSTEM \"file:///etc/passwd\"><a/>", "document types are not allowed"},
      {"<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a/>",
       "f.xml:1:1: error: encoding \"ISO-8859-1\" is not supported; save the file as UTF-8"},
      {"<?xml version=\"1.1\"?><a/>", "only XML 1.0 is supported"},
      {"<a b=\"\xE4\"/>", "f.xml:1:7: error: invalid UTF-8"},
      {"\xFF\xFE<\0a\0", "the file is written in UTF-16; save it as UTF-8"},
      {"\xFE\xFF", "UTF-16"},
      {"plain text", "f.xml:1:1: error: this is no XML"},
      {"\x7F"
       "ELF",
       "not well-formed XML"},
  };
  for (const auto& c : cases) {
    const auto r = read(c.text);
    EXPECT_NE(r.messages.find(c.message), std::string::npos) << c.text << "\ngave: " << r.messages;
  }
}

TEST(Document, ZeroBytesAndOtherWidths) {
  EXPECT_NE(
      read(std::string_view("<a b=\"x\0y\"/>", 12)).messages.find("f.xml:1:8: error: the file contains a zero byte"),
      std::string::npos);
  EXPECT_NE(read(std::string_view("<\0a\0/\0>\0", 8)).messages.find("UTF-16"), std::string::npos);
  EXPECT_NE(read(std::string_view("\0<\0a\0/\0>", 8)).messages.find("UTF-16"), std::string::npos);
  EXPECT_NE(read(std::string_view("\xFF\xFE\0\0<\0\0\0", 8)).messages.find("UTF-32"), std::string::npos);
}

TEST(Document, GoodEncodings) {
  for (const char* text :
       {"<?xml version=\"1.0\" encoding=\"utf-8\"?><a/>", "<?xml version='1.0' encoding='US-ASCII'?><a/>",
        "\xEF\xBB\xBF<a/>", "<?xml-model href=\"insula.xsd\"?><a/>", "<a></a>", "<a  />", "<a\n/>",
        "<a>\n<!-- <b> -->\n</a>"}) {
    const auto r = read(text);
    EXPECT_TRUE(r.document.root) << text << ": " << r.messages;
  }
}

std::string nested(std::size_t depth) {
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += "<a>";
  return text;
}

TEST(Document, NestingIsLimited) {
  std::string fine = nested(64);
  for (int i = 0; i < 64; ++i) fine += "</a>";
  EXPECT_TRUE(read(fine).document.root);
  const auto r = read(nested(65));
  EXPECT_FALSE(r.document.root);
  EXPECT_EQ(r.messages, "f.xml:1:193: error: elements are nested more than 64 deep\n");
  // 15 MB of it are no worse: the reader stops at the 65th.
  EXPECT_EQ(read(nested(5'000'000)).messages, r.messages);
}

TEST(Document, HugeFilesAreNotRead) {
  const auto r = read(nested(35'000'000));
  EXPECT_EQ(r.messages, "f.xml: error: the file is larger than 16 MiB\n");
}

TEST(Document, OtherLimits) {
  DocumentLimits limits;
  limits.elements = 10;
  limits.attributes = 2;
  limits.value_bytes = 1024;
  limits.all_attributes = 5;
  limits.name_bytes = 8;
  EXPECT_NE(read("<a><b/><b/><b/><b/><b/><b/><b/><b/><b/><b/></a>", limits).messages.find("more than 10 elements"),
            std::string::npos);
  EXPECT_NE(read("<a b='' c='' d=''/>", limits).messages.find("f.xml:1:14: error: <a> has more than 2 attributes"),
            std::string::npos);
  EXPECT_NE(read("<a b='" + std::string(2000, 'x') + "'/>", limits).messages.find("longer than 1 KiB"),
            std::string::npos);
  EXPECT_NE(read("<abcdefghi/>", limits).messages.find("too long"), std::string::npos);
  EXPECT_NE(read("<a abcdefghi=''/>", limits).messages.find("too long"), std::string::npos);
  EXPECT_NE(
      read("<a><b c='' d=''/><b c='' d=''/><b c='' d=''/></a>", limits).messages.find("more than 5 attributes in all"),
      std::string::npos);
}

TEST(Document, OneComplaintAboutTextAnElement) {
  const auto r = read("<a>one <b/> two</a>");
  EXPECT_EQ(r.messages, "f.xml:1:4: error: text \"one\" may not stand here; values are written as attributes\n");
}

}  // namespace
}  // namespace insula
