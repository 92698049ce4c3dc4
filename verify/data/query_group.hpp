#pragma once

/// \file
/// Queries of one shape in memory, from one or several sources, that are measured together.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/data/query_source.hpp"

namespace touchstone::verify::data {

/// The origin of a query.
struct QueryPlace {
  std::string source;       ///< QuerySource::name
  std::uint64_t index = 0;  ///< RecordedQuery::index
};

/// Queries of one shape with their origins.
class QueryGroup {
 public:
  QueryGroup(std::string name, const QueryShape& shape) : name_(std::move(name)), shape_(shape) {}
  /// A group on straight lines.
  QueryGroup(std::string name, Kind kind) : QueryGroup(std::move(name), QueryShape{.kind = kind}) {}

  /// Generated queries: their source is the group, their index their position.
  QueryGroup(std::string name, Kind kind, const std::vector<Query>& queries);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const QueryShape& shape() const { return shape_; }
  [[nodiscard]] Kind kind() const { return shape_.kind; }
  /// By reference to the group, until it reads more.
  [[nodiscard]] Queries queries() const { return {shape_, numbers_}; }

  /// A digest that distinguishes groups of different queries: FNV-1a, 64 bits, of the bytes of all
  /// numbers in their order.
  [[nodiscard]] std::uint64_t digest() const;

  /// Appends the queries of a source, up to its end or until `stopped`.
  /// \param progress called occasionally with the fraction of the source that is read.
  /// \throws DatasetError as the source does, std::invalid_argument if it is of another shape.
  void read(QuerySource& source, const std::function<void(double)>& progress,
            const std::function<bool()>& stopped);

  /// The origin of the query at a position of queries(). \pre the position is in range.
  [[nodiscard]] QueryPlace place_of(std::size_t position) const;

 private:
  /// A run of queries with consecutive indices, up to where the next one begins.
  struct Run {
    std::size_t position;
    QueryPlace place;
  };

  std::string name_;
  QueryShape shape_;
  std::vector<double> numbers_;
  std::vector<Run> runs_;
};

}  // namespace touchstone::verify::data
