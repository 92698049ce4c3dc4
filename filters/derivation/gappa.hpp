#pragma once

/// \file
/// An expression as a script for Gappa, the prover of bounds on rounding errors [daumas2010] (Debian
/// package `gappa`), as a check of the derivation that shares nothing with it but the graph.
///
/// Gappa's operators `add_rel<p>`, `sub_rel<p>` and `mul_rel<p>` are the model of
/// rounding_model.hpp: the exact result times (1 + δ), |δ| ≤ 2^-p, without a least exponent. What a
/// script leaves to rounding_model.hpp is its theorem: there is a script for each vertex of the
/// weights. Where terms of an exact node cancel, its expanded value is a rule (`N -> …`),
/// because Gappa's intervals do not cancel; Gappa checks these rules and warns where one is no
/// identity.
///
/// Gappa takes operations on the same operands for the same value, with the same δ. Operations that
/// become equal only at a vertex (a·w0 and a·w2 where both weights are 1) have errors of their own
/// in truth. Therefore computed values use a variable a weight, of which only the range, one
/// number, is known; exact values use the number. A product with a weight that is 0 is a variable of
/// its own too, of range 0, and what only it depends on is left out.
///
/// **Vertices alike.** Most vertices say the same of other coordinates: at t=1 what at t=0 is said of
/// the points there. Inputs and operations have numbers in the order in which they are met from the
/// result down, and a zero is the second operand of its sum; so vertices that differ in nothing else
/// have scripts of one text, which Gappa is asked once.
///
/// In this model an expression of degree k that is c x^k wrong for coordinates up to 1 is so for
/// coordinates up to any x: scaling all of them by s scales every value and every error by s^k.

#include <gmpxx.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "filters/derivation/expression_graph.hpp"
#include "filters/derivation/rounding_model.hpp"

namespace touchstone::filters {

/// Which part of a bound is to be proved.
enum class GappaGoal : std::uint8_t {
  /// |computed − exact| for coordinates up to 1, without underflow: the last coefficient.
  rounding,
  /// The error that underflows of products add, in units of η (rounding_model.hpp): coefficient 0.
  /// Only for expressions of degree 1, whose value is linear in coordinates and underflows, so that
  /// the two parts are proved apart.
  underflow
};

/// Gappa cannot be run.
class GappaMissing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Gappa's answer to a script.
struct GappaAnswer {
  bool proved = false;             ///< the goal is proved, or the question has an answer
  std::optional<mpq_class> bound;  ///< the answer, if there was a question
  std::string output;              ///< all that it printed
};

/// The script that asks for the goal at one vertex of the weights.
/// \param weights of the vertex: one of graph.weight_vertices()
/// \param bound to be proved; without it Gappa is asked for the best that it finds.
/// \throws std::invalid_argument if the bound is no dyadic number, or the goal is `underflow` and
///         the expression's degree is not 1.
[[nodiscard]] std::string gappa_script(const ExpressionGraph& graph, const Format& format,
                                       GappaGoal goal, const std::vector<int>& weights,
                                       const std::optional<mpq_class>& bound = std::nullopt);

/// The scripts of all vertices, equal ones once.
/// \throws as gappa_script does.
[[nodiscard]] std::set<std::string> gappa_scripts(
    const ExpressionGraph& graph, const Format& format, GappaGoal goal,
    const std::optional<mpq_class>& bound = std::nullopt);

/// Processor time that a script may take. Those of the catalogue take seconds.
inline constexpr std::chrono::seconds gappa_time_limit{600};

/// Runs Gappa, found through PATH, on a script. It is ended, and has proved nothing, when it has
/// used `limit` of processor time, at least a second.
/// \throws GappaMissing if there is none, std::runtime_error if it cannot be run or is ended by a
///         signal.
[[nodiscard]] GappaAnswer run_gappa(const std::string& script,
                                    std::chrono::seconds limit = gappa_time_limit);

/// The greatest bound that Gappa finds over all vertices; nothing if it finds none at one of them.
/// \throws as gappa_script and run_gappa do.
[[nodiscard]] std::optional<mpq_class> gappa_bound(const ExpressionGraph& graph,
                                                   const Format& format, GappaGoal goal);

/// Does Gappa prove the bound at every vertex?
/// \throws as gappa_script and run_gappa do.
[[nodiscard]] bool gappa_proves(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
                                const mpq_class& bound);

}  // namespace touchstone::filters
