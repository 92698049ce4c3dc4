#include "fast/distance/contact_enclosure.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "fast/certified/exact/closest_point_parameters.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/distance_at_time.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::contact_enclosure_test {
namespace {

using exact::power_of_two;
using exact::Rational;
using exact_stage::Parameters;
using tests::PosedQuery;
using tests::Random;
using namespace tests::exact_pair;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr auto kinds =
    std::to_array<ContactKind>({ContactKind::vertex_face, ContactKind::edge_edge});

// ---- The truth ----------------------------------------------------------------------------------

/// The contact at a time that is known to 2^-300 of itself, or exactly.
struct Truth {
  Vector first, second;
  Vector normal;  ///< of any length; 0 if there is none
  /// True if the other direction is as right.
  bool is_one_of_two = false;
  /// True if no other points are as near.
  bool is_unique = true;
};

/// True if the product is 0 at the exact time: it is less than what the time's error explains.
bool is_noise(const Vector& product, const Vector& a, const Vector& b) {
  static const Rational noise = power_of_two(-500);
  return dot(product, product) <= noise * dot(a, a) * dot(b, b);
}

/// \param at the parameters of the common point, if the primitives touch
Truth truth_at(const ExactPair& pair, const Rational& t,
               const std::optional<std::pair<Rational, Rational>>& touching) {
  const auto [u, v] = touching ? *touching : nearest_exactly(pair, t);
  const Vector p = pair.vector(1, t), q = pair.vector(2, t), f = pair.difference(t, u, v);
  const bool is_face = pair.posed.kind == ContactKind::vertex_face;
  Truth truth;
  truth.first = is_face ? pair.point(0, t) : sum(pair.point(0, t), -u, p);
  truth.second = sum(truth.first, -1, f);
  const Vector product = cross(p, q);
  const bool is_flat = is_noise(product, p, q);
  truth.is_unique = is_face || !is_flat;
  if (!touching) {
    truth.normal = f;
    return truth;
  }
  const auto is_never_other = [&](std::size_t i) {
    return is_zero(pair.vector(i, 0)) && is_zero(pair.vector(i, 1));
  };
  if (is_never_other(1) || is_never_other(2)) {
    const Vector rate = pair.rate(u, v), e = is_never_other(1) ? q : p;
    const Vector upright = is_zero(e) ? rate : cross(cross(e, rate), e);
    const bool is_along = !is_zero(e) && is_noise(cross(e, rate), e, rate);
    truth.normal = is_along ? Vector() : negative(upright);
    return truth;
  }
  truth.normal = is_flat ? Vector() : product;
  // The side just before.
  const Rational before = t > 0 ? Rational(t - t * power_of_two(-150)) : -power_of_two(-150);
  const int side = sgn(dot(pair.product(before), pair.vector(0, before)));
  if (side < 0) truth.normal = negative(truth.normal);
  truth.is_one_of_two = side == 0;
  return truth;
}

/// |a/|a| − n|.
double distance_from(const Vector& a, const Eigen::Vector3d& n) {
  constexpr mp_bitcnt_t bits = 300;
  std::array<mpf_class, 3> x{mpf_class(a[0], bits), mpf_class(a[1], bits), mpf_class(a[2], bits)};
  const mpf_class length = sqrt(mpf_class(x[0] * x[0] + x[1] * x[1] + x[2] * x[2], bits));
  mpf_class square(0.0, bits);
  for (std::size_t k = 0; k < 3; ++k) {
    const mpf_class difference(x[k] / length - n[static_cast<Eigen::Index>(k)], bits);
    square += difference * difference;
  }
  return mpf_class(sqrt(square)).get_d();
}

double greatest_coordinate(const Query& query) {
  double greatest = 0.0;
  for (const double x : query.coordinates) greatest = std::max(greatest, std::abs(x));
  return greatest;
}

/// What is wrong, or nothing.
std::string fault_of(const ExactPair& pair, const ContactEnclosure& found, const Truth& truth) {
  const auto [u, v] = found.at;
  const bool is_face = pair.posed.kind == ContactKind::vertex_face;
  if (!(u >= 0.0 && v >= 0.0 &&
        (is_face ? Rational(u) + Rational(v) : Rational(std::max(u, v))) <= 1))
    return "outside the domain";
  const Rational slack = power_of_two(-250) * Rational(greatest_coordinate(pair.posed.query));
  const auto is_within = [&](const Vector& a, const Rational& distance) {
    const Rational reach = distance + slack;
    return dot(a, a) <= reach * reach;
  };
  if (!(found.point_error >= 0.0)) return "no error of the points";
  if (found.point_error < infinity) {
    const Rational error(found.point_error);
    const Vector first = rational(found.first), second = rational(found.second);
    if (truth.is_unique) {
      if (!is_within(sum(first, -1, truth.first), error)) return "first point";
      if (!is_within(sum(second, -1, truth.second), error)) return "second point";
    }
    const Vector difference = sum(truth.first, -1, truth.second);
    if (!is_within(sum(sum(first, -1, second), -1, difference), 2 * error)) return "points apart";
  }
  if (!(std::abs(found.normal.norm() - 1.0) < 1e-14)) return "normal without unit length";
  if (!(found.normal_error > 0.0)) return "no error of the normal";
  if (found.normal_error == infinity) return found.has_side ? "side without a normal" : "";
  if (found.normal_error > 0.5) return "great error of the normal";
  if (is_zero(truth.normal)) return "normal where there is none";
  const double error = found.normal_error * (1.0 + 1e-12);
  const bool is_that = distance_from(truth.normal, found.normal) <= error;
  const bool is_other = distance_from(negative(truth.normal), found.normal) <= error;
  if (!is_that && !is_other) return "normal";
  if (found.has_side && truth.is_one_of_two) return "side where there is none";
  if (found.has_side && !is_that) return "side";
  return "";
}

// ---- Queries ------------------------------------------------------------------------------------

/// Multiplies the coordinates of the axes from `first` on.
void scale(Query& query, std::size_t first, int exponent) {
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    double& x = query.coordinates[i];
    if (i % 3 >= first) x = std::ldexp(x, exponent);
  }
}

