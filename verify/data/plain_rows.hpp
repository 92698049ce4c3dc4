#pragma once

/// \file
/// Fast reading of the eight CSV rows of a query where they are plain, as nearly all are: numbers
/// without quotes, each followed at once by a comma or the end of its row; before a number there
/// may be spaces.
///
/// A number is m·10^e with a whole m < 10^19. It is a double times a power of two if e ≥ 0 and
/// m·10^e < 2^64, or if e ≥ −27 and 5^−e divides m, since then m·10^e = (m / 5^−e)·2^e; and if the
/// whole number has at most 53 significant bits, that is a double as long as the power of two does
/// not make it subnormal. Denominators are powers of two, found by their length and first digit,
/// which no two of them have in common, and compared as texts. Digits are read eight at a time, as
/// the bytes of a word.
///
/// All other texts, right or wrong, are left to the caller: rational arithmetic
/// (verify/io/coordinate_text.hpp), and all errors.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "touchstone/query.hpp"

namespace touchstone::verify::data {

/// A query of plain rows.
struct PlainRows {
  Query query;
  std::optional<bool> label;
  std::uint64_t rounded;  ///< coordinates that are no doubles and were rounded to the nearest
  std::size_t bytes;      ///< of the eight rows, line ends included
};

/// Bytes that a text must have after a query's rows, so that they can be read as words.
inline constexpr std::size_t plain_rows_margin = 16;

/// The query whose rows begin the text; nothing if they are not plain, not whole, or end less than
/// plain_rows_margin bytes before the text does.
/// \param columns 3, 4, 6 or 7 (csv_dataset.hpp)
/// \param round Round coordinates that are no doubles; otherwise such rows are not plain.
[[nodiscard]] std::optional<PlainRows> read_plain_rows(std::string_view text, std::size_t columns,
                                                       bool round);

}  // namespace touchstone::verify::data
