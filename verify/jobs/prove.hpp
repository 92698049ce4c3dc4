#pragma once

/// \file
/// Certificates of a source's queries, in the order of the queries, computed on all cores.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
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

/// Appends the certificate of a query to the text, and counts it, without its time.
void append_certificate(Kind kind, const Query& query, const exact::Decision& verdict,
                        std::string_view label, const exact::ProveOptions& options,
                        std::string& text, ProofCounts& counts);

/// The counts as text.
[[nodiscard]] std::string to_text(const ProofCounts& counts);

/// The counts as members of an object.
[[nodiscard]] nlohmann::json to_json(const ProofCounts& counts);

struct SourceProofOptions {
  /// Minimum separation.
  Separation separation = {};
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  exact::ProveOptions proof = {};
  /// Called with whole certificates, in the order of the queries, never from two threads at once.
  std::function<void(std::string_view)> on_certificates = nullptr;
  /// Called occasionally with the completed fraction of the source; never from two threads at once.
  std::function<void(double)> on_progress = nullptr;
  /// When it becomes true, no further queries are read, and the result is that of the queries
  /// proved so far.
  const std::atomic<bool>* stop = nullptr;
};

/// Results for one source, or for several.
struct SourceProof {
  ProofCounts counts = {};
  double oracle_nanoseconds = 0.0;  ///< processor time of the oracle, summed over the queries
  std::uint64_t skipped = 0;        ///< invalid queries, skipped
  std::uint64_t rounded = 0;        ///< coordinates rounded to double
  /// The error that ended the reading before the source's end; the other fields are for the queries
  /// before it.
  std::optional<std::string> reading_error = std::nullopt;
  bool interrupted = false;

  /// Adds the results of another source, except its error.
  SourceProof& operator+=(const SourceProof& other);
};

/// Decides and proves every query of the source. Errors of the source end up in the result.
[[nodiscard]] SourceProof prove(data::QuerySource& source, const SourceProofOptions& options = {});

}  // namespace touchstone::verify::jobs
