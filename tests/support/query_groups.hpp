#pragma once

/// \file
/// Groups of queries on lines and on curves, for what measures groups.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "touchstone/query.hpp"
#include "verify/data/query_group.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::tests {

/// Vertices over a triangle, the first of every so many of which falls through it, and the others
/// to 1/2. They start at 1, or each higher by this than the one before, up to the 97th.
[[nodiscard]] inline verify::data::QueryGroup falling_group(std::size_t count,
                                                            std::size_t every = 10,
                                                            double higher = 0.0) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) {
    const double start = 1.0 + higher * static_cast<double>(i % 97);
    queries.push_back(over_triangle(1, 1, start, i % every == 0 ? -1.0 : 0.5).query);
  }
  return {"falling", ContactKind::vertex_face, std::move(queries)};
}

/// The first queries of the first family on curves, which is of degree 2.
[[nodiscard]] inline verify::data::QueryGroup curved_group(ContactKind kind, std::uint64_t count) {
  const auto source =
      verify::generate::open_family(verify::generate::curved_families().front(), kind, 7, count);
  verify::data::QueryGroup group("curves", source->shape());
  group.read(
      *source, [](double) {}, [] { return false; });
  return group;
}

}  // namespace touchstone::tests
