#include "fast/certified/exact/general_contact_decision.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <utility>

#include "fast/certified/exact/real_root.hpp"

namespace touchstone::fast::exact_stage {
namespace {

using Contact = ContactOf<Polynomial>;

/// Common data of a motion's decision.
struct Problem {
  const MotionOf<Polynomial>& motion;
  std::array<Polynomial, 3> normal;
  Polynomial determinant;
};

/// Takes a contact that is earlier than all before.
using OnContact = std::function<void(Instant&, const Contact&, const BitInterval&)>;

ExactImpact impact_at(Instant& instant, const Contact& contact, const BitInterval& time) {
  if (instant.sign_of(contact.denominator) == 0) return exact_stage::impact_at(time, 0.0, 0.0);
  return exact_stage::impact_at(time, instant.quotient_of(contact.u, contact.denominator),
                                instant.quotient_of(contact.v, contact.denominator));
}

/// Contact at a time with D = 0.
std::optional<Contact> contact_at(const Problem& problem, Instant& instant) {
  return contact_in_plane(problem.motion, problem.normal,
                          [&](const Polynomial& form) { return instant.sign_of(form); });
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

/// True if a vertex is seen to miss another one without a root: if r is linear and 0 at a time t,
/// then (1−t) r(0) = −t r(1), so these are parallel.
bool is_vertex_beside_vertex(const MotionOf<Polynomial>& motion) {
  const auto is_no_vector = [](const std::array<Polynomial, 3>& vector) {
    return std::ranges::all_of(vector, [](const auto& form) { return is_zero(form); });
  };
  const auto& r = motion.r;
  if (r[0].size() != 2 || !is_no_vector(motion.p) || !is_no_vector(motion.q)) return false;
  const auto are_parallel = [&r](std::size_t i, std::size_t k) {
    return r[i].front() * r[k].back() == r[k].front() * r[i].back();
  };
  return !are_parallel(0, 1) || !are_parallel(1, 2) || !are_parallel(2, 0);
}

/// Calls `on_contact` with contacts, each earlier than all before, the first contact last.
void find_contacts(const PolynomialMotion& moving, std::uint64_t latest,
                   const OnContact& on_contact) {
  const auto& [motion, factors] = moving;
  if (is_vertex_beside_vertex(motion)) return;
  Problem problem{motion, normal(motion), {}};
  problem.determinant = determinant(motion, problem.normal);
  if (!is_zero(problem.determinant)) {
    for (const Polynomial& factor : factors) {
      problem.determinant = scaled_quotient(std::move(problem.determinant), factor);
    }
  }
  if (problem.determinant.front().sign() == 0) {
    Instant start(Dyadic{0, 0});
    if (const auto contact = contact_at(problem, start)) {
      on_contact(start, *contact, {bits_of_zero, bits_of_zero});
      return;
    }
  }
  bool found = false;
  // Returns true if later instants need no examination. \pre a time > 0 with D = 0
  const auto consider = [&](Instant& instant) {
    if (instant.is_above(latest)) return true;
    const auto contact = contact_at(problem, instant);
    if (!contact) return false;
    const BitInterval time =
        enclose(instant.guess(), 1, [&](std::uint64_t bits) { return instant.is_above(bits); });
    on_contact(instant, *contact, time);
    latest = time.upper;
    return found = true;
  };
  for (const Polynomial& event : events(problem)) visit_roots(event, consider);
  if (!found && problem.determinant.back().sign() == 0) {
    Instant end(Dyadic{1, 0});
    static_cast<void>(consider(end));
  }
}

Polynomial polynomial_of(const Form<BigInteger, 1>& form) { return {form.begin(), form.end()}; }

std::array<Polynomial, 3> polynomials_of(const MovingVector<BigInteger>& v) {
  return {polynomial_of(v[0]), polynomial_of(v[1]), polynomial_of(v[2])};
}

}  // namespace

std::optional<ExactImpact> first_impact(const Motion<BigInteger>& motion, std::uint64_t latest) {
  std::optional<ExactImpact> result;
  find_contacts({{motion.kind, polynomials_of(motion.r), polynomials_of(motion.p),
                  polynomials_of(motion.q), motion.unit},
                 {}},
                latest, [&](Instant& instant, const Contact& contact, const BitInterval& time) {
                  result = impact_at(instant, contact, time);
                });
  return result;
}

std::optional<BitInterval> first_contact(const PolynomialMotion& motion, std::uint64_t latest) {
  std::optional<BitInterval> result;
  find_contacts(motion, latest,
                [&](Instant&, const Contact&, const BitInterval& time) { result = time; });
  return result;
}

}  // namespace touchstone::fast::exact_stage
