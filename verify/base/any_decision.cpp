#include "verify/base/any_decision.hpp"

#include <stdexcept>
#include <vector>

#include "touchstone/inversion.hpp"

namespace touchstone::verify::base {

exact::Decision decide(const AnyQueries& queries, std::size_t i, const Separation& separation) {
  if (!queries.kind.is_cell()) {
    return exact::decide(queries.as(queries.kind.contact()), i, separation);
  }
  if (!is_zero(separation)) throw std::invalid_argument("a cell has no separation");
  return {.separation = separation,
          .toi = exact::first_inversion(queries.as(queries.kind.cell()), i)};
}

exact::Certificate prove(const AnyQueries& queries, std::size_t i, const exact::Decision& decision,
                         const exact::ProveOptions& options) {
  if (!queries.kind.is_cell()) {
    return exact::prove(queries.as(queries.kind.contact()), i, decision, options);
  }
  return exact::prove_inversion(queries.as(queries.kind.cell()), i, decision.toi, options);
}

void solve(const AnyQueries& queries, std::span<fast::CertifiedResult> results,
           const fast::CertifiedOptions& options) {
  if (!queries.kind.is_cell()) {
    return fast::solve(queries.as(queries.kind.contact()), results, options);
  }
  std::vector<fast::Inversion> found(queries.size());
  fast::inversions(queries.as(queries.kind.cell()), found,
                   {.toi_tolerance = options.toi_tolerance,
                    .t_max = options.t_max,
                    .max_threads = options.max_threads});
  for (std::size_t i = 0; i < found.size(); ++i) {
    results[i] = {.verdict = found[i].verdict,
                  .is_exact = found[i].is_exact,
                  .toi_lower = found[i].toi_lower,
                  .toi_upper = found[i].toi_upper};
  }
}

}  // namespace touchstone::verify::base
