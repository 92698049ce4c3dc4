#pragma once

/// \file
/// A group of queries on curves, for what measures groups.

#include <cstdint>

#include "touchstone/query.hpp"
#include "verify/data/query_group.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::tests {

/// The first queries of the first family on curves, which is of degree 2.
[[nodiscard]] inline verify::data::QueryGroup curved_group(Kind kind, std::uint64_t count) {
  const auto source =
      verify::generate::open_family(verify::generate::curved_families().front(), kind, 7, count);
  verify::data::QueryGroup group("curves", source->shape());
  group.read(
      *source, [](double) {}, [] { return false; });
  return group;
}

}  // namespace touchstone::tests
