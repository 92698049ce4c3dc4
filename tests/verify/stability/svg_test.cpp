#include "verify/stability/svg.hpp"

#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>
#include <string>

namespace touchstone::verify::svg_test {
namespace {

const std::string replacement = "\xEF\xBF\xBD";

TEST(XmlEscaped, EscapesMarkup) {
  EXPECT_EQ(xml_escaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&apos;");
  EXPECT_EQ(xml_escaped("]]>"), "]]&gt;");
  EXPECT_EQ(xml_escaped(""), "");
}

TEST(XmlEscaped, KeepsTextInAnyLanguage) {
  const std::string text = "2⁻⁵⁰ µs — é 字 \xF0\x9F\x98\x80\t\n";
  EXPECT_EQ(xml_escaped(text), text);
}

TEST(XmlEscaped, ReplacesWhatIsNoCharacterOfXml) {
  EXPECT_EQ(xml_escaped(std::string("a\0b", 3)), "a" + replacement + "b");
  EXPECT_EQ(xml_escaped("\x1b[31m"), replacement + "[31m");
  EXPECT_EQ(xml_escaped("\xEF\xBF\xBE"), replacement);
}

TEST(XmlEscaped, ReplacesWhatIsNoUtf8ByteByByte) {
  EXPECT_EQ(xml_escaped("caf\xE9"), "caf" + replacement);
  EXPECT_EQ(xml_escaped("\xC0\xAF"), replacement + replacement);              // overlong
  EXPECT_EQ(xml_escaped("\xE0\x80\xAF").size(), 3 * replacement.size());      // overlong
  EXPECT_EQ(xml_escaped("\xED\xA0\x80").size(), 3 * replacement.size());      // a surrogate
  EXPECT_EQ(xml_escaped("\xF4\x90\x80\x80").size(), 4 * replacement.size());  // beyond U+10FFFF
  EXPECT_EQ(xml_escaped("\xE5\xAD"), replacement + replacement);              // cut off
  EXPECT_EQ(xml_escaped("\x80"), replacement);
}

TEST(XmlEscaped, ReplacesWhatIsNotSeen) {
  EXPECT_EQ(xml_escaped("a\u202eb\u2028c\u0085d"),
            "a" + replacement + "b" + replacement + "c" + replacement + "d");
}

TEST(SvgPicture, IsAnXmlDocumentOfItsParts) {
  SvgPicture picture(100, 50.5, "a <title>", "text{fill:red}\n");
  picture.add_rectangle({1, 2, 3, 4.5}, "calm");
  picture.begin_group("more & more");
  picture.add_text(10, 20, "n on-dark", "5 < 6");
  picture.end_group();
  std::istringstream text(picture.finish());
  boost::property_tree::ptree tree;
  boost::property_tree::read_xml(text, tree);
  const auto& svg = tree.get_child("svg");
  EXPECT_EQ(svg.get<std::string>("<xmlattr>.xmlns"), "http://www.w3.org/2000/svg");
  EXPECT_EQ(svg.get<std::string>("<xmlattr>.viewBox"), "0 0 100 50.5");
  EXPECT_EQ(svg.get<std::string>("title"), "a <title>");
  EXPECT_EQ(svg.get<std::string>("style"), "\ntext{fill:red}\n");
  EXPECT_EQ(svg.get<std::string>("rect.<xmlattr>.height"), "4.5");
  EXPECT_EQ(svg.get<std::string>("rect.<xmlattr>.class"), "calm");
  EXPECT_EQ(svg.get<std::string>("g.title"), "more & more");
  EXPECT_EQ(svg.get<std::string>("g.text"), "5 < 6");
  EXPECT_EQ(svg.get<std::string>("g.text.<xmlattr>.x"), "10");
}

}  // namespace
}  // namespace touchstone::verify::svg_test
