#include "verify/stability/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "verify/io/printable.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

std::string_view entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&apos;";
    default:
      return {};
  }
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character character = first_character(text);
    const std::string_view markup = entity(text.front());
    const bool is_space = text.front() == '\t' || text.front() == '\n';
    if (!is_space && !is_printable(character)) {
      result += replacement;
    } else if (!markup.empty()) {
      result += markup;
    } else {
      result += text.substr(0, character.length);
    }
    text.remove_prefix(std::max<std::size_t>(character.length, 1));
  }
  return result;
}

SvgPicture::SvgPicture(double width, double height, std::string_view title,
                       std::string_view style) {
  text_ = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" style=\"max-width:100%;height:auto\" role=\"img\">\n"
      "<title>{2}</title>\n<style><![CDATA[\n{3}]]></style>\n",
      width, height, xml_escaped(title), style);
}

void SvgPicture::add_rectangle(const SvgBox& box, std::string_view css_class) {
  fmt::format_to(std::back_inserter(text_),
                 "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"{}\"/>\n", box.x,
                 box.y, box.width, box.height, css_class);
}

void SvgPicture::add_text(double x, double y, std::string_view css_class, std::string_view text) {
  fmt::format_to(std::back_inserter(text_), "<text x=\"{}\" y=\"{}\" class=\"{}\">{}</text>\n", x,
                 y, css_class, xml_escaped(text));
}

void SvgPicture::begin_group(std::string_view description) {
  fmt::format_to(std::back_inserter(text_), "<g><title>{}</title>\n", xml_escaped(description));
}

void SvgPicture::end_group() { text_ += "</g>\n"; }

std::string SvgPicture::finish() { return std::move(text_) + "</svg>\n"; }

}  // namespace touchstone::verify
