#pragma once

/// \file
/// A judgement for people (a table), for machines (JSON), and as a dataset of its own (the truth).

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "verify/certify.hpp"

namespace touchstone::verify {

/// A line for each source and one for the total, then each mismatch with source, index and both
/// answers.
[[nodiscard]] std::string to_text(const std::vector<CertifyResult>& results);

/// The total's fields `queries`, `collisions`, `labels`, `label_mismatches`, `tois`,
/// `toi_mismatches`, `us_per_query`, `skipped`, `rounded`, `interrupted`; `mismatches`, a list of
/// objects with `file`, `index`, `kind`, `of` ("label" or "toi"), `recorded` and `truth`; `files`,
/// a list with the total's fields a source, its name as `file`, its `kind`, and `error` if one
/// ended the reading.
[[nodiscard]] nlohmann::json to_json(const std::vector<CertifyResult>& results);

/// Writes the truth as CSV, `file,index,kind,collides,toi_lower,toi_upper`: collides as 0 or 1, the
/// ends of the enclosure (neighbouring doubles or equal) with as many digits as give the same
/// double again, empty without collision. File names are quoted where CSV demands it.
class TruthWriter {
 public:
  /// Writes the header.
  explicit TruthWriter(std::ostream& out);

  void write(const std::string& file, Kind kind, const Truth& truth);

 private:
  std::ostream& out_;
};

}  // namespace touchstone::verify
