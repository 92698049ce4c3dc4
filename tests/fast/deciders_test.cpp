/// \file
/// The deciders of the certified solver against the oracle: each decider on each family of queries,
/// at contact and at separations of all magnitudes in both norms, for all tolerances and times.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "fast/certified/block.hpp"
#include "fast/certified/exact/contact_decision.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/contact_function.hpp"
#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/mesh.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::fast::deciders_test {
namespace {

using exact::Rational;
using tests::PosedQuery;
using tests::Random;

constexpr double tiniest = std::numeric_limits<double>::denorm_min();

// ---- Deciders -----------------------------------------------------------------------------------

struct Decider {
  std::string_view name;
  void (*solve)(ContactKind, std::span<const Query>, std::span<CertifiedResult>,
                const CertifiedOptions&);
  bool knows_the_place;   ///< F is 0 at its (u,v), up to rounding
  std::size_t share = 1;  ///< it decides one in so many queries at a separation

  [[nodiscard]] CertifiedResult operator()(const PosedQuery& posed,
                                           const CertifiedOptions& options) const {
    CertifiedResult result;
    solve(posed.kind, std::span(&posed.query, 1), std::span(&result, 1), options);
    return result;
  }
};

void solve_exactly(ContactKind kind, std::span<const Query> queries,
                   std::span<CertifiedResult> results, const CertifiedOptions& options) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    results[i] = decided_exactly(kind, queries[i], options);
  }
}

void solve_certified(ContactKind kind, std::span<const Query> queries,
                     std::span<CertifiedResult> results, const CertifiedOptions& options) {
  solve({kind, queries}, results, options);
}

void solve_points(ContactKind kind, std::span<const Query> queries,
                  std::span<CertifiedResult> results, const CertifiedOptions& options) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto p = [&](std::size_t end, std::size_t k) { return point_of(queries[i], end, k); };
    const auto solve = kind == ContactKind::vertex_face ? &solve_vertex_face : &solve_edge_edge;
    results[i] =
        solve(p(0, 0), p(0, 1), p(0, 2), p(0, 3), p(1, 0), p(1, 1), p(1, 2), p(1, 3), options);
  }
}

/// The greatest power of two that leaves differences of the coordinates below 2^62.
double greatest_scale(const Query& query) {
  double size = 1.0;
  for (const double x : query.coordinates) size = std::max(size, std::abs(x));
  return std::ldexp(1.0, 60 - std::ilogb(size));
}

/// r, p and q of a query with integer coordinates, times a power of two.
template <class Number>
exact_stage::Motion<Number> integer_motion(const PosedQuery& posed, double scale = 1.0) {
  exact_stage::Motion<Number> motion{posed.kind, {}, {}, {}, {}};
  const auto line = [&](std::size_t a, std::size_t b, std::size_t k) {
    const auto at = [&](std::size_t end) {
      const double difference = posed.query.at(end, a, k) - posed.query.at(end, b, k);
      return Number(static_cast<std::int64_t>(difference * scale));
    };
    return exact_stage::Form<Number, 1>{at(0), at(1)};
  };
  const bool face = posed.kind == ContactKind::vertex_face;
  for (std::size_t k = 0; k < 3; ++k) {
    motion.r[k] = face ? line(0, 1, k) : line(0, 2, k);
    motion.p[k] = face ? line(2, 1, k) : line(0, 1, k);
    motion.q[k] = face ? line(3, 1, k) : line(3, 2, k);
  }
  return motion;
}

