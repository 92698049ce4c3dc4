#pragma once

/// \file
/// The sources of the fuzzer's queries. Each generator has one kind of difficulty; it draws
/// the scale, the closeness and all other parameters anew for each query. Those of queries on
/// straight lines also make them queries on curves (curved_generators.hpp).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/base/any_query.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

using base::AnyQuery;

/// Queries of one shape to mutate: some permanent ones, and some of the latest.
class QueryPool {
 public:
  /// Keeps a query permanently.
  void keep(AnyQuery query) { kept_.push_back(std::move(query)); }

  /// Keeps a query until many others have been added.
  void add(AnyQuery query);

  /// A random one of them; with probability 1/2 a permanent one, if there is one. \pre not empty
  [[nodiscard]] const AnyQuery& draw(generate::Random& random) const;

  [[nodiscard]] bool empty() const { return kept_.empty() && latest_.empty(); }

 private:
  static constexpr std::size_t most_latest = 1024;

  std::vector<AnyQuery> kept_;
  std::vector<AnyQuery> latest_;
  std::size_t oldest_ = 0;
};

/// The input of generators.
class GeneratorContext {
 public:
  explicit GeneratorContext(const Separation& separation);

  [[nodiscard]] const Separation& separation() const { return separation_; }
  /// The families that have queries of the kind for the separation.
  [[nodiscard]] const std::vector<generate::Family>& families(AnyKind kind) const {
    return families_.at(kind.index());
  }
  [[nodiscard]] const QueryPool& pool(const AnyShape& shape) const {
    return pools_.at(place_of(shape));
  }
  [[nodiscard]] QueryPool& pool(const AnyShape& shape) { return pools_.at(place_of(shape)); }

 private:
  static std::size_t place_of(const AnyShape& shape) {
    const std::size_t curves = 2 * shape.degree + (shape.is_rational ? 1 : 0);
    return all_kinds.size() * curves + shape.kind.index();
  }

  Separation separation_;
  std::array<std::vector<generate::Family>, all_kinds.size()> families_;
  std::array<QueryPool, 2 * all_kinds.size() * (greatest_degree + 1)> pools_;
};

/// A named generator of queries.
struct Generator {
  /// Unique, snake_case.
  std::string_view name;
  /// Generates a query of finite coordinates and positive weights: a function of the arguments
  /// alone. \pre a degree above 0
  AnyQuery (*make)(const AnyShape& shape, const GeneratorContext& context,
                   generate::Random& random);
  /// True if it needs a positive separation.
  bool needs_distance = false;
  /// True if its queries are on curves, unless they must be on straight lines.
  bool is_of_curves = false;
};

/// All generators, always in the same order: first those of queries on straight lines.
[[nodiscard]] std::span<const Generator> generators();

/// The generators with queries for the separation; those of curves only if asked for.
[[nodiscard]] std::vector<Generator> generators(const Separation& separation, bool on_curves);

/// One to three changes: a bit flipped, coordinates or points copied or exchanged, a sign changed,
/// a coordinate set to 0, rounded to few bits or multiplied by a power of two, units in the last
/// place, a point at rest. Weights are changed as coordinates are, if they may be. All coordinates
/// stay finite, all weights between 2^-40 and 2^40.
[[nodiscard]] base::AnyQuery mutated(const base::AnyQuery& query, bool changes_weights,
                                     generate::Random& random);

}  // namespace touchstone::verify::fuzz
