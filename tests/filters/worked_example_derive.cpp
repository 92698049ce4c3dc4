// The worked example of filters/README.md: a program that derives a bound.

// README: the derivation
#include <cstdio>

#include "tests/filters/worked_example.hpp"
#include "touchstone/derivation/gappa.hpp"
#include "touchstone/derivation/shipped_bound.hpp"
#include "touchstone/derivation/worst_case.hpp"

using namespace touchstone::filters;

int main() {
  const ExpressionGraph graph = record<researcher::Orientation>();
  std::printf("%s", error_bound_declaration(graph, double_format).c_str());

  const mpq_class u = double_format.unit_roundoff();
  const DerivedBound bound = derive_bound(graph, double_format);
  const WorstCase worst = search_worst_case(graph, evaluators<researcher::Orientation>(),
                                            double_format, WorstCaseOptions{});
  const bool proved = gappa_proves(graph, double_format, GappaGoal::rounding,
                                   shipped_coefficients(bound, double_format).back());
  std::fprintf(stderr, "bound %g u, worst found %g u, %s by Gappa\n",
               mpq_class(bound.rounding() / u).get_d(), worst.units,
               proved ? "proved" : "not proved");
}
// README: end