/// A part of the exact stage, where it decides, if coordinates are integers up to 2^52: the case of
/// a fixed size, with coordinates that just fit, or the general one, which other queries come to if
/// they are large.
template <class Number>
void solve_in(ContactKind kind, std::span<const Query> queries, std::span<CertifiedResult> results,
              const CertifiedOptions& options) {
  const auto latest = std::bit_cast<std::uint64_t>(options.t_max);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const PosedQuery posed{kind, queries[i]};
    const bool is_small = std::ranges::all_of(queries[i].coordinates, [](double x) {
      return std::abs(x) <= 0x1p52 && std::trunc(x) == x;
    });
    results[i] = decided_exactly(kind, queries[i], options);
    if (!is_small || !is_zero(options.separation)) continue;
    if constexpr (std::is_same_v<Number, exact_stage::BigInteger>) {
      results[i] = result_of(exact_stage::first_impact(integer_motion<Number>(posed), latest));
    } else {
      const auto motion = integer_motion<Number>(posed, greatest_scale(queries[i]));
      const auto answer = exact_stage::fixed_size_first_impact(motion, latest, 1);
      if (answer.decided) results[i] = result_of(answer.impact);
    }
    results[i].u = results[i].v = 0.0;  // the whole moves the place into the domain
  }
}

/// Lines as curves, of degree 2 where the control point in the middle is a double, else of degree 1
/// with equal weights. (With a tolerance of 1 the enclosure of a time that is 0 may end later.)
void solve_curves(ContactKind kind, std::span<const Query> queries,
                  std::span<CertifiedResult> results, const CertifiedOptions& options) {
  CertifiedOptions of_curves = options;
  of_curves.toi_tolerance = std::min(options.toi_tolerance, 0.5);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::span<const double> all(queries[i].coordinates), start = all.first(12),
                                                               end = all.last(12);
    std::vector<double> middle;
    bool is_exact = true;
    for (std::size_t k = 0; k < start.size(); ++k) {
      middle.push_back(start[k] / 2 + end[k] / 2);
      is_exact = is_exact && Rational(middle[k]) * 2 == Rational(start[k]) + Rational(end[k]);
    }
    std::vector<double> numbers;
    if (is_exact) {
      for (const std::span<const double> part : {start, std::span<const double>(middle), end}) {
        numbers.insert(numbers.end(), part.begin(), part.end());
      }
    } else {
      for (std::size_t k = 0; k < all.size(); ++k) {
        numbers.push_back(all[k]);
        if (k % 3 == 2) numbers.push_back(1.0);
      }
    }
    solve(Queries({kind, is_exact ? 2U : 1U, !is_exact}, numbers), results.subspan(i, 1),
          of_curves);
  }
}

constexpr std::array<Decider, 7> deciders{
    {{"certified", &solve_certified, true},
     {"exact stage", &solve_exactly, true},
     {"general exact stage", &solve_in<exact_stage::BigInteger>, false},
     {"exact stage in one limb", &solve_in<exact_stage::FixedInteger<1>>, false},
     {"exact stage in two limbs", &solve_in<exact_stage::FixedInteger<2>>, false},
     {"points", &solve_points, false},
     {"curves", &solve_curves, false, 12}}};

// ---- Families of queries ------------------------------------------------------------------------

struct QueryFamily {
  std::string name;
  std::size_t count;  ///< for each kind; public data: all, or 0 if missing
  std::function<Query(Random&, ContactKind, std::size_t)> draw;

  friend std::ostream& operator<<(std::ostream& out, const QueryFamily& one) {
    return out << one.name;
  }
};

Query scaled(Query query, int exponent) {
  for (double& x : query.coordinates) x = std::ldexp(x, exponent);
  return query;
}

/// A query near the border of contact, with the coordinates that `is_chosen(axis, point)` far out
/// of scale.
template <class IsChosen>
Query out_of_scale(Random& random, ContactKind kind, const IsChosen& is_chosen) {
  Query query = tests::near_contact_query(random, kind);
  const int exponent = random.between(-900, 900);
  for (std::size_t k = 0; k < query.coordinates.size(); ++k) {
    if (is_chosen(k % 3, k / 3 % 4)) {
      query.coordinates.at(k) = std::ldexp(query.coordinates.at(k), exponent);
    }
  }
  return query;
}

