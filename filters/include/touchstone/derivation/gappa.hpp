#pragma once

/// \file
/// An expression as a script for Gappa, the prover of bounds on rounding errors [daumas2010]
/// (Debian package `gappa`), as a check of the derivation that shares only the graph with it.
///
/// Gappa's operators `add_rel<p>`, `sub_rel<p>` and `mul_rel<p>` are the model of
/// rounding_model.hpp: the exact result times (1 + δ), |δ| ≤ 2^-p, without a least exponent. The
/// scripts rely on the theorem of rounding_model.hpp: there is one script for each vertex of the
/// weights. Where terms of an exact node cancel, its expanded value is a rule (`N -> …`), because
/// Gappa's intervals do not cancel; Gappa checks these rules and warns if one is no identity.
///
/// Gappa identifies operations on the same operands and gives them the same δ. Operations that
/// become equal only at a vertex (a·w0 and a·w2 if both weights are 1) really have different
/// errors. Therefore computed values use one variable for each weight, whose range is a single
/// number; exact values use the number. A product with a weight that is 0 is also a separate
/// variable, of range 0, and operations that only it depends on are left out.
///
/// **Equivalent vertices.** Most vertices make the same statement about other coordinates: at t=1
/// the statement that they make at t=0 about the points there. Inputs and operations are numbered
/// in the order of a traversal from the result down, and a zero is the second operand of its sum.
/// So equivalent vertices have scripts with the same text, which Gappa runs once.
///
/// In this model a bound c for coordinates up to 1 implies the bound c x^k for coordinates up to
/// any x, where k is the degree of the expression: scaling all of them by s scales every value and
/// every error by s^k.

#include <gmpxx.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "touchstone/derivation/expression_graph.hpp"
#include "touchstone/derivation/rounding_model.hpp"

namespace touchstone::filters {

/// The part of a bound that is to be proved.
enum class GappaGoal : std::uint8_t {
  /// |computed − exact| for coordinates up to 1, without underflow: the last coefficient.
  rounding,
  /// The error that underflows of products add, in units of η (rounding_model.hpp): coefficient 0.
  /// Only for expressions of degree 1, whose value is linear in coordinates and underflows, so that
  /// the two parts are proved separately.
  underflow
};

/// Gappa cannot be run.
class GappaMissing : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Gappa's answer to a script.
struct GappaAnswer {
  bool proved = false;             ///< the goal is proved, or a bound was found
  std::optional<mpq_class> bound;  ///< the bound found, if one was requested
  std::string output;              ///< its output
};

/// The script for the goal at one vertex of the weights.
/// \param weights of the vertex: one of graph.weight_vertices()
/// \param bound to be proved; without it Gappa searches for the best one.
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

/// The limit of processor time of a script. The scripts of the catalogue take seconds.
inline constexpr std::chrono::seconds gappa_time_limit{600};

/// Runs Gappa, found through PATH, on a script. It is terminated without a proof after `limit` of
/// processor time, at least a second.
/// \throws GappaMissing if it is not installed, std::runtime_error if it cannot be run or ends by a
/// signal.
[[nodiscard]] GappaAnswer run_gappa(const std::string& script,
                                    std::chrono::seconds limit = gappa_time_limit);

/// The greatest bound that Gappa finds over all vertices; empty if it finds none at one of them.
/// \throws as gappa_script and run_gappa do.
[[nodiscard]] std::optional<mpq_class> gappa_bound(const ExpressionGraph& graph,
                                                   const Format& format, GappaGoal goal);

/// True if Gappa proves the bound at every vertex.
/// \throws as gappa_script and run_gappa do.
[[nodiscard]] bool gappa_proves(const ExpressionGraph& graph, const Format& format, GappaGoal goal,
                                const mpq_class& bound);

}  // namespace touchstone::filters
