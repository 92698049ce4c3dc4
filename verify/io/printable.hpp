#pragma once

/// \file
/// External text (names of files and plugins, labels, messages of the system), made safe for
/// terminals and tables.
///
/// A name may hold any bytes: escape codes that move the cursor, line ends that forge a row of a
/// table, marks that reverse the direction of writing, markup. *Printable* text is one line of
/// well-formed UTF-8 without control characters (C0, DEL, C1), separators of lines (U+2028, U+2029)
/// and marks of direction (U+061C, U+200E, U+200F, U+202A–U+202E, U+2066–U+2069). All texts below
/// are printable.

#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// The text with every other byte as \xHH.
[[nodiscard]] std::string printable(std::string_view text);

/// True if the text is printable.
[[nodiscard]] bool is_printable(std::string_view text);

/// The text in HTML, also in an attribute.
[[nodiscard]] std::string html_escaped(std::string_view text);

/// The text as a word of a shell.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace touchstone::verify::io
