#pragma once

/// \file External text (names of files and plugins, labels, messages of the system), made safe for
/// terminals and tables.
///
/// A name may hold any bytes: escape codes that move the cursor, line ends that forge a row of a table,
/// marks that reverse the direction of writing, markup. *Printable* text is one line of well-formed
/// UTF-8 without any of them:
///   - no control characters (C0, DEL, C1),
///   - no line or paragraph separators (U+2028, U+2029),
///   - no marks of direction (U+061C, U+200E, U+200F, U+202A–U+202E, U+2066–U+2069),
///   - no other invisible characters (U+200B, U+2060–U+2065, U+206A–U+206F, U+FEFF, U+FFF9–U+FFFB, the
///     tags U+E0000–U+E007F), but for the joiners that scripts need (U+200C, U+200D),
///   - no code points that are no characters (U+FDD0–U+FDEF, the last two of each plane).
/// Markdown, HTML, shells and C++ have their escapes here; CSV and JSON theirs on top: csv.hpp, and the
/// JSON library.

#include <cstddef>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// The first character of a text.
struct Character {
  /// In bytes; 0 if the text does not begin with a well-formed UTF-8 sequence.
  std::size_t length = 0;
  char32_t code = 0;
};

/// The character that a text begins with.
[[nodiscard]] Character first_character(std::string_view text);

/// True if the character is allowed in printable text.
[[nodiscard]] bool is_printable(const Character& character);

/// True if the text is printable.
[[nodiscard]] bool is_printable(std::string_view text);

/// The text with all other characters escaped: \xHH for a byte that is not UTF-8 and for an ASCII
/// character, \uHHHH or \UHHHHHHHH for any other character.
[[nodiscard]] std::string printable(std::string_view text);

/// Printable text in Markdown, also in a cell of a table: possible markup is escaped.
[[nodiscard]] std::string markdown_escaped(std::string_view text);

/// Printable text as a code span of Markdown.
[[nodiscard]] std::string markdown_code(std::string_view text);

/// Printable text as a code block of Markdown, of one line.
[[nodiscard]] std::string markdown_code_block(std::string_view text);

/// Printable text in HTML, also in an attribute.
[[nodiscard]] std::string html_escaped(std::string_view text);

/// The bytes as a word of a shell; printable. Other characters are written in $'…', as in bash and
/// zsh.
[[nodiscard]] std::string shell_word(std::string_view text);

/// The bytes as a string literal of C++; printable.
[[nodiscard]] std::string cpp_literal(std::string_view text);

}  // namespace touchstone::verify::io
