#include "verify/jobs/certify_curves.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/curved.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/thread_clock.hpp"

namespace touchstone::verify::jobs {
namespace {

/// So many queries at a time: progress and stops are felt.
constexpr std::size_t block_size = 4096;

/// Bits of a time of impact before it is rounded.
constexpr unsigned long precision = 64;

/// What is found of one query.
struct Finding {
  bool collides = false;
  bool is_wrong = false;
  double toi = fast::no_number;
  std::string certificate;
  bool is_beyond_limits = false;
  double seconds = 0.0;
};

bool is_right(const fast::CertifiedResult& found, const exact::Decision& truth) {
  if ((found.verdict == fast::Verdict::yes) != truth.collides() ||
      (found.verdict == fast::Verdict::no) == truth.collides()) {
    return false;
  }
  if (!truth.collides()) return true;
  if (*truth.toi == exact::Rational(0)) return found.toi_lower == 0.0;
  return exact::Rational(found.toi_lower) < *truth.toi &&
         exact::Rational(found.toi_upper) >= *truth.toi;
}

Finding finding_of(Kind kind, const CurvedQueries& queries, std::size_t i,
                   const fast::CertifiedResult& found, const CurvedOptions& options) {
  Finding result;
  const CurvedQuery query = queries.query(i);
  const double begin = base::thread_nanoseconds();
  const exact::Decision truth = exact::decide(kind, query, options.separation);
  result.seconds = (base::thread_nanoseconds() - begin) * 1e-9;
  result.collides = truth.collides();
  result.is_wrong = !is_right(found, truth);
  if (truth.collides()) {
    exact::AlgebraicNumber toi = *truth.toi;
    toi.refine_to_level(precision);
    result.toi = exact::round_to_nearest(toi.interval().upper);
  }
  if (!options.prove) return result;
  try {
    exact::write(result.certificate, exact::prove(kind, query, truth),
                 options.label + std::to_string(i));
  } catch (const exact::CertificateLimitError&) {
    result.is_beyond_limits = true;
  }
  return result;
}

}  // namespace

CurvedResult certify_curves(Kind kind, const CurvedQueries& queries, const CurvedOptions& options) {
  CurvedResult sum;
  const int threads = base::cores_for(options.threads);
  tbb::task_arena arena(threads);
  std::vector<fast::CertifiedResult> found;
  std::vector<Finding> findings;
  for (std::size_t first = 0; first < queries.size(); first += block_size) {
    if (options.stop != nullptr && *options.stop) break;
    const std::size_t count = std::min(block_size, queries.size() - first);
    found.assign(count, {});
    findings.assign(count, {});
    CurvedQueries block = queries;
    block.numbers = queries.numbers.subspan(first * queries.numbers_of_query(),
                                            count * queries.numbers_of_query());
    const double begin = base::thread_nanoseconds();
    fast::solve(kind, block, found, {.separation = options.separation, .max_threads = 1});
    sum.certified_seconds += (base::thread_nanoseconds() - begin) * 1e-9;
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        findings[i] = finding_of(kind, queries, first + i, found[i], options);
      });
    });
    std::string certificates;
    for (std::size_t i = 0; i < count; ++i) {
      const Finding& one = findings[i];
      ++sum.queries;
      if (one.collides) ++sum.collide;
      if (one.is_wrong) sum.wrong.push_back(first + i);
      ++sum.decided_by.at(static_cast<std::size_t>(found[i].stage));
      if (!one.certificate.empty()) ++sum.certificates;
      if (one.is_beyond_limits) ++sum.beyond_limits;
      sum.oracle_seconds += one.seconds;
      sum.toi.push_back(one.toi);
      certificates += one.certificate;
    }
    if (options.on_certificates && !certificates.empty()) options.on_certificates(certificates);
    if (options.on_progress) {
      options.on_progress(static_cast<double>(sum.queries) / static_cast<double>(queries.size()));
    }
  }
  return sum;
}

}  // namespace touchstone::verify::jobs
