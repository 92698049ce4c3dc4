/// \file
/// libFuzzer on the checker: no bytes make it crash, hang, or read or write where it must not.
///
/// The fuzzer's own mutations seldom leave a certificate readable, so half of ours are of its
/// words: replaced by words of the format or of the same certificate, lines swapped, doubled or
/// left out. What is accepted is held against a second look: nothing is accepted without a `claim`
/// and an `end` line each, no stream without a closing line of its number, and the counts agree
/// with the reasons.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "exact/checker/checker.hpp"

namespace {

using Words = std::vector<std::string>;

/// The text cut behind every character that `separator` is: joined again, it is the text.
Words cut(std::string_view text, char separator) {
  Words words;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find(separator), text.size() - 1) + 1;
    words.emplace_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return words;
}

std::string join(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += word;
  return text;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutate(std::string_view text) {
    Words lines = cut(text, '\n');
    if (lines.empty()) return "touchstone-certificates 2\n";
    const std::size_t at = below(lines.size()), other = below(lines.size());
    switch (below(6)) {
      case 0:
        std::swap(lines[at], lines[other]);
        break;
      case 1:
        lines[at] += lines[other];
        break;
      case 2:
        lines[at].clear();
        break;
      default:
        lines[at] = mutate_word(lines[at], lines[other]);
    }
    return join(lines);
  }

 private:
  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }

  std::string mutate_word(const std::string& line, const std::string& other) {
    // (The last word is empty.)
    static const Words vocabulary =
        cut("0 1 -1 2 3 1/2 1/3 -7/5 0x1p+0 0x1p-1074 0x1.fffffffffffffp+1023 0x1p-16383 "
            "0x1p+16383 123456789012345678901234567890 vertex edge face + - triangle segment "
            "axis cross axes separation linf l2 x y z time root no_collision collision "
            "time_of_impact vertex_face edge_edge nan certificates vertices faces edges "
            "points groups apart sweep no_contact earliest pair vertex_edge vertex_vertex "
            "step steps mesh meshes intersections separations plane line  ",
            ' ');
    Words words = cut(line, ' ');
    const Words from = cut(other, ' ');
    if (words.empty() || from.empty()) return line;
    std::string& word = words[below(words.size())];
    const char last = word.back();
    word = below(2) == 0 ? from[below(from.size())] : vocabulary[below(vocabulary.size())];
    while (word.ends_with(' ') || word.ends_with('\n')) word.pop_back();
    if (last == ' ' || last == '\n') word += last;
    return join(words);
  }

  std::mt19937 random_;
};

void require(bool holds) {
  if (!holds) std::abort();
}

std::size_t count_lines(const Words& lines, std::string_view beginning) {
  return static_cast<std::size_t>(std::ranges::count_if(
      lines, [&](const std::string& line) { return line.starts_with(beginning); }));
}

}  // namespace

// Names and types are libFuzzer's.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (seed % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string text = Mutator(seed).mutate(std::string(data, data + size));
  const std::size_t length = std::min(text.size(), max_size);
  std::copy_n(text.begin(), length, data);
  return length;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  std::istringstream stream(text);
  const touchstone::checker::Report report =
      touchstone::checker::check(stream, {.max_rejections = 3});
  const Words lines = cut(text, '\n');
  require(report.accepted() <= count_lines(lines, "end\n"));
  require(report.accepted() <= count_lines(lines, "claim "));
  require(report.no_collision <= count_lines(lines, "claim no_collision\n"));
  require(report.collision <= count_lines(lines, "claim collision\n"));
  require(report.time_of_impact <= count_lines(lines, "claim time_of_impact "));
  require(!report.all_accepted() ||
          count_lines(lines, "certificates " + std::to_string(report.accepted()) + "\n") +
                  count_lines(lines, "steps " + std::to_string(report.accepted()) + "\n") +
                  count_lines(lines, "meshes " + std::to_string(report.accepted()) + "\n") >
              0);
  require(report.steps.size() <= count_lines(lines, "step "));
  require(report.meshes.size() <= count_lines(lines, "mesh "));
  require(report.rejections.size() == std::min<std::uint64_t>(report.rejected, 3));
  for (const auto& rejection : report.rejections) {
    require(rejection.line >= 1 && rejection.line <= lines.size() + 1 && !rejection.reason.empty());
    for (const char c : rejection.label + rejection.reason) require(c >= ' ' && c <= '~');
  }
  return 0;
}
// NOLINTEND(readability-identifier-naming)
