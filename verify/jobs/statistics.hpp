#pragma once

/// \file
/// Statistics, and representative samples.

#include <cstddef>
#include <vector>

namespace touchstone::verify::jobs {

/// The middle value, of an even count the mean of the two in the middle; NaN if there are none.
[[nodiscard]] double median(std::vector<double> values);

/// The least value that at least `fraction` (0 to 1) of all do not exceed; NaN if there are none.
[[nodiscard]] double quantile(std::vector<double> values, double fraction);

/// `count` of the positions 0 … size−1, all if there are no more, ascending and evenly spread.
/// Always the same ones, and those of a smaller count are among them. They are the first multiples,
/// modulo the size, of a stride near the golden section of it: unlike every n-th position they are
/// independent of any order of the queries.
[[nodiscard]] std::vector<std::size_t> spread_sample(std::size_t size, std::size_t count);

}  // namespace touchstone::verify::jobs
