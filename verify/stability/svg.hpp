#pragma once

/// \file
/// As much of SVG as a picture of rectangles and words needs: a small text writer, since no library
/// here writes a picture that follows the reader's light or dark scheme and says more where one points.

#include <string>
#include <string_view>

namespace touchstone::verify {

/// The text as it may stand in XML, in an attribute too: markup escaped, and what is not printable
/// (printable.hpp) replaced by U+FFFD, but for tabs and line ends.
[[nodiscard]] std::string xml_escaped(std::string_view text);

/// A rectangle in units of the picture, from its upper left corner.
struct SvgBox {
  double x;
  double y;
  double width;
  double height;
};

/// Writes one picture. Texts are escaped here; classes are words of our own.
class SvgPicture {
 public:
  /// \param style The style sheet, our own too: it must have no "]]>".
  SvgPicture(double width, double height, std::string_view title, std::string_view style);

  void add_rectangle(const SvgBox& box, std::string_view css_class);

  /// Text on a baseline; where it is anchored, and how it looks, is the class's to say.
  void add_text(double x, double y, std::string_view css_class, std::string_view text);

  /// What stands between these two has a description, shown where one points at it.
  void begin_group(std::string_view description);
  void end_group();

  /// The whole document. \pre no group is open; called once.
  [[nodiscard]] std::string finish();

 private:
  std::string text_;
};

}  // namespace touchstone::verify
