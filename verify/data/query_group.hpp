#pragma once

/// \file
/// Queries of one shape in memory, from one or several sources, that are measured together.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/data/query_source.hpp"

namespace touchstone::verify::data {

/// Queries of one shape.
class QueryGroup {
 public:
  QueryGroup(std::string name, const AnyShape& shape) : name_(std::move(name)), shape_(shape) {}
  /// A group on straight lines.
  QueryGroup(std::string name, AnyKind kind)
      : QueryGroup(std::move(name), AnyShape{.kind = kind}) {}

  /// Generated queries.
  QueryGroup(std::string name, AnyKind kind, const std::vector<Query>& queries);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const AnyShape& shape() const { return shape_; }
  [[nodiscard]] AnyKind kind() const { return shape_.kind; }
  /// By reference to the group, until it reads more.
  [[nodiscard]] AnyQueries queries() const { return {shape_, numbers_}; }

  /// Appends the queries of a source, up to its end or until `stopped`.
  /// \param progress called occasionally with the fraction of the source that is read.
  /// \throws DatasetError as the source does, std::invalid_argument if it is of another shape.
  void read(QuerySource& source, const std::function<void(double)>& progress,
            const std::function<bool()>& stopped);

 private:
  std::string name_;
  AnyShape shape_;
  std::vector<double> numbers_;
};

}  // namespace touchstone::verify::data
