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

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

using base::AnyQuery;

/// Queries of one shape to mutate: some permanent ones, and the latest ones with new coverage.
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
  [[nodiscard]] const std::vector<generate::Family>& families(Kind kind) const {
    return families_.at(static_cast<std::size_t>(kind));
  }
  [[nodiscard]] const QueryPool& pool(const QueryShape& shape) const {
    return pools_.at(place_of(shape));
  }
  [[nodiscard]] QueryPool& pool(const QueryShape& shape) { return pools_.at(place_of(shape)); }

 private:
  static std::size_t place_of(const QueryShape& shape) {
    const std::size_t curves = 2 * shape.degree + (shape.is_rational ? 1 : 0);
    return all_kinds.size() * curves + static_cast<std::size_t>(shape.kind);
  }

  Separation separation_;
  std::array<std::vector<generate::Family>, all_kinds.size()> families_;
  std::array<QueryPool, 2 * all_kinds.size() * (greatest_degree + 1)> pools_;
};

/// A named generator of queries.
struct Generator {
  /// Unique, snake_case.
  std::string_view name;
  /// A description of its queries.
  std::string_view about;
  /// The work of a query: about the microseconds to generate and judge it.
  double work;
  /// Generates a query of finite coordinates and positive weights: a function of the arguments
  /// alone. \pre a degree above 0
  AnyQuery (*make)(const QueryShape& shape, const GeneratorContext& context,
                   generate::Random& random);
  /// True if it needs a positive separation.
  bool needs_distance = false;
  /// Its share of the exploration (Scheduler), independent of its results so far.
  double explored = 1.0;
  /// True if its queries are on curves, unless they must be on straight lines.
  bool is_of_curves = false;
};

/// All generators, always in the same order: first those of queries on straight lines.
[[nodiscard]] std::span<const Generator> generators();

/// The generators with queries for the separation; those of curves only if asked for.
[[nodiscard]] std::vector<Generator> generators(const Separation& separation, bool on_curves);

// The scheduler directs the search to generators that bring new results.
//
// Queries are classified by a *coverage key*: the stage at which the judge decided, the time of
// impact, the distance of the answer from it, and so on. A query of a rare class is worth more
// than one of a frequent class. The *scheduler* is a bandit: it draws arms (generators) with a
// probability that grows with their reward per work, with the most weight on recent work. Every
// arm keeps a small share, so that late rewards are found; arms with more important findings keep
// a greater one.

/// The coverage key. That of two queries is the same if these agree: the shape; the stage and
/// verdict of the judge; the verdict of the answer; to a factor of 256 the time of impact, or its
/// distance from 1 if that is less; to a factor of 4 the distance of toi_lower below it, and the
/// tolerance of the answer; whether the contact is on the boundary of (u,v); the number of zero
/// coordinates, in steps of four; and to a factor of 2^256 the greatest coordinate. (Up to hash
/// collisions.)
/// \param query one
[[nodiscard]] std::uint64_t coverage_key(const Queries& query, const fast::CertifiedResult& judged,
                                         const fast::Answer& answer);

/// The number of occurrences of each coverage key.
class CoverageTable {
 public:
  CoverageTable();

  /// Counts a coverage key, and returns the number of earlier occurrences. Two keys may be confused
  /// (there are 2^16 hash slots).
  std::uint32_t add(std::uint64_t coverage_key);

 private:
  std::vector<std::uint32_t> counts_;
};

/// Chooses among arms. The same calls give the same choices everywhere.
class Scheduler {
 public:
  /// An arm for each generator, which has its relative share in the exploration. \pre not empty
  Scheduler(const std::vector<Generator>& generators, std::uint64_t seed);

  /// The arm to play next.
  [[nodiscard]] std::size_t choose();

  /// Records the reward and the work of an arm. \pre reward ≥ 0, work > 0
  void learn(std::size_t arm, double reward, double work);

 private:
  struct Arm {
    double explored = 0.0;  ///< the share of all draws for exploration
    double reward = 0.0;
    double work = 0.0;
  };

  [[nodiscard]] static double rate(const Arm& arm);

  generate::Random random_;
  std::vector<Arm> arms_;
};

// Small perturbations of queries that solvers handled well or just failed.

/// The double at this number of doubles above x (below, if negative), limited to the greatest
/// finite magnitude. \pre x is finite
[[nodiscard]] double stepped(double x, std::int64_t steps);

/// Moves one to three coordinates by some units in the last place: mostly a few, sometimes 2^k. All
/// coordinates stay finite.
void nudge(Query& query, generate::Random& random);

/// Moves the points at one end by up to 2^-20 of their way, forwards or backwards: an event at that
/// end then happens slightly earlier or not at all. All points, or the first primitive's. All
/// coordinates stay finite.
void overshoot(Kind kind, Query& query, generate::Random& random);

/// One to three changes: a bit flipped, coordinates or points copied or exchanged, a sign changed,
/// a coordinate set to 0, rounded to few bits or multiplied by a power of two, units in the last
/// place, a point at rest. Weights are changed as coordinates are, if they may be. All coordinates
/// stay finite, all weights between 2^-40 and 2^40.
[[nodiscard]] base::AnyQuery mutated(const base::AnyQuery& query, bool changes_weights,
                                     generate::Random& random);

}  // namespace touchstone::verify::fuzz
