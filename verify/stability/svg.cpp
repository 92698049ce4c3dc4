#include "verify/stability/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace touchstone::verify {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Length of the well-formed UTF-8 sequence in front that is a character of XML; 0 if there is none.
std::size_t character_length(std::string_view text) {
  const unsigned lead = byte_at(text, 0);
  if (lead < 0x80) return lead >= 0x20 || lead == '\t' || lead == '\n' ? 1 : 0;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  std::uint32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const unsigned next = byte_at(text, i);
    if ((next & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (next & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  const bool beyond = code > 0x10FFFF || code == 0xFFFE || code == 0xFFFF;
  return overlong || surrogate || beyond ? 0 : length;
}

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
    const std::size_t length = character_length(text);
    const std::string_view markup = entity(text.front());
    if (length == 0) {
      result += replacement;
    } else if (!markup.empty()) {
      result += markup;
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
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
