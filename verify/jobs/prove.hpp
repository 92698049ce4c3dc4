#pragma once

/// \file
/// The certificates of a source's queries: their labels, and what they are in numbers.

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/certificate.hpp"

namespace touchstone::verify::jobs {

/// The proofs, and their cost.
struct ProofCounts {
  std::uint64_t no_collision = 0;
  std::uint64_t collision = 0;
  std::uint64_t time_of_impact = 0;
  /// Certificates by the number of their subintervals.
  std::map<std::size_t, std::uint64_t> subintervals = {};
  std::uint64_t bytes = 0;   ///< of the certificates' text
  double nanoseconds = 0.0;  ///< processor time of proving and writing, the oracle's not included
  /// The reasons for queries without certificate: it would exceed the format's limits.
  std::vector<std::string> beyond_limits = {};

  [[nodiscard]] std::uint64_t certificates() const;

  /// Counts a certificate, without its bytes and its time.
  void add(const exact::Certificate& certificate);

  ProofCounts& operator+=(const ProofCounts& other);
};

/// "path/to/file.csv:17", query number 17 counted from 0: the label of a query's certificate.
[[nodiscard]] std::string certificate_label(std::string_view source, std::uint64_t index);

/// The counts as text.
[[nodiscard]] std::string to_text(const ProofCounts& counts);

/// The counts as members of an object.
[[nodiscard]] nlohmann::json to_json(const ProofCounts& counts);

}  // namespace touchstone::verify::jobs
