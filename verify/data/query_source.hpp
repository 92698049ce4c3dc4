#pragma once

/// \file
/// Where queries come from: the one interface between datasets, the built-in families and the
/// judge.

#include <cstdint>
#include <optional>
#include <string>

#include "exact/algebra/number.hpp"
#include "exact/query.hpp"

namespace touchstone::verify::data {

/// A query with what its source claims to be true of it.
struct RecordedQuery {
  Query query;
  /// Position in the source, counted from 0; skipped queries keep their number.
  std::uint64_t index;
  /// Do they collide, where the source says so.
  std::optional<bool> collides;
  /// Exact time of impact, or a decimal approximation of it, where the source has one.
  std::optional<exact::Rational> toi;
};

/// A stream of queries of one kind.
class QuerySource {
 public:
  QuerySource() = default;
  QuerySource(const QuerySource&) = delete;
  QuerySource& operator=(const QuerySource&) = delete;
  QuerySource(QuerySource&&) = delete;
  QuerySource& operator=(QuerySource&&) = delete;
  virtual ~QuerySource() = default;

  /// The file's path, or the family's name.
  [[nodiscard]] virtual const std::string& name() const = 0;
  [[nodiscard]] virtual Kind kind() const = 0;

  /// The separation that recorded labels and times of impact are about.
  [[nodiscard]] virtual Separation recorded_separation() const { return {}; }

  /// The next query, or nothing at the end.
  /// \throws DatasetError on bad input, unless the source was opened to keep going.
  [[nodiscard]] virtual std::optional<RecordedQuery> next() = 0;

  /// Fraction read so far, 0 to 1: what a progress bar shows.
  [[nodiscard]] virtual double progress() const = 0;

  /// Queries left out because they could not be read (only where the source keeps going).
  [[nodiscard]] virtual std::uint64_t skipped() const { return 0; }

  /// Coordinates that were no doubles and were rounded to the nearest one (only where asked for).
  [[nodiscard]] virtual std::uint64_t rounded() const { return 0; }
};

}  // namespace touchstone::verify::data