struct Drawn {
  PosedQuery posed;
  double size = 1.0;
  bool is_plain = false;  ///< in general position, of usual size
};

Drawn draw(Random& random, ContactKind kind) {
  const auto family = tests::all_families[static_cast<std::size_t>(random.between(0, 3))];
  Drawn result{.posed = tests::random_query(random, kind, family)};
  Query& query = result.posed.query;
  switch (random.between(0, 7)) {
    case 0: {
      const int exponent = random.between(-1060, 1020);
      scale(query, 0, exponent);
      result.size = std::ldexp(1.0, exponent);
      break;
    }
    case 1:
      scale(query, 2, -random.between(1, 100));
      break;
    case 2:  // an edge or a face without a part of its extent
      tests::share_point(query, static_cast<std::size_t>(random.between(0, 3)),
                         static_cast<std::size_t>(random.between(0, 3)));
      break;
    default:
      result.is_plain = family == tests::Family::full_significands;
  }
  return result;
}

using Enclose = ContactEnclosure(ContactKind, const Query&, const TimeEnclosure&, const Parameters&,
                                 bool);

/// Numbers of contacts that are right and wrong, of those in general position, and of these that
/// have narrow bounds.
struct Count {
  int right = 0, wrong = 0, plain = 0, narrow = 0;
  std::string first_fault;

  void add(const Drawn& drawn, const ContactEnclosure& found, const Truth& truth) {
    const std::string fault = fault_of({drawn.posed}, found, truth);
    ++(fault.empty() ? right : wrong);
    if (!fault.empty() && first_fault.empty()) {
      std::ostringstream text;
      text << fault << " of " << drawn.posed << "; u, v " << found.at.u << ' ' << found.at.v
           << "; errors " << found.point_error << ' ' << found.normal_error << "; points "
           << found.first.transpose() << ", " << found.second.transpose() << "; normal "
           << found.normal.transpose();
      first_fault = text.str();
    }
    if (!drawn.is_plain) return;
    ++plain;
    narrow += found.point_error < 1e-9 && found.normal_error < 1e-8 && found.has_side ? 1 : 0;
  }
};

