#include "touchstone/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fast/distance/exact_distance.hpp"
#include "fast/distance/filter_kernel.hpp"
#include "fast/distance/filtered_distance.hpp"
#include "fast/distance/neighbouring_doubles.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/distance_at_time.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::fast::distance_test {
namespace {

using exact::Rational;
using tests::PosedQuery;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();
constexpr auto kinds =
    std::to_array<ContactKind>({ContactKind::vertex_face, ContactKind::edge_edge});
constexpr auto norms = std::to_array<Norm>({Norm::l2, Norm::linf});

// ---- The truth ----------------------------------------------------------------------------------

/// The approximate distance, also if its square is not a double.
double approximately(const Rational& measure, Norm norm) {
  if (measure == 0) return 0.0;
  long above = 0, below = 0;
  double ratio = mpz_get_d_2exp(&above, measure.get_num_mpz_t());
  ratio /= mpz_get_d_2exp(&below, measure.get_den_mpz_t());
  const auto exponent = static_cast<int>(above - below);
  if (norm == Norm::linf) return std::ldexp(ratio, exponent);
  const int odd = exponent & 1;
  return std::ldexp(std::sqrt(std::ldexp(ratio, odd)), (exponent - odd) / 2);
}

/// The doubles around the true distance.
Distance truth(const PosedQuery& posed, double t, Norm norm) {
  const Rational measure = tests::exact_pair::distance_at_time(posed, t, norm);
  const auto sign_of = [&](double x) -> std::optional<int> {
    return tests::compare_distance(measure, norm, Rational(x));
  };
  return *neighbouring_doubles(approximately(measure, norm), sign_of);
}

/// The fault of the answer about the query as text, or nothing.
std::string fault(const PosedQuery& posed, double t, Norm norm) {
  const Distance expected = truth(posed, t, norm);
  const auto difference = [&](const char* who, const Distance& found) -> std::string {
    if (found == expected) return "";
    std::ostringstream text;
    text << who << std::hexfloat << ": [" << found.lower << ", " << found.upper << "] and not ["
         << expected.lower << ", " << expected.upper << "] at " << t << " in " << to_string(norm)
         << " of " << posed;
    return text.str();
  };
  if (auto what = difference("exact", exact_distance(posed.kind, posed.query, t, norm));
      !what.empty()) {
    return what;
  }
  if (const auto filtered = filtered_distance(posed.kind, posed.query, t, norm)) {
    if (auto what = difference("filtered", *filtered); !what.empty()) return what;
  }
  return difference("distance", distance(posed.kind, posed.query, t, norm));
}

double random_time(Random& random) {
  switch (random.between(0, 5)) {
    case 0:
      return 0.0;
    case 1:
      return 1.0;
    case 2:
      return 0.125 * random.between(0, 8);
    case 3:
      return std::ldexp(random.uniform(0.5, 1), -random.between(0, 1070));
    default:
      return random.uniform(0, 1);
  }
}

/// A query with the coordinates of the last axes, from `first` on, at another scale.
PosedQuery scaled_from(std::size_t first, int exponent, Random& random, ContactKind kind) {
  PosedQuery posed = tests::random_query(random, kind, tests::Family::full_significands);
  for (std::size_t i = 0; i < posed.query.coordinates.size(); ++i) {
    double& x = posed.query.coordinates[i];
    if (i % 3 >= first) x = std::ldexp(x, exponent);
  }
  return posed;
}

PosedQuery of_one_scale(Random& random, ContactKind kind) {
  return scaled_from(0, random.between(-1070, 1021), random, kind);
}

/// All sizes are 1, but on one axis.
PosedQuery flat(Random& random, ContactKind kind) {
  return scaled_from(2, -std::abs(random.between(-1070, 1021)), random, kind);
}

PosedQuery of_all_scales(Random& random, ContactKind kind) {
  PosedQuery posed{kind, {}};
  for (double& x : posed.query.coordinates) x = random.finite_double();
  return posed;
}

/// Some points equal others or are collinear with two others, at one end or at both.
PosedQuery degenerate(Random& random, ContactKind kind) {
  PosedQuery posed = tests::random_query(random, kind, tests::Family::full_significands);
  for (int i = random.between(1, 3); i > 0; --i) {
    const auto from = static_cast<std::size_t>(random.between(0, 3));
    const auto to = static_cast<std::size_t>(random.between(0, 3));
    const auto third = static_cast<std::size_t>(random.between(0, 3));
    const bool is_middle = random.coin();
    for (const std::size_t end : {0U, 1U}) {
      if (random.between(0, 4) == 0) continue;
      const Eigen::Vector3d a = point_of(posed.query, end, from),
                            b = point_of(posed.query, end, third);
      point_of(posed.query, end, to) = is_middle ? Eigen::Vector3d(0.5 * (a + b)) : a;
    }
  }
  return posed;
}

TEST(Distance, IsThatOfRationals) {
  Random random(2001);
  const auto expect_truth = [&](const PosedQuery& posed) {
    const double t = random.coin() ? 0.0 : random_time(random);
    for (const Norm norm : norms) ASSERT_EQ(fault(posed, t, norm), "");
  };
  for (int round = 0; round < tests::soak_trials(150, 25); ++round) {
    for (const ContactKind kind : kinds) {
      for (const tests::Family family : tests::all_families) {
        expect_truth(tests::random_query(random, kind, family));
      }
      for (int i = 0; i < 2; ++i) expect_truth(degenerate(random, kind));
      if (round % 2 == 0) {
        for (const auto draw : {&of_one_scale, &of_all_scales, &flat}) {
          expect_truth(draw(random, kind));
        }
      }
      if (HasFatalFailure()) return;
    }
  }
  // Distances that are doubles, the least one and parts of it; and one beyond the greatest double.
  constexpr double m = greatest;
  std::vector<PosedQuery> by_hand{tests::vertex_face({m, m, m, -m, 0, 0, -m, 0, 0, -m, 0, 0}, {})};
  for (const double height : {1.0, 0.1, 1e-300, tiniest, 1e300, 0.0}) {
    for (const double end : {-height, 0.0, height}) {
      by_hand.push_back(tests::over_triangle(1, 1, height, end));
      by_hand.push_back(tests::over_edge(1, 1, height, end));
    }
  }
  for (const PosedQuery& posed : by_hand) {
    for (const double t : {0.0, 0.5, 0.75, 1.0}) {
      for (const Norm norm : norms) EXPECT_EQ(fault(posed, t, norm), "");
    }
  }
}

// ---- Neighbouring doubles -----------------------------------------------------------------------

/// The sign of (x, or a number between it and the next double) − s.
auto sign_against(double x, bool is_between) {
  return [=](double s) -> std::optional<int> {
    if (x > s) return 1;
    if (x < s) return -1;
    return is_between ? 1 : 0;
  };
}

TEST(NeighbouringDoubles, AreFoundFromAnyGuess) {
  constexpr auto numbers =
      std::to_array({0.0, tiniest, 0x1p-1022, 1e-300, 0.1, 1.0, 7.0, greatest});
  constexpr auto guesses = std::to_array({0.0, -1.0, tiniest, 1e-300, 0.1, 1.0, 1e300, greatest,
                                          infinity, std::numeric_limits<double>::quiet_NaN()});
  for (const double x : numbers) {
    for (const double guess : guesses) {
      EXPECT_EQ(neighbouring_doubles(guess, sign_against(x, false)), (Distance{x, x}));
      EXPECT_EQ(neighbouring_doubles(guess, sign_against(x, true)),
                (Distance{x, std::nextafter(x, infinity)}));
    }
  }
}

// ---- What follows -------------------------------------------------------------------------------

TEST(Distance, OfManyIsThatOfEachInAllInstructionSetsAndAsARuleFiltered) {
  Random random(2006);
  for (const ContactKind kind : kinds) {
    for (const double t : {0.0, 0.3, 1.0}) {
      // A count that is not a multiple of any number of lanes; one in four is near contact.
      std::vector<Query> queries;
      for (std::size_t i = 0; i < 501; ++i) {
        queries.push_back(tests::random_query(random, kind, tests::all_families[i % 4]).query);
        if (i % 50 == 0) queries.back().coordinates[i % 24] = random.finite_double();
      }
      for (const Norm norm : norms) {
        std::vector<Distance> expected;
        int filtered = 0;
        for (std::size_t i = 0; i < queries.size(); ++i) {
          expected.push_back(distance(kind, queries[i], t, norm));
          if (i % 4 == 2) filtered += filtered_distance(kind, queries[i], t, norm) ? 1 : 0;
        }
        // Queries in contact are not filtered.
        EXPECT_TRUE(filtered > 100 || t != 0.3) << to_string(norm);
        for (const int threads : {1, 0}) {
          std::vector<Distance> found(queries.size());
          distances(kind, queries, t, norm, found, threads);
          EXPECT_EQ(found, expected);
        }
        for (const DistanceKernel* const kernel : distance_kernels()) {
          if (norm != Norm::l2) continue;
          std::vector<Distance> found(queries.size());
          kernel->filter(kind, queries.data(), queries.size(), t, found.data());
          int open = 0;
          for (std::size_t i = 0; i < queries.size(); ++i) {
            const bool is_open = found[i] == open_distance;
            EXPECT_TRUE(is_open || found[i] == expected[i]) << to_string(kernel->instructions);
            open += is_open && i % 4 == 2 ? 1 : 0;
          }
          EXPECT_LT(open, 25) << to_string(kernel->instructions);
        }
      }
    }
  }
}

// ---- What is kept -------------------------------------------------------------------------------

/// The number of times that the inequality says too much, and that it says something.
struct Kept {
  int wrong = 0;
  int said = 0;
};

template <class KeepsDistance>
Kept ask_what_is_kept(const KeepsDistance& keeps) {
  Kept result;
  Random random(2011);
  for (int round = 0; round < 20000; ++round) {
    const ContactKind kind = kinds.at(static_cast<std::size_t>(round) % 2);
    Query query = tests::random_query(
                      random, kind, tests::all_families.at(static_cast<std::size_t>(round) / 2 % 4))
                      .query;
    // Steps from the whole motion to hardly any, and sizes from tiny to great.
    const double part_of_motion = std::ldexp(1.0, -random.between(0, 8));
    const double scale = std::ldexp(1.0, round % 5 == 0 ? random.between(-450, 450) : 0);
    for (std::size_t i = 0; i < 12; ++i) {
      double& end = query.coordinates[12 + i];
      end = query.coordinates[i] + part_of_motion * (end - query.coordinates[i]);
    }
    for (double& x : query.coordinates) x *= scale;
    const KeptDistance kept{.part = random.coin() ? 0.2 : random.unit(),
                            .least = random.coin() ? 0.0 : scale * random.uniform(0.0, 0.5)};
    const double t_max = random.coin() ? 1.0 : random.unit();
    if (!is_finite(query) || !keeps(kind, query, t_max, kept)) continue;
    ++result.said;
    const double d = distance(kind, query, 0.0).upper;
    const Separation left{.distance = kept.least + kept.part * (d - kept.least), .norm = Norm::l2};
    const CertifiedResult near = fast::solve(kind, query, {.t_max = t_max, .separation = left});
    result.wrong += d <= kept.least || near.verdict != Verdict::no ? 1 : 0;
  }
  return result;
}

TEST(KeptDistance, IsKept) {
  const Kept kept = ask_what_is_kept(keeps_distance);
  EXPECT_EQ(kept.wrong, 0);
  EXPECT_GT(kept.said, 3000);
}

TEST(KeptDistance, IsSeenUntilShortlyBefore) {
  // The height over the centroid falls from 1 to −1, so that a quarter of it is left at 3/8, and
  // 5/8, which is 1/2 and a quarter of the rest, at 3/16.
  const Query query = tests::over_triangle(4.0 / 3.0, 4.0 / 3.0, 1, -1).query;
  const auto keeps = [&](double t_max, double least) {
    return keeps_distance(ContactKind::vertex_face, query, t_max, {.part = 0.25, .least = least});
  };
  EXPECT_TRUE(keeps(0.374, 0.0));
  EXPECT_FALSE(keeps(0.376, 0.0));
  EXPECT_TRUE(keeps(0.187, 0.5));
  EXPECT_FALSE(keeps(0.188, 0.5));
  EXPECT_FALSE(keeps(0.0, 1.0));
  const Query above = tests::over_triangle(1, 1, 100, 99).query;
  EXPECT_TRUE(keeps_distance(ContactKind::vertex_face, above, 1.0, {.part = 0.25}));
  EXPECT_FALSE(keeps_distance(ContactKind::vertex_face, above, 1.0, {.part = 1.0}));
  Query unknown = above;
  unknown.coordinates[23] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(keeps_distance(ContactKind::vertex_face, unknown, 1.0, {}));
}

TEST(KeptDistance, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().kept_distance) {
    EXPECT_GT(ask_what_is_kept(*fault.part).wrong, 0) << fault.name;
  }
}

