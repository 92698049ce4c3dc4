#include "verify/data/query_group.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <span>
#include <stdexcept>
#include <utility>

namespace touchstone::verify::data {
namespace {

/// Queries between two calls of `progress`.
constexpr std::size_t reading_step = 4096;

}  // namespace

QueryGroup::QueryGroup(std::string name, Kind kind, const std::vector<Query>& queries)
    : QueryGroup(std::move(name), kind) {
  const std::span<const double> numbers = Queries(kind, queries).numbers;
  numbers_.assign(numbers.begin(), numbers.end());
  runs_.push_back({0, {name_, 0}});
}

std::uint64_t QueryGroup::digest() const {
  std::uint64_t digest = 0xcbf29ce484222325U;
  for (const double number : numbers_) {
    auto bytes = std::bit_cast<std::uint64_t>(number);
    for (int i = 0; i < 8; ++i, bytes >>= 8U) {
      digest = (digest ^ (bytes & 0xFFU)) * 0x100000001b3U;
    }
  }
  return digest;
}

void QueryGroup::read(QuerySource& source, const std::function<void(double)>& progress,
                      const std::function<bool()>& stopped) {
  if (source.shape() != shape_) {
    throw std::invalid_argument(source.name() + ": is of another kind or on other curves");
  }
  std::uint64_t expected = 0;
  bool first = true;
  while (const auto query = source.next()) {
    if (first || query->index != expected) {
      runs_.push_back({queries().size(), {source.name(), query->index}});
    }
    first = false;
    expected = query->index + 1;
    const std::span<const double> numbers = std::as_const(query->query).numbers();
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    if (queries().size() % reading_step != 0) continue;
    progress(source.progress());
    if (stopped()) return;
  }
  progress(1.0);
}

QueryPlace QueryGroup::place_of(std::size_t position) const {
  const auto next = std::ranges::upper_bound(runs_, position, {}, &Run::position);
  const Run& run = *std::prev(next);
  return {run.place.source, run.place.index + (position - run.position)};
}

}  // namespace touchstone::verify::data
