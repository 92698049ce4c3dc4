#include "touchstone/oracle.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "exact/contact/contact_conditions.hpp"
#include "exact/contact/contact_oracle.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/distance/separating_axes.hpp"

namespace touchstone::exact {
namespace {

/// The first time at which the volume V of a tetrahedron is not positive. (The corners of a vertex
/// a and a face b, c, d are a − b, a − c, a − d, whose determinant is −6 V.)
/// \tparam Cell Query or CurvedQuery
template <class Cell>
std::optional<AlgebraicNumber> first_inversion_of(const Cell& tetrahedron) {
  const auto volume = -determinant(scale(ContactKind::vertex_face, tetrahedron));
  if (sgn(volume.c.front()) <= 0) return AlgebraicNumber(0);
  if (std::ranges::all_of(volume.c, [](const Integer& c) { return sgn(c) > 0; })) return {};
  std::vector<AlgebraicNumber> roots = roots_in_unit_interval(to_polynomial(volume));
  if (roots.empty()) return {};
  return std::move(roots.front());
}

/// The first time at which the query comes within the motion's distance d: P(t) = conv{w_i(t)}, the
/// image of F(t,·,·), has a point x with ‖x‖ ≤ d. At every earlier time some axis separates. The
/// first time at which none does is checked by the conditions of a contact, which do not depend on
/// axes (docs/theory.md, section 3).
/// \throws std::logic_error if the two disagree, that is if the oracle is wrong.
template <class Order>
std::optional<AlgebraicNumber> time_within_distance(const MotionOf<Order>& motion) {
  std::optional<AlgebraicNumber> toi = end_of_separation(motion);
  if (toi && !find_near_contact(motion, *toi)) {
    throw std::logic_error("touchstone: no point is within the distance where the axes end");
  }
  return toi;
}

/// \tparam AnyQuery Query or CurvedQuery
template <class AnyQuery>
Decision decide_any(ContactKind kind, const AnyQuery& query, const Separation& separation) {
  Decision decision;
  const auto motion = scale(decided_as(kind), decided_query(kind, query), separation);
  if (is_zero(separation)) {
    decision = decide_contact(motion);
  } else {
    decision.toi = time_within_distance(motion);
  }
  decision.separation = separation;
  return decision;
}

/// The result of a decision about query i, which an error names.
template <class Decide>
auto at_place(std::size_t i, const Decide& decide) try {
  return decide();
} catch (const std::domain_error& error) {
  throw std::domain_error("query " + std::to_string(i) + ": " + error.what());
}

}  // namespace

Decision decide(ContactKind kind, const Query& query, const Separation& separation) {
  return decide_any(kind, query, separation);
}

Decision decide(ContactKind kind, const CurvedQuery& query, const Separation& separation) {
  return decide_any(kind, query, separation);
}

Decision decide(const Queries& queries, std::size_t i, const Separation& separation) {
  return at_place(i, [&] {
    if (queries.is_straight()) return decide(queries.kind, queries.straight()[i], separation);
    return decide(queries.kind, to_curved(queries, i), separation);
  });
}

std::vector<Decision> decide(const Queries& queries, const Separation& separation) {
  std::vector<Decision> decisions;
  decisions.reserve(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    decisions.push_back(decide(queries, i, separation));
  }
  return decisions;
}

std::optional<AlgebraicNumber> first_inversion(CellKind kind, const Query& cell) {
  return first_inversion_of(to_tetrahedron(kind, cell));
}

std::optional<AlgebraicNumber> first_inversion(CellKind kind, const CurvedQuery& cell) {
  return first_inversion_of(to_tetrahedron(kind, cell));
}

std::optional<AlgebraicNumber> first_inversion(const Cells& cells, std::size_t i) {
  return at_place(i, [&] {
    if (cells.is_straight()) return first_inversion(cells.kind, cells.straight()[i]);
    return first_inversion(cells.kind, to_curved(cells, i));
  });
}

ContactParameters contact_parameters(const Decision& decision, const Rational& width) {
  if (!decision.contact) throw std::invalid_argument("the place of contact is not known");
  const auto& [u, v, denominator] = *decision.contact;
  return {enclose_quotient(u, denominator, *decision.toi, width),
          enclose_quotient(v, denominator, *decision.toi, width)};
}

}  // namespace touchstone::exact