// ---- Faults -------------------------------------------------------------------------------------

/// True if an answer differs from the truth in a few hundred queries of all families.
template <class DistanceOf>
bool is_found(const DistanceOf& distance_of) {
  Random random(2010);
  for (int round = 0; round < 200; ++round) {
    for (const ContactKind kind : kinds) {
      for (const tests::Family family : tests::all_families) {
        const PosedQuery posed = tests::random_query(random, kind, family);
        // At the impact the distance is almost 0.
        const CertifiedResult impact = fast::solve(kind, posed.query);
        const double t = impact.verdict == Verdict::yes ? impact.toi_lower : random_time(random);
        for (const Norm norm : norms) {
          const std::optional<Distance> found = distance_of(kind, posed.query, t, norm);
          if (found && *found != exact_distance(kind, posed.query, t, norm)) return true;
        }
      }
    }
  }
  return false;
}

TEST(Distance, PlantedFaultsAreFound) {
  const auto expect_found = [](const auto& faults) {
    for (const auto& fault : faults) EXPECT_TRUE(is_found(*fault.part)) << fault.name;
  };
  expect_found(tests::planted_faults().exact_distance);
  expect_found(tests::planted_faults().filtered_distance);
  EXPECT_FALSE(is_found(filtered_distance));
}

// ---- The least of a step ------------------------------------------------------------------------

