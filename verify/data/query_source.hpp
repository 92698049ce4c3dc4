#pragma once

/// \file
/// Sources of queries: the common interface of datasets and the built-in set.

#include <cstdint>
#include <optional>
#include <string>

#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
#include "verify/base/any_query.hpp"

namespace touchstone::verify::data {

/// A query with the truth that its source records.
struct RecordedQuery {
  base::AnyQuery query;
  /// Position in the source, counted from 0; skipped queries keep their number.
  std::uint64_t index;
  /// The label, if the source has one: true for a collision.
  std::optional<bool> collides;
  /// Exact time of impact, or a decimal approximation of it, if the source has one.
  std::optional<exact::Rational> toi;
};

/// A stream of queries of one shape.
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
  [[nodiscard]] virtual AnyShape shape() const = 0;
  [[nodiscard]] AnyKind kind() const { return shape().kind; }

  /// The separation of the recorded labels and times of impact.
  [[nodiscard]] virtual Separation recorded_separation() const { return {}; }

  /// The next query; empty at the end.
  /// \throws DatasetError on bad input, unless the source was opened to keep going.
  [[nodiscard]] virtual std::optional<RecordedQuery> next() = 0;

  /// Fraction read so far, 0 to 1, for a progress bar.
  [[nodiscard]] virtual double progress() const = 0;

  /// Number of skipped invalid queries (only if the source keeps going).
  [[nodiscard]] virtual std::uint64_t skipped() const { return 0; }

  /// Number of coordinates that were rounded to the nearest double (only if requested).
  [[nodiscard]] virtual std::uint64_t rounded() const { return 0; }
};

}  // namespace touchstone::verify::data