/// At the times of impact that the certified solver encloses.
void ask_at_impacts(Enclose* enclose, Random& random, int rounds, double distance, Count& count) {
  for (int round = 0; round < rounds; ++round) {
    const ContactKind kind = kinds.at(static_cast<std::size_t>(round) % 2);
    Drawn drawn = draw(random, kind);
    const Query& query = drawn.posed.query;
    const bool is_wide = random.coin();
    drawn.is_plain &= !is_wide;
    const CertifiedOptions options{.toi_tolerance = is_wide ? 1e-5 : 1e-12,
                                   .separation = {.distance = distance * drawn.size}};
    const CertifiedResult result = solve(kind, query, options);
    if (result.verdict != Verdict::yes) continue;
    exact::Decision decision = exact::decide(kind, query, options.separation);
    const bool has_common_point =
        decision.contact.has_value() ||
        (*decision.toi == 0 && fast::distance(kind, query, 0.0).upper == 0.0);
    if (has_common_point && !decision.contact) decision = exact::decide(kind, query);
    const Rational width = power_of_two(-300);
    std::optional<std::pair<Rational, Rational>> touching;
    if (has_common_point) {
      const auto at = exact::contact_parameters(decision, width);
      touching = {at.u.lower, at.v.lower};
    }
    exact::AlgebraicNumber toi = *decision.toi;
    if (result.toi_upper > 0.0) toi.refine(width * Rational(result.toi_upper));
    const Truth truth = truth_at({drawn.posed}, toi.interval().lower, touching);
    const TimeEnclosure time{result.toi_lower,
                             has_common_point && distance > 0.0 ? 0.0 : result.toi_upper};
    count.add(drawn, enclose(kind, query, time, {result.u, result.v}, has_common_point), truth);
  }
}

/// At given times, of parameters that may be poor.
void ask_at_times(Enclose* enclose, Random& random, int rounds, Count& count) {
  for (int round = 0; round < rounds; ++round) {
    const ContactKind kind = kinds.at(static_cast<std::size_t>(round) % 2);
    Drawn drawn = draw(random, kind);
    const Query& query = drawn.posed.query;
    const double t = random.coin() ? 0.125 * random.between(0, 8) : random.uniform(0, 1);
    Parameters at = exact_stage::nearest_parameters(kind, query, t, Norm::l2);
    if (random.coin()) {
      const double poor = std::ldexp(1.0, -random.between(0, 50));
      at.u += random.uniform(-poor, poor);
      at.v += random.uniform(-poor, poor);
      drawn.is_plain = false;
    }
    const bool is_touching = fast::distance(kind, query, t).upper == 0.0;
    const Rational time(t);
    std::optional<std::pair<Rational, Rational>> touching;
    if (is_touching) touching = nearest_exactly({drawn.posed}, time);
    count.add(drawn, enclose(kind, query, {t, t}, at, is_touching),
              truth_at({drawn.posed}, time, touching));
  }
}

Count ask(Enclose* enclose, int rounds) {
  Random random(5301);
  Count count;
  ask_at_impacts(enclose, random, 4 * rounds, 0.0, count);
  ask_at_impacts(enclose, random, rounds, 0.05, count);
  ask_at_times(enclose, random, 2 * rounds, count);
  return count;
}

TEST(ContactEnclosure, ContainsTheExactContactAndIsNarrowInGeneralPosition) {
  const int rounds = tests::soak_trials(400, 25);
  const Count count = ask(enclose_contact, rounds);
  EXPECT_EQ(count.wrong, 0) << count.first_fault;
  EXPECT_GT(count.right, 3 * rounds / 2);
  EXPECT_GT(count.plain, rounds / 5);
  EXPECT_GT(count.narrow, count.plain * 9 / 10) << count.plain;
}