Query of_all_magnitudes(Random& random, ContactKind kind, std::size_t i) {
  constexpr std::array exponents{-1080, -1074, -1030, -500, -340, -120, -60,
                                 60,    99,    120,   340,  1000, 1018};
  return scaled(
      i % 2 == 0 ? tests::near_contact_query(random, kind) : tests::integer_query(random, 2),
      exponents.at(i / 2 % exponents.size()));
}

Query of_mixed_values(Random& random) {
  constexpr std::array<double, 6> values{0.0, 1.0, tiniest, 1e308, -1e308, 0x1p-600};
  for (;;) {
    Query query{};
    for (double& x : query.coordinates) {
      x = random.coin() ? random.between(-1, 1) : values.at(random.bits() % values.size());
    }
    tests::degenerate(random, query);
    if (is_finite(query)) return query;
  }
}

Query perturbed(Random& random) {
  Query query = tests::integer_query(random, 2);
  for (double& x : query.coordinates) {
    if (random.between(0, 3) == 0) x = std::nextafter(x, random.coin() ? 4.0 : -4.0);
  }
  return query;
}

/// Small primitives far away: differences cancel, and round.
Query far_from_the_origin(Random& random, ContactKind kind) {
  Query query = tests::near_contact_query(random, kind);
  const double offset = std::ldexp(random.uniform(1.0, 2.0), random.between(0, 52));
  for (double& x : query.coordinates) x += offset;
  return query;
}

/// A query of each of the families of verify/generate in turn.
Query built_in(ContactKind kind, std::size_t i) {
  const auto families = verify::generate::families();
  std::size_t number = i % families.size();
  while (!verify::generate::supports(families[number], kind))
    number = (number + 1) % families.size();
  return verify::generate::make_query(families[number], kind, 4, i / families.size()).query;
}

const std::vector<Query>& public_queries(ContactKind kind) {
  static const auto of_kinds = [] {
    std::map<ContactKind, std::vector<Query>> queries;
    tests::for_each_public_query([&](const auto& /*file*/, std::uint64_t /*index*/, ContactKind one,
                                     const Query& query) { queries[one].push_back(query); });
    return queries;
  }();
  return of_kinds.at(kind);
}

std::vector<QueryFamily> query_families() {
  const auto of = [](tests::Family family) {
    return [family](Random& random, ContactKind kind, std::size_t) {
      return tests::random_query(random, kind, family).query;
    };
  };
  return {
      {"tiny_integers", 4000, of(tests::Family::tiny_integers)},
      {"small_integers", 6000, of(tests::Family::small_integers)},
      {"integers", 600,
       [](Random& r, ContactKind, std::size_t) { return tests::integer_query(r, 4); }},
      {"perturbed_integers", 1000,
       [](Random& r, ContactKind, std::size_t) { return perturbed(r); }},
      {"full_significands", 1500, of(tests::Family::full_significands)},
      {"near_contact", 1500, of(tests::Family::near_contact)},
      {"all_magnitudes", 1300, of_all_magnitudes},
      {"one_axis_out_of_scale", 100,
       [](Random& r, ContactKind kind, std::size_t i) {
         return out_of_scale(r, kind, [i](std::size_t axis, std::size_t) { return axis == i % 3; });
       }},
      {"one_point_out_of_scale", 100,
       [](Random& r, ContactKind kind, std::size_t i) {
         return out_of_scale(r, kind, [i](std::size_t, std::size_t k) { return k == i % 4; });
       }},
      {"finite_doubles", 50,
       [](Random& r, ContactKind, std::size_t) {
         Query query{};
         for (double& x : query.coordinates) x = r.finite_double();
         return query;
       }},
      {"mixed_values", 200, [](Random& r, ContactKind, std::size_t) { return of_mixed_values(r); }},
      {"subnormals", 500,
       [](Random& r, ContactKind, std::size_t) {
         return scaled(tests::integer_query(r, 3), -1074);
       }},
      {"far_from_the_origin", 400,
       [](Random& r, ContactKind kind, std::size_t) { return far_from_the_origin(r, kind); }},
      {"built_in", 100 * verify::generate::families().size(),
       [](Random&, ContactKind kind, std::size_t i) { return built_in(kind, i); }},
      {"public_data", tests::public_datasets().size(),
       [](Random&, ContactKind kind, std::size_t i) { return public_queries(kind).at(i); }}};
}

