#pragma once

/// \file
/// Where the fuzzer's queries come from. Each generator has its own way to be hard; the scale, the
/// closeness and the rest of what makes it hard it draws anew for each query.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "exact/query.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {

/// Queries of one kind to mutate: some that stay, and the latest of those that were found worth it.
class QueryPool {
 public:
  /// Keeps a query for good.
  void keep(const Query& query) { kept_.push_back(query); }

  /// Keeps a query until many others have been added.
  void add(const Query& query);

  /// Any of them; half of the time one that stays, if there is one. \pre not empty
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

/// A named way to make queries.
struct Generator {
  /// Unique, snake_case.
  std::string_view name;
  /// A description of its queries.
  std::string_view about;
  /// The work of a query: about the microseconds that making and judging it takes.
  double work;
  /// Makes a query of finite coordinates: a function of the arguments and nothing else.
  Query (*make)(Kind kind, const GeneratorContext& context, generate::Random& random);
  /// Does it need a separation that is more than contact?
  bool needs_distance = false;
  /// Its part of what is explored (scheduler.hpp), whatever it has brought so far.
  double explored = 1.0;
};

/// All generators, always in the same order.
[[nodiscard]] std::span<const Generator> generators();

/// Those that have queries for the separation.
[[nodiscard]] std::vector<Generator> generators(const Separation& separation);

}  // namespace touchstone::verify::fuzz
