#pragma once

/// \file
/// A judgement for people (a table), for machines (JSON), and as a dataset of its own (the truth).

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "verify/certify.hpp"

namespace touchstone::verify {

/// A line for each source and one for the total, then each mismatch with source, index and both
/// answers.
[[nodiscard]] std::string to_text(const std::vector<CertifyResult>& results);

/// The total's fields `queries`, `collisions`, `labels`, `label_mismatches`, `tois`,
/// `toi_mismatches`, `us_per_query`, `skipped`, `rounded`, `errors` (that ended the reading of a file), `interrupted`; `mismatches`, a list of
/// objects with `file`, `index`, `kind`, `of` ("label" or "toi"), `recorded` and `truth`; `files`,
/// a list with the total's fields a source, its name as `file`, its `kind`, and `error` if one
/// ended the reading.
[[nodiscard]] nlohmann::json to_json(const std::vector<CertifyResult>& results);

/// The header of the truth as CSV: `file,index,kind,collides,toi_lower,toi_upper`.
[[nodiscard]] std::string truth_header();

/// A row of it: collides as 0 or 1, the ends of the enclosure (neighbouring doubles or equal) with as
/// many digits as give the same double again, empty without collision. The file's name is quoted
/// where CSV demands it.
[[nodiscard]] std::string truth_row(const std::string& file, Kind kind, const Truth& truth);

}  // namespace touchstone::verify
