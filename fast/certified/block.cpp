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

CertifiedResult decided_exactly(Kind kind, const Query& query, const CertifiedOptions& options) {
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

void decide_elements(KernelInput block, double t_limit, const CertifiedOptions& options,
                     const CertifiedKernel& kernel,
                     const std::function<Query(std::size_t)>& tetrahedron,
                     const std::function<void(std::size_t, const CertifiedResult&)>& report) {
  const KernelOutput& output = run_kernel(block, t_limit, options, kernel, tetrahedron);
  for (std::size_t i = 0; i < output.one_sided.count; ++i) {
    report(output.one_sided.items[i],
           {.verdict = Verdict::yes, .start = -1, .toi_lower = 0.0, .toi_upper = 0.0});
  }
  report_contacts(
      output, options,
      [&](std::size_t index) {
        const Query element = tetrahedron(index);
        CertifiedResult result{.is_exact = true};
        if (!is_finite(element)) return result;
        const ExactInversion found =
            decide_inversion_exactly(element, options.t_max, block.kept_volume);
        result.verdict = found.inverts ? Verdict::yes : Verdict::no;
        result.start = static_cast<std::int8_t>(found.start);
        if (!found.inverts) return result;
        result.toi_lower = found.toi_lower;
        result.toi_upper = found.toi_upper;
        return result;
      },
      [&](std::size_t index, CertifiedResult result) {
        if (!result.is_exact) result.start = 1;
        result.u = result.v = no_number;
        report(index, result);
      });
}

double limit_after(double toi_upper, double tolerance) {
  // The lower end of an enclosure is above the upper end times (1 − tolerance − 2^-52).
  constexpr double far_from_subnormal = 0x1p-900;
  if (tolerance > 0.5) return 1.0;
  const double limit = toi_upper / (1.0 - tolerance) * (1.0 + 0x1p-50);
  return std::clamp(limit, far_from_subnormal, 1.0);
}

}  // namespace touchstone::fast
