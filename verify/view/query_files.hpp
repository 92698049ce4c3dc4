#pragma once

/// \file
/// Queries for a view, from files: rows of datasets, findings of the fuzzer, certificates,
/// and the points of one query.
///
///   - .csv, .npy: a dataset (verify/data/dataset.hpp);
///   - .json: the report of `fuzz --json`, whose findings are read, or one of them, or the JSON
///     that a view copies: an object of `coordinates`, 24 numbers or texts of numbers, `kind`, and
///     optionally `separation`, `label` and `note`; on curves, `control` and `weights` in place of
///     the coordinates (verify/view/query_facts.hpp); or a list of such objects;
///   - .cert, .cert.zst: a stream of certificates of queries (exact/CERTIFICATES.md).

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/view/viewed_query.hpp"

namespace touchstone::verify::view {

/// The queries of a file to read.
struct QueryFileOptions {
  /// Positions in the file, counted from 0, each read once, in the order of the file; empty: from
  /// the first on.
  std::vector<std::uint64_t> indices = {};
  /// The maximum number of queries.
  std::size_t most = 100;
  /// The kind of queries whose file does not specify it.
  std::optional<AnyKind> kind = std::nullopt;
  /// Round coordinates of datasets that are not doubles to the nearest double.
  bool round = false;
};

/// Reads the queries.
/// \throws DatasetError if the file's format is unknown, it cannot be read or is in error, it has
/// none of the requested queries or one about a cell, or the kind is unknown.
[[nodiscard]] std::vector<ViewedQuery> read_queries(const std::filesystem::path& path,
                                                    const QueryFileOptions& options);

/// A query, or a finding of the fuzzer, from JSON (above).
/// \param kind of a query that does not specify it
/// \throws std::logic_error or nlohmann::json::exception if it is none.
[[nodiscard]] ViewedQuery query_from_json(const nlohmann::json& json, std::string label,
                                          std::optional<AnyKind> kind = std::nullopt);

/// The double nearest to a number as text: decimal, hexadecimal ("0x1.8p-3"), or a fraction of two
/// decimals.
/// \throws std::invalid_argument if it is none, or not finite.
[[nodiscard]] double parse_number(std::string_view text);

/// 24 numbers in the order of Query, separated by spaces, commas, semicolons, brackets or line
/// ends.
/// \throws std::invalid_argument if they are not 24 numbers.
[[nodiscard]] Query parse_points(std::string_view text);

}  // namespace touchstone::verify::view