// ---- Queries by hand ----------------------------------------------------------------------------

/// A query at a separation that is reached exactly, or missed by a bit.
struct ByHand {
  PosedQuery posed;
  Separation separation = {};
};

/// Primitives over each other, at height z0 and then z1.
PosedQuery over(ContactKind kind, double z0, double z1) {
  return kind == ContactKind::vertex_face ? tests::over_triangle(1, 1, z0, z1)
                                          : tests::over_edge(1, 1, z0, z1);
}

/// Primitives of a size beside each other, nearest at corners with the difference (3,4,z), z from
/// −8 to 8.
PosedQuery beside(ContactKind kind, double size) {
  const auto at = [&](double z) {
    return kind == ContactKind::vertex_face
               ? tests::FourPoints{-3, -4, z, 0, 0, 0, size, 0, 0, 0, size, 0}
               : tests::FourPoints{0, 0, 0, size, 0, 0, -3, 4, z, -3, 4 + size, z};
  };
  return {kind, tests::moving(at(-8), at(8))};
}

std::vector<ByHand> queries_by_hand(ContactKind kind) {
  constexpr double largest = std::numeric_limits<double>::max();
  const auto below = [](double x) { return std::nextafter(x, 0.0); };
  std::vector<ByHand> all;
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    // (Between heights 2 and −2 the least distance is reached shortly before 1/2.)
    for (const auto& [z0, z1, distance] :
         std::initializer_list<std::array<double, 3>>{{3, -1, 1},
                                                      {1, 3, 1},
                                                      {0.5, 3, 1},
                                                      {3, 1, 1},
                                                      {3, 1, below(1)},
                                                      {1, 3, below(1)},
                                                      {1, 0x1p-60, largest},
                                                      {1, tiniest, tiniest},
                                                      {1, 2 * tiniest, tiniest},
                                                      {largest, tiniest, tiniest},
                                                      {2, -2, tiniest}}) {
      all.push_back({over(kind, z0, z1), {distance, norm}});
    }
    // From 1 + k 2^-52 to 1 at about k 2^-1052, a subnormal time.
    for (const int k : {1, 3, 1000}) {
      all.push_back({over(kind, 1.0 + k * 0x1p-52, -0x1p1000), {1.0, norm}});
    }
  }
  for (const double size : {0.0, 4.0}) {
    for (const Separation& separation :
         {Separation{5.0, Norm::l2}, Separation{below(5.0), Norm::l2}, Separation{13.0, Norm::l2},
          Separation{4.0, Norm::linf}, Separation{below(4.0), Norm::linf},
          Separation{5.0, Norm::linf}}) {
      all.push_back({beside(kind, size), separation});
    }
  }
  // A time far below the least double, and one of 2^-1000 + 2^-1040.
  all.push_back({over(kind, tiniest, -1e308)});
  all.push_back({over(kind, 0x1p-500, 0x1p-500 - 0x1p500)});
  // Whole numbers: tiny times, of which one is no small fraction.
  for (const double end : {-0x1p43, -0x1p43 - 1, -0x1p52}) all.push_back({over(kind, 3, end)});
  // A vertex over the triangle's side x + y = 2^52, and beside it by 1.
  for (const double beside_side : {0.0, 1.0, -1.0}) {
    PosedQuery posed = tests::over_triangle(0x1p50 + beside_side, 3 * 0x1p50, 0x1p20 + 1, -0x1p21);
    for (const std::size_t first : {3U, 15U}) {
      for (double& c : std::span(posed.query.coordinates).subspan(first, 9)) c *= 0x1p50;
    }
    all.push_back({posed});
  }
  return all;
}

// ---- The suite ----------------------------------------------------------------------------------

