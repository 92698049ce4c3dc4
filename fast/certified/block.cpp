#include "fast/certified/block.hpp"

#include <cmath>
#include <stdexcept>

#include "fast/certified/exact/curved_polygon.hpp"
#include "touchstone/curved_query.hpp"

namespace touchstone::fast {

void require_valid(const CertifiedOptions& options) {
  // NaN fails, too.
  if (!(options.toi_tolerance >= 0.0 && std::isfinite(options.toi_tolerance))) {
    throw std::invalid_argument("certified: toi_tolerance must be finite and not negative");
  }
  if (!(options.t_max >= 0.0 && options.t_max <= 1.0)) {
    throw std::invalid_argument("certified: t_max must be in [0,1]");
  }
  if (!is_valid(options.separation)) {
    throw std::invalid_argument("certified: the separation must be finite and not negative");
  }
  if (options.max_threads < 0) {
    throw std::invalid_argument("certified: max_threads must not be negative");
  }
}

CertifiedResult result_of(const std::optional<ExactImpact>& impact) {
  if (!impact) return {.verdict = Verdict::no, .is_exact = true};
  return {.verdict = Verdict::yes,
          .is_exact = true,
          .toi_lower = impact->toi_lower,
          .toi_upper = impact->toi_upper,
          .u = impact->u,
          .v = impact->v};
}

CertifiedResult decided_exactly(ContactKind kind, const Query& query,
                                const CertifiedOptions& options) {
  if (!is_finite(query)) return {.verdict = Verdict::error, .is_exact = true};
  return result_of(
      decide_exactly(kind, query, options.separation, options.toi_tolerance, options.t_max));
}

CertifiedResult decided_exactly(const Queries& queries, std::size_t i,
                                const CertifiedOptions& options) {
  if (queries.is_straight()) return decided_exactly(queries.kind, queries.straight()[i], options);
  const CurvedQuery query = to_curved(queries, i);
  if (!exact_stage::is_valid(query)) return {.verdict = Verdict::error, .is_exact = true};
  return result_of(decide_exactly(queries.kind, query, options.separation, options.toi_tolerance,
                                  options.t_max));
}

std::optional<CertifiedResult> result_of(const KernelImpact& impact,
                                         const CertifiedOptions& options) {
  // (Where the time of impact is 0, both are.)
  if (impact.toi_lower >= options.t_max && impact.toi_upper > 0.0) {
    return CertifiedResult{.verdict = Verdict::no};
  }
  if (impact.toi_upper > options.t_max || options.toi_tolerance < least_kernel_tolerance) {
    return std::nullopt;
  }
  return CertifiedResult{.verdict = Verdict::yes,
                         .toi_lower = impact.toi_lower,
                         .toi_upper = impact.toi_upper,
                         .u = impact.u,
                         .v = impact.v};
}

double limit_after(double toi_upper, double tolerance) {
  // The lower end of an enclosure is above the upper end times (1 − tolerance − 2^-52).
  constexpr double far_from_subnormal = 0x1p-900;
  if (tolerance > 0.5) return 1.0;
  const double limit = toi_upper / (1.0 - tolerance) * (1.0 + 0x1p-50);
  return std::clamp(limit, far_from_subnormal, 1.0);
}

}  // namespace touchstone::fast
