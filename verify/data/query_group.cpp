#include "verify/data/query_group.hpp"

#include <span>
#include <stdexcept>
#include <utility>

namespace touchstone::verify::data {
namespace {

/// Queries between two calls of `progress`.
constexpr std::size_t reading_step = 4096;

}  // namespace

QueryGroup::QueryGroup(std::string name, AnyKind kind, const std::vector<Query>& queries)
    : QueryGroup(std::move(name), kind) {
  const std::span<const double> numbers = AnyQueries(kind, queries).numbers;
  numbers_.assign(numbers.begin(), numbers.end());
}

void QueryGroup::read(QuerySource& source, const std::function<void(double)>& progress,
                      const std::function<bool()>& stopped) {
  if (source.shape() != shape_) {
    throw std::invalid_argument(source.name() + ": is of another kind or on other curves");
  }
  while (const auto query = source.next()) {
    const std::span<const double> numbers = std::as_const(query->query).numbers();
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    if (queries().size() % reading_step != 0) continue;
    progress(source.progress());
    if (stopped()) return;
  }
  progress(1.0);
}

}  // namespace touchstone::verify::data