/// A thousand times the count in the soak.
std::size_t scaled(std::size_t count) { return tests::soak_trials(count, std::size_t{1000}); }

/// Tolerances and times that queries have in turn.
constexpr std::array<CertifiedOptions, 12> options_in_turn{{{},
                                                            {.toi_tolerance = 0.0},
                                                            {.toi_tolerance = 1e-16},
                                                            {.t_max = 0.5},
                                                            {.toi_tolerance = 1e-14},
                                                            {.toi_tolerance = 1e-9},
                                                            {.toi_tolerance = 0.25, .t_max = 0.9},
                                                            {.toi_tolerance = 0.1},
                                                            {.toi_tolerance = 3.0},
                                                            {.t_max = 0.125},
                                                            {.toi_tolerance = 1e300},
                                                            {.t_max = 0.0}}};

/// Separations from beyond the query's size to far below rounding, and at the ends of the range.
Separation draw_separation(Random& random, const Query& query) {
  constexpr std::array<double, 12> fixed{
      1e-2, 1e-8, 1e-16, 1e-30,   1e-100, 0.5,
      0.8,  1.0,  3.0,   tiniest, 1e-40,  std::numeric_limits<double>::max()};
  const Norm norm = random.coin() ? Norm::linf : Norm::l2;
  const double drawn = fixed.at(random.bits() % fixed.size());
  if (random.coin()) return {.distance = drawn, .norm = norm};
  double size = 0.0;
  for (const double x : query.coordinates) size = std::max(size, std::abs(x));
  const double distance = std::ldexp(size * random.uniform(0.25, 1.0), -random.between(0, 110));
  return {.distance = std::max(distance, tiniest), .norm = norm};
}

/// Expects ‖F‖ at toi_upper and (u,v) to be hardly more than the separation, relative to the
/// coordinates: in contact those of each axis, else all. F has moved on by then: corners are
/// differences of coordinates, at most 4 of these apart.
void expect_place(const PosedQuery& posed, const CertifiedResult& result,
                  const Separation& separation, const Rational& accuracy) {
  const Rational upper(result.toi_upper), moved = 4 * (upper - Rational(result.toi_lower));
  const auto f = tests::contact_function<Rational>(posed.kind, posed.query, upper,
                                                   Rational(result.u), Rational(result.v));
  const std::size_t stride = is_zero(separation) ? 3 : 1;
  Rational square, slack;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double largest = 0.0;
    for (std::size_t i = axis % stride; i < posed.query.coordinates.size(); i += stride) {
      largest = std::max(largest, std::abs(posed.query.coordinates.at(i)));
    }
    slack = Rational(largest) * (accuracy + moved);
    EXPECT_LE(abs(f[axis]), Rational(separation.distance) + slack) << posed;
    square += f[axis] * f[axis];
  }
  if (separation.norm == Norm::l2 && !is_zero(separation)) {
    const Rational reach = Rational(separation.distance) + 2 * slack;
    EXPECT_LE(square, reach * reach) << posed;
  }
}

/// Expects the oracle's result, and that a contact counts exactly from its time on.
void expect_truth(const Decider& decider, const PosedQuery& posed, const exact::Decision& truth,
                  const CertifiedResult& result, const CertifiedOptions& options) {
  const auto wrong = tests::fault(posed.kind, truth, result, options);
  ASSERT_FALSE(wrong) << decider.name << ": " << *wrong << (result.is_exact ? " exact" : "")
                      << " at " << options.separation.distance << " in "
                      << to_string(options.separation.norm) << ": " << posed;
  if (result.verdict != Verdict::yes || options.t_max < 1.0) return;
  const auto collides_until = [&](double t_max) {
    CertifiedOptions until = options;
    until.t_max = t_max;
    return decider(posed, until).verdict == Verdict::yes;
  };
  const double least_time = truth.toi->enclosure().upper;
  EXPECT_TRUE(collides_until(least_time)) << decider.name << ' ' << posed;
  if (least_time > 0.0) {
    EXPECT_FALSE(collides_until(std::nextafter(least_time, 0.0))) << decider.name << ' ' << posed;
  }
  if (options.toi_tolerance > 1e-12) return;
  const bool is_close = result.is_exact && is_zero(options.separation);
  if (decider.knows_the_place) {
    expect_place(posed, result, options.separation, exact::power_of_two(is_close ? -43 : -20));
  }
}

