#include "fast/certified/exact/general_contact_decision.hpp"

#include <algorithm>
#include <vector>

#include "fast/certified/exact/real_root.hpp"

namespace touchstone::fast::exact_stage {
namespace {

using BigMotion = Motion<BigInteger>;
using Normal = MovingNormal<BigInteger>;
using Contact = ContactOf<BigInteger>;

/// Common data of a motion's decision.
struct Problem {
  const BigMotion& motion;
  Normal normal;
  Form<BigInteger, 3> determinant;
};

ExactImpact impact_at(Instant& instant, const Contact& contact, const BitInterval& time) {
  if (instant.sign_of(contact.denominator) == 0) return exact_stage::impact_at(time, 0.0, 0.0);
  return exact_stage::impact_at(time, instant.quotient_of(contact.u, contact.denominator),
                                instant.quotient_of(contact.v, contact.denominator));
}

/// Contact at a time with D = 0.
std::optional<Contact> contact_at(const Problem& problem, Instant& instant) {
  return contact_in_plane(problem.motion, problem.normal,
                          [&](const Form<BigInteger, 2>& form) { return instant.sign_of(form); });
}

/// Replaces `best` if the instant, a time > 0 with D = 0, is an earlier contact. Returns true if
/// later instants need no examination.
bool consider(const Problem& problem, Instant& instant, std::uint64_t& latest,
              std::optional<ExactImpact>& best) {
  if (instant.is_above(latest)) return true;
  const auto contact = contact_at(problem, instant);
  if (!contact) return false;
  const BitInterval time =
      enclose(instant.guess(), 1, [&](std::uint64_t bits) { return instant.is_above(bits); });
  best = impact_at(instant, *contact, time);
  latest = time.upper;
  return true;
}

std::vector<Polynomial> events(const Problem& problem) {
  if (!is_zero(problem.determinant)) {
    return {inner_polynomial(problem.determinant)};
  }
  std::vector<Polynomial> result;
  for (const auto& form : events_in_plane(problem.motion, problem.normal)) {
    result.push_back(inner_polynomial(form));
  }
  return result;
}

/// Does a vertex miss another, of which this is seen without a root? If r is 0 at a time t, then
/// (1−t) r(0) = −t r(1): these are parallel.
bool is_vertex_beside_vertex(const BigMotion& motion) {
  const auto is_no_vector = [](const MovingVector<BigInteger>& vector) {
    return std::ranges::all_of(vector, [](const auto& form) { return is_zero(form); });
  };
  if (!is_no_vector(motion.p) || !is_no_vector(motion.q)) return false;
  const auto& r = motion.r;
  const auto are_parallel = [&r](std::size_t i, std::size_t k) {
    return r[i].front() * r[k].back() == r[k].front() * r[i].back();
  };
  return !are_parallel(0, 1) || !are_parallel(1, 2) || !are_parallel(2, 0);
}

}  // namespace

std::optional<ExactImpact> first_impact(const BigMotion& motion, std::uint64_t latest) {
  if (is_vertex_beside_vertex(motion)) return std::nullopt;
  Problem problem{motion, normal(motion), {}};
  problem.determinant = determinant(motion, problem.normal);
  if (problem.determinant.front().sign() == 0) {
    Instant start(Dyadic{0, 0});
    if (const auto contact = contact_at(problem, start)) {
      return impact_at(start, *contact, {bits_of_zero, bits_of_zero});
    }
  }
  std::optional<ExactImpact> best;
  for (const Polynomial& event : events(problem)) {
    visit_roots(event, [&](Instant& instant) { return consider(problem, instant, latest, best); });
  }
  if (!best && problem.determinant.back().sign() == 0) {
    Instant end(Dyadic{1, 0});
    static_cast<void>(consider(problem, end, latest, best));
  }
  return best;
}

}  // namespace touchstone::fast::exact_stage
