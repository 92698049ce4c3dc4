#pragma once

/// \file
/// The oracle: an exact decision if and when a query collides.
///
/// \code{.cpp}
/// // A vertex falls through a resting triangle, once on a straight line and once on a parabola.
/// #include <touchstone/oracle.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   // v, f0, f1, f2 at t=0, then at t=1.
///   const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,
///                      1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
///   const exact::Decision decision = exact::decide(ContactKind::vertex_face, query);
///   if (!decision.collides()) return 1;
///   const auto [u, v] = exact::contact_parameters(decision, exact::power_of_two(-60));
///   std::printf("at exactly 1/3: %d, at u = 1/4: %d\n", *decision.toi == exact::Rational(1, 3),
///               u.lower == exact::Rational(1, 4));
///
///   // The control points of Bezier curves; resting points have one.
///   const CurvedQuery curved{{{.control = {{1, 1, 1}, {1, 1, -1}, {1, 1, 1}}},
///                             {.control = {{0, 0, 0}}},
///                             {.control = {{4, 0, 0}}},
///                             {.control = {{0, 4, 0}}}}};
///   const exact::Decision touch = exact::decide(ContactKind::vertex_face, curved);
///   std::printf("at exactly 1/2: %d\n", *touch.toi == exact::Rational(1, 2));
/// }
/// // at exactly 1/3: 1, at u = 1/4: 1
/// // at exactly 1/2: 1
/// \endcode
///
/// At distance 0 the rules of exact/contact/contact_oracle.hpp decide, which also give the place of
/// contact; at a greater distance those of exact/distance/separating_axes.hpp. Both are integer
/// arithmetic on scaled coordinates, without rounding and without filters. docs/theory.md, sections
/// 2, 3 and 10. All functions are thread-safe.
///
/// **Cells.** *Theorem.* Let V be the signed volume (touchstone/cell.hpp), a continuous
/// function of time. If V(0) ≤ 0, the first time with V ≤ 0 is 0. Otherwise it is the least root of
/// V in [0,1], and there is none if V has no root there. Proof. Before its least root a continuous
/// function has the sign that it has at 0. ∎
///
/// On straight lines V is a polynomial of degree 3 (2 for triangles); on curves of degree k, of
/// degree 3k, divided by a polynomial that is positive on [0,1]. Roots of every multiplicity count.

#include <cstddef>
#include <optional>
#include <vector>

#include "touchstone/algebraic_number.hpp"
#include "touchstone/cell.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/number.hpp"
#include "touchstone/polynomial.hpp"
#include "touchstone/query.hpp"

namespace touchstone::exact {

/// The place of contact: u = u_numerator(toi) / denominator(toi), likewise v, each a polynomial in
/// t of degree at most 2, 2k for curves of degree k. If the primitives have several common points,
/// it is one of them.
struct Contact {
  Polynomial u_numerator;
  Polynomial v_numerator;
  /// Positive at the toi.
  Polynomial denominator;
};

/// The truth about a query at a separation.
///
/// | the query             | toi   | contact |
/// |-----------------------|-------|---------|
/// | does not collide      | empty | empty   |
/// | collides, distance 0  | known | known   |
/// | collides, distance > 0 | known | empty   |
struct Decision {
  /// The separation that was asked for.
  Separation separation{};
  /// The exact time of impact, in [0,1]: an algebraic number, at distance 0 of degree at most 3,
  /// else of degree at most 8. Empty iff the query does not collide at the separation.
  std::optional<AlgebraicNumber> toi = std::nullopt;
  /// The place of contact at the toi; not computed for a distance above 0.
  std::optional<Contact> contact = std::nullopt;

  [[nodiscard]] bool collides() const { return toi.has_value(); }
};

/// Decides a query exactly, independent of the floating-point environment (rounding mode, flushed
/// subnormals).
/// \throws std::domain_error if a coordinate is NaN or infinite; std::invalid_argument if the
/// separation is not valid.
[[nodiscard]] Decision decide(ContactKind kind, const Query& query,
                              const Separation& separation = {});

/// Decides a query whose points move on curves. For curves of degrees up to k, polynomial or of the
/// same weights, the degree of the toi is at most 3k, or 8k with a separation; the degrees of
/// further weights are added to k.
/// \throws std::domain_error if a number is NaN or infinite, or a weight not positive;
/// std::invalid_argument if a trajectory or the separation is not valid.
[[nodiscard]] Decision decide(ContactKind kind, const CurvedQuery& query,
                              const Separation& separation = {});

/// Decides query i. \throws as above, the std::domain_error naming the query.
[[nodiscard]] Decision decide(const Queries& queries, std::size_t i,
                              const Separation& separation = {});

/// Decides all queries, in this thread. \throws as above.
[[nodiscard]] std::vector<Decision> decide(const Queries& queries,
                                           const Separation& separation = {});

/// The first time at which the volume of a cell is 0 or negative (touchstone/cell.hpp), 0 iff it is
/// so at t=0; empty iff the cell does not invert. On straight lines or curves, or of cell i.
/// \throws std::domain_error if a number that has an effect is NaN or infinite, or a weight not
/// positive; std::invalid_argument if a trajectory is not valid.
[[nodiscard]] std::optional<AlgebraicNumber> first_inversion(CellKind kind, const Query& cell);
[[nodiscard]] std::optional<AlgebraicNumber> first_inversion(CellKind kind,
                                                             const CurvedQuery& cell);
[[nodiscard]] std::optional<AlgebraicNumber> first_inversion(const Cells& cells, std::size_t i);

/// The parameters (u,v) of a contact, as the query's F defines them.
struct ContactParameters {
  RationalInterval u;
  RationalInterval v;
};

/// (u,v) of the earliest contact, each within `width` > 0; exact (both ends equal) where the toi is
/// known to be rational.
/// \throws std::invalid_argument if the decision has no contact, or the width is not positive.
[[nodiscard]] ContactParameters contact_parameters(const Decision& decision, const Rational& width);

}  // namespace touchstone::exact