class Deciders : public testing::TestWithParam<QueryFamily> {
 protected:
  void SetUp() override {
    if (GetParam().count == 0) GTEST_SKIP() << "public data missing";
  }

  /// All queries of the family, or one in `stride`.
  static std::vector<Query> draw(ContactKind kind, std::size_t stride) {
    const auto& [name, count, draw_one] = GetParam();
    const std::size_t all = name == "public_data" ? public_queries(kind).size() : scaled(count);
    Random random(11);
    std::vector<Query> queries;
    for (std::size_t i = 0; i < all; i += stride) queries.push_back(draw_one(random, kind, i));
    return queries;
  }
};

TEST_P(Deciders, AreRightAboutContact) {
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    const std::vector<Query> queries = draw(kind, 1);
    for (std::size_t turn = 0; turn < options_in_turn.size(); ++turn) {
      const CertifiedOptions& options = options_in_turn.at(turn);
      std::vector<Query> share;
      std::vector<exact::Decision> truths;
      for (std::size_t i = turn; i < queries.size(); i += options_in_turn.size()) {
        share.push_back(queries[i]);
        truths.push_back(exact::decide(kind, queries[i]));
      }
      std::vector<CertifiedResult> results(share.size());
      for (const Decider& decider : deciders) {
        decider.solve(kind, share, results, options);
        for (std::size_t i = 0; i < share.size(); ++i) {
          expect_truth(decider, {kind, share[i]}, truths[i], results[i], options);
          if (HasFailure()) return;
        }
      }
    }
  }
}

TEST_P(Deciders, AreRightAtSeparations) {
  Random random(12);
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    const std::vector<Query> queries = draw(kind, 5);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      CertifiedOptions options = options_in_turn.at(i % options_in_turn.size());
      options.separation = draw_separation(random, queries[i]);
      const PosedQuery posed{kind, queries[i]};
      const exact::Decision truth = exact::decide(kind, queries[i], options.separation);
      for (const Decider& decider : deciders) {
        if (i % decider.share != 0) continue;
        expect_truth(decider, posed, truth, decider(posed, options), options);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(DecidersByHand, AreRightWhereABitDecides) {
  int collisions = 0, no_collisions = 0;
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (const auto& [posed, separation] : queries_by_hand(kind)) {
      const exact::Decision truth = exact::decide(posed.kind, posed.query, separation);
      ++(truth.collides() ? collisions : no_collisions);
      for (CertifiedOptions options : options_in_turn) {
        options.separation = separation;
        for (const Decider& decider : deciders) {
          expect_truth(decider, posed, truth, decider(posed, options), options);
        }
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(collisions, 40);
  EXPECT_GT(no_collisions, 15);
}

INSTANTIATE_TEST_SUITE_P(On, Deciders, testing::ValuesIn(query_families()),
                         [](const auto& tested) { return tested.param.name; });

// ---- Work ---------------------------------------------------------------------------------------

/// The general decision is for the rare query whose numbers do not fit.
TEST(FixedSizeDecision, DecidesAlmostAllSmallIntegers) {
  using Number = exact_stage::FixedInteger<1>;
  Random random(1);
  int undecided = 0;
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
    const PosedQuery posed{kind, tests::integer_query(random, 1 + i % 4)};
    for (const double scale : {1.0, greatest_scale(posed.query)}) {
      const auto motion = integer_motion<Number>(posed, scale);
      undecided += fixed_size_first_impact(motion, exact_stage::bits_of_one, 1).decided ? 0 : 1;
    }
  }
  EXPECT_LT(undecided, count / 50);
}

}  // namespace
}  // namespace touchstone::fast::deciders_test