/// The least distance of all pairs, one by one.
std::optional<LeastDistance> least_of(const tests::Scene& scene, double t, Norm norm) {
  std::optional<LeastDistance> result;
  const tests::AllPairs all(scene);
  const bool has_thickness = !scene.separations.empty() ||
                             std::ranges::any_of(scene.radii, [](double r) { return r > 0; });
  for (const auto& named : all.pairs()) {
    Distance found = exact_distance(decided_as(named.first), all.query(named), t, norm);
    if (!has_thickness) {
      const auto order = [](const Distance& d) { return std::pair(d.lower, d.upper); };
      if (!result || order(found) < order(result->distance)) result = LeastDistance{found, {}};
      if (found == result->distance) result->pairs.push_back({named.first, named.second, found});
      continue;
    }
    const exact::Rational thickness(all.thickness(named));
    found = {exact::round_down(exact::Rational(found.lower) - thickness),
             exact::round_up(exact::Rational(found.upper) - thickness)};
    if (!result) result = LeastDistance{found, {}};
    result->distance = {std::min(result->distance.lower, found.lower),
                        std::min(result->distance.upper, found.upper)};
    result->pairs.push_back({named.first, named.second, found});
  }
  if (result) {
    std::erase_if(result->pairs, [&](const PairDistance& one) {
      return one.distance.lower > result->distance.upper;
    });
    std::ranges::sort(result->pairs, {},
                      [](const PairDistance& one) { return std::pair(one.kind, one.pair); });
  }
  return result;
}

