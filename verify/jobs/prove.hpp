#pragma once

/// \file
/// Certificates of a source's queries, in the order of the queries, computed on all cores.

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/certificate.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/data/query_source.hpp"

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

  ProofCounts& operator+=(const ProofCounts& other);
};

/// "path/to/file.csv:17", query number 17 counted from 0: the label of a query's certificate.
[[nodiscard]] std::string certificate_label(std::string_view source, std::uint64_t index);

/// Appends the certificate of query i to the text, and counts it, without its time.
void append_certificate(const Queries& queries, std::size_t i, const exact::Decision& verdict,
                        std::string_view label, const exact::ProveOptions& options,
                        std::string& text, ProofCounts& counts);

/// The counts as text.
[[nodiscard]] std::string to_text(const ProofCounts& counts);

/// The counts as members of an object.
[[nodiscard]] nlohmann::json to_json(const ProofCounts& counts);

}  // namespace touchstone::verify::jobs
