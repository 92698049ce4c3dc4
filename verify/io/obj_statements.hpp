#pragma once

/// \file
/// The statements of Wavefront OBJ files.
///
/// A line is a keyword and its words, between spaces and tabs; it goes on in the next one if it
/// ends in a backslash. A '#' begins a comment, but not in a name, nor in 1.#IND. The
/// keywords are a finite list: v, f (in old files fo), l, p, g and o are returned, those that
/// change no primitive are counted, and all else is an error, because it may stand for a primitive.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "verify/io/input_file.hpp"

namespace touchstone::verify::io {

/// A statement; its texts are valid until the next one is read.
struct ObjStatement {
  std::string_view keyword;  ///< v, f, l, p, g or o
  std::string_view words;    ///< all behind it, without a comment
  std::uint64_t line;        ///< on which it begins, counted from 1
};

/// The statements of a file, in their order.
class ObjStatements {
 public:
  /// \throws DatasetError if the file cannot be opened.
  explicit ObjStatements(const std::filesystem::path& path) : lines_(path) {}

  /// The next one; empty at the end.
  /// \throws DatasetError with the line, for a keyword that is not read or known, a line that is
  /// too long, and lines whose joint could be read in two ways. As LineReader::next.
  [[nodiscard]] std::optional<ObjStatement> next();

  /// Passes over what may follow the coordinates of a vertex: the weight 1, or three numbers of a
  /// colour.
  /// \throws DatasetError for anything else.
  void pass_over_behind_vertex(std::string_view words, std::uint64_t line);

  /// What was passed over, with its number: "vt 3".
  [[nodiscard]] std::vector<std::string> passed_over() const;

 private:
  [[nodiscard]] std::string_view joined(const Line& line);
  void check_joint(const Line& line) const;
  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const;

  LineReader lines_;
  std::string joined_;
  std::map<std::string, std::uint64_t, std::less<>> passed_over_;
};

}  // namespace touchstone::verify::io