TEST(LeastDistance, IsThatOfAllPairs) {
  Random random(2007);
  int positive = 0, of_many = 0;
  const auto expect_least = [&](const tests::Scene& scene, double t, Norm norm,
                                const std::vector<StepOptions>& all_options) {
    const auto expected = least_of(scene, t, norm);
    for (const StepOptions& options : all_options) {
      ASSERT_EQ(least_distance(scene.step(options), t, norm), expected) << t;
    }
    positive += expected && expected->distance.lower > 0.0 ? 1 : 0;
    of_many += expected && expected->pairs.size() > 1 ? 1 : 0;
  };
  for (int round = 0; round < tests::trials(60); ++round) {
    for (const tests::Shape& shape : tests::shapes()) {
      tests::Scene scene = tests::random_scene(random, shape, random.between(1, 10));
      if (round % 3 == 0) scene.can_collide = tests::random_rule(random);
      if (round % 4 == 3)
        tests::add_thickness(scene, std::min(0.5 * shape.separation, 1e300), random);
      // Neither separation nor end of the step matter.
      const StepOptions options{
          .solve = {.t_max = 0.25, .separation = {.distance = round % 2 * shape.separation}}};
      const double t = random_time(random);
      for (const Norm norm : norms) expect_least(scene, t, norm, {options});
      if (HasFatalFailure()) FAIL() << shape.name;
    }
  }
  EXPECT_GT(positive, tests::trials(200));
  EXPECT_GT(of_many, tests::trials(50));
  for (const double size : {0.01, 0.05}) {
    const tests::Scene scene = tests::soup(random, 60, size);
    for (const double t : {0.0, 0.3}) {
      expect_least(scene, t, Norm::l2,
                   {{.solve = {.max_threads = 1}}, {.solve = {.max_threads = 0}}});
    }
    EXPECT_EQ(least_distance(scene.step()), least_of(scene, 0.0, Norm::l2)) << "by default";
  }
}

/// Two points at rest, 1.56 apart in l2, 0.9 in linf.
TEST(LeastDistance, HasTheNormThatSeparationsHaveByDefault) {
  tests::Places places(2, 3);
  places << 0, 0, 0, 0.9, 0.9, 0.9;
  const Step step(places, places, {.points = {0, 1}}, {.solve = {.separation = {.distance = 1.0}}});
  EXPECT_GT(least_distance(step)->distance.lower, 1.0);
  EXPECT_TRUE(step.is_free());
  EXPECT_FALSE(step.with_separation({.distance = 1.0, .norm = Norm::linf}).is_free());
}

}  // namespace
}  // namespace touchstone::fast::distance_test
