#include "verify/data/query_group.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace touchstone::verify::data {
namespace {

/// Queries between two calls of `progress`.
constexpr std::size_t reading_step = 4096;

}  // namespace

QueryGroup::QueryGroup(std::string name, Kind kind, std::vector<Query> queries)
    : name_(std::move(name)), kind_(kind), queries_(std::move(queries)) {
  runs_.push_back({0, {name_, 0}});
}

std::uint64_t QueryGroup::digest() const {
  std::uint64_t digest = 0xcbf29ce484222325U;
  for (const Query& query : queries_) {
    for (const double coordinate : query.coordinates) {
      auto bytes = std::bit_cast<std::uint64_t>(coordinate);
      for (int i = 0; i < 8; ++i, bytes >>= 8U) {
        digest = (digest ^ (bytes & 0xFFU)) * 0x100000001b3U;
      }
    }
  }
  return digest;
}

void QueryGroup::read(QuerySource& source, const std::function<void(double)>& progress,
                      const std::function<bool()>& stopped) {
  if (source.kind() != kind_) throw std::invalid_argument(source.name() + ": is of another kind");
  std::uint64_t expected = 0;
  bool first = true;
  while (const auto query = source.next()) {
    if (first || query->index != expected) {
      runs_.push_back({queries_.size(), {source.name(), query->index}});
    }
    first = false;
    expected = query->index + 1;
    queries_.push_back(query->query);
    if (queries_.size() % reading_step != 0) continue;
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