TEST(ContactEnclosure, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().contact_enclosure) {
    EXPECT_GT(ask(fault.part, tests::trials(400)).wrong, 0) << fault.name;
  }
}

// ---- Relations ----------------------------------------------------------------------------------

/// Both enclosures after the same exact motion contain one contact.
void expect_same(const ContactEnclosure& a, const ContactEnclosure& b, const PosedQuery& posed) {
  const double reach = (a.point_error + b.point_error) * (1.0 + 1e-12);
  EXPECT_LE((a.first - b.first).norm(), reach) << posed;
  EXPECT_LE((a.second - b.second).norm(), reach) << posed;
  if (a.normal_error == infinity || b.normal_error == infinity) return;
  const double turn = (a.normal_error + b.normal_error) * (1.0 + 1e-12);
  const double same = (a.normal - b.normal).norm(), opposite = (a.normal + b.normal).norm();
  EXPECT_LE(a.has_side && b.has_side ? same : std::min(same, opposite), turn) << posed;
}

struct Asked {
  PosedQuery posed;
  TimeEnclosure time;
  Parameters at;
  bool is_touching;

  [[nodiscard]] ContactEnclosure enclosure() const {
    return enclose_contact(posed.kind, posed.query, time, at, is_touching);
  }
};

/// x, y and z by turns, the first one mirrored: a rotation but for the mirror.
Eigen::Vector3d turned(const Eigen::Vector3d& x) { return {-x[1], x[2], x[0]}; }

/// The images of a contact under exact symmetries: axes, order of points, roles of edges, time.
TEST(ContactEnclosure, IsThatOfItsImage) {
  Random random(5302);
  int compared = 0;
  for (int round = 0; round < tests::trials(600); ++round) {
    const ContactKind kind = kinds.at(static_cast<std::size_t>(round) % 2);
    const PosedQuery posed = tests::random_query(random, kind, tests::Family::near_contact);
    const double distance = random.coin() ? 0.0 : 0.05;
    const auto result = solve(kind, posed.query, {.separation = {.distance = distance}});
    // In contact at once with a separation, the distance at the start is any up to that.
    if (result.verdict != Verdict::yes || result.toi_lower == 0.0) continue;
    const Asked asked{
        posed, {result.toi_lower, result.toi_upper}, {result.u, result.v}, distance == 0.0};
    const ContactEnclosure found = asked.enclosure();
    Asked image = asked;
    for (const std::size_t end : {0U, 1U}) {
      for (std::size_t i = 0; i < moving_points; ++i) {
        point_of(image.posed.query, end, i) = turned(point_of(posed.query, end, i));
      }
    }
    ContactEnclosure expected = found;
    for (auto* const x : {&expected.first, &expected.second, &expected.normal}) *x = turned(*x);
    expect_same(expected, image.enclosure(), posed);

    image = asked;
    expected = found;
    for (const std::size_t end : {0U, 1U}) {
      const Query& from = posed.query;
      Query& to = image.posed.query;
      if (kind == ContactKind::vertex_face) {  // the face from another vertex
        for (std::size_t i = 1; i < moving_points; ++i)
          point_of(to, end, i % 3 + 1) = point_of(from, end, i);
      } else {  // the second edge first
        for (std::size_t i = 0; i < moving_points; ++i)
          point_of(to, end, (i + 2) % 4) = point_of(from, end, i);
      }
    }
    if (kind == ContactKind::vertex_face) {
      image.at = {1.0 - result.u - result.v, result.u};
    } else {
      image.at = {result.v, result.u};
      std::swap(expected.first, expected.second);
      expected.normal = -expected.normal;
    }
    expect_same(expected, image.enclosure(), posed);
    ++compared;
  }
  EXPECT_GT(compared, tests::trials(150));
}

}  // namespace
}  // namespace touchstone::fast::contact_enclosure_test
