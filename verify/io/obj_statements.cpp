#include "verify/io/obj_statements.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "verify/io/dataset_error.hpp"
#include "verify/io/number_text.hpp"

namespace touchstone::verify::io {
namespace {

using Keywords = std::span<const std::string_view>;

constexpr auto returned = std::to_array<std::string_view>({"f", "fo", "g", "l", "o", "p", "v"});

/// Textures, normals, names of materials, hints for drawing, and parts of free-form curves and
/// surfaces, which are nothing without the surface itself.
constexpr auto harmless = std::to_array<std::string_view>(
    {"bevel",  "bmat",      "c_interp", "con", "cstype", "ctech",  "curv2",      "d_interp",
     "deg",    "end",       "hole",     "lod", "mg",     "mtllib", "maplib",     "parm",
     "res",    "s",         "scrv",     "sp",  "stech",  "step",   "shadow_obj", "trim",
     "usemap", "trace_obj", "usemtl",   "vn",  "vp",     "vt"});

/// Curves, surfaces, patches of the time before them, and other files.
constexpr auto not_read =
    std::to_array<std::string_view>({"bsp", "bzp", "call", "cdc", "cdp", "csh", "curv", "surf"});

bool contains(Keywords keywords, std::string_view keyword) {
  return std::ranges::find(keywords, keyword) != keywords.end();
}

/// A '#' behind a point is of a number that is none, as some programs write it: 1.#IND.
std::string_view without_comment(std::string_view text) {
  std::size_t at = text.find('#');
  while (at != std::string_view::npos && at != 0 && text[at - 1] == '.')
    at = text.find('#', at + 1);
  return text.substr(0, at);
}

bool goes_on(std::string_view text) { return without_comment(text).ends_with('\\'); }

}  // namespace

std::optional<ObjStatement> ObjStatements::next() {
  while (const auto line = lines_.next()) {
    const std::uint64_t number = line->number;
    std::string_view words = joined(*line);
    const std::string_view keyword = take_word(words);
    if (keyword.empty() || keyword.starts_with('#')) continue;
    if (contains(returned, keyword)) {
      const bool is_name = keyword == "g" || keyword == "o";
      return ObjStatement{.keyword = keyword == "fo" ? "f" : keyword,
                          .words = is_name ? words : without_comment(words),
                          .line = number};
    }
    if (contains(not_read, keyword)) {
      fail(number, quote(keyword) + " may add to the mesh and is not read: write its faces (f)");
    }
    if (!contains(harmless, keyword)) {
      fail(number, quote(keyword) +
                       " is no keyword of OBJ (v, f, l, p and others, in small letters of ASCII)");
    }
    ++passed_over_[std::string(keyword)];
  }
  return std::nullopt;
}

void ObjStatements::pass_over_behind_vertex(std::string_view words, std::uint64_t line) {
  std::vector<double> numbers;
  for (auto word = take_word(words); !word.empty(); word = take_word(words)) {
    const auto number = number_from_text<double>(word);
    if (!number) fail(line, quote(word) + " is no number, or none that a double holds");
    numbers.push_back(*number);
  }
  static constexpr std::size_t colour = 3;
  if (numbers.size() == colour) ++passed_over_["colours of vertices"];
  if (numbers.empty() || numbers.size() == colour) return;
  if (numbers.size() != 1) {
    fail(line, "three coordinates and " + std::to_string(numbers.size()) +
                   " more numbers; only a weight or three of a colour may follow");
  }
  if (numbers.front() != 1.0)
    fail(line, "a weight other than 1; only straight edges and flat faces are read");
}

std::vector<std::string> ObjStatements::passed_over() const {
  std::vector<std::string> result;
  for (const auto& [name, count] : passed_over_)
    result.push_back(name + ' ' + std::to_string(count));
  return result;
}

/// The text of a line and of those in which it goes on.
std::string_view ObjStatements::joined(const Line& line) {
  if (!goes_on(line.text)) return line.text;
  joined_ = line.text;
  while (goes_on(joined_)) {
    joined_.pop_back();
    const auto more = lines_.next();
    if (!more) break;
    check_joint(*more);
    joined_ += more->text;
    if (joined_.size() > LineReader::longest_line) fail(more->number, "line longer than 1 MiB");
  }
  return joined_;
}

/// Some programs put a blank in place of the backslash and the line's end, some put nothing: both
/// must be the same.
void ObjStatements::check_joint(const Line& line) const {
  std::string_view words = line.text;
  const std::string_view first = take_word(words);
  if (contains(returned, first) || contains(harmless, first) || contains(not_read, first)) {
    fail(line.number, "begins with " + quote(first) +
                          ", but the line before goes on, as it ends in a backslash");
  }
  if (joined_.empty() || is_blank(joined_.back()) || line.text.empty() ||
      is_blank(line.text.front()) || line.text.front() == '/') {
    return;
  }
  fail(line.number,
       "begins within a word, or with a new one: put a blank in front of the backslash before");
}

void ObjStatements::fail(std::uint64_t line, const std::string& reason) const {
  throw DatasetError(lines_.path(), {.line = line}, reason);
}

}  // namespace touchstone::verify::io
