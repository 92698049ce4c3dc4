#include "verify/io/words.hpp"

#include <algorithm>

namespace touchstone::verify::io {

std::string_view take_word(std::string_view& line) {
  static constexpr std::string_view blanks = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace touchstone::verify::io
