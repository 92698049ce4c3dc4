#pragma once

/// \file
/// The sources of the fuzzer's queries. Each generator has one kind of difficulty; it draws
/// the scale, the closeness and all other parameters anew for each query.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {

/// Queries of one kind to mutate: some permanent ones, and the latest ones with new coverage.
class QueryPool {
 public:
  /// Keeps a query permanently.
  void keep(const Query& query) { kept_.push_back(query); }

  /// Keeps a query until many others have been added.
  void add(const Query& query);

  /// A random one of them; with probability 1/2 a permanent one, if there is one. \pre not empty
  [[nodiscard]] const Query& draw(generate::Random& random) const;

  [[nodiscard]] bool empty() const { return kept_.empty() && latest_.empty(); }

 private:
  static constexpr std::size_t most_latest = 1024;

  std::vector<Query> kept_;
  std::vector<Query> latest_;
  std::size_t oldest_ = 0;
};

/// The input of generators.
class GeneratorContext {
 public:
  explicit GeneratorContext(const Separation& separation);

  [[nodiscard]] const Separation& separation() const { return separation_; }
  /// The families that have queries of the kind for the separation.
  [[nodiscard]] const std::vector<generate::Family>& families(Kind kind) const {
    return families_.at(static_cast<std::size_t>(kind));
  }
  [[nodiscard]] const QueryPool& pool(Kind kind) const {
    return pools_.at(static_cast<std::size_t>(kind));
  }
  [[nodiscard]] QueryPool& pool(Kind kind) { return pools_.at(static_cast<std::size_t>(kind)); }

 private:
  Separation separation_;
  std::array<std::vector<generate::Family>, 2> families_;
  std::array<QueryPool, 2> pools_;
};

/// A named generator of queries.
struct Generator {
  /// Unique, snake_case.
  std::string_view name;
  /// A description of its queries.
  std::string_view about;
  /// The work of a query: about the microseconds to generate and judge it.
  double work;
  /// Generates a query of finite coordinates: a function of the arguments alone.
  Query (*make)(Kind kind, const GeneratorContext& context, generate::Random& random);
  /// True if it needs a positive separation.
  bool needs_distance = false;
  /// Its share of the exploration (scheduler.hpp), independent of its results so far.
  double explored = 1.0;
};

/// All generators, always in the same order.
[[nodiscard]] std::span<const Generator> generators();

/// The generators with queries for the separation.
[[nodiscard]] std::vector<Generator> generators(const Separation& separation);

}  // namespace touchstone::verify::fuzz
