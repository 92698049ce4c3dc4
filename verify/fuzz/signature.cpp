#include "verify/fuzz/signature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "verify/fuzz/plainness.hpp"
#include "verify/fuzz/recheck.hpp"

namespace touchstone::verify::fuzz {
namespace {

/// Binary exponents of the greatest coordinate to ask at: close to 1 each, then fewer.
constexpr std::array scales_to_ask{-40, -30, -24, -20, -17, -14, -12, -10, -8, -7, -6,
                                   -5,  -4,  -3,  -2,  -1,  0,   1,   2,   3,  4,  5,
                                   6,   7,   8,   10,  12,  14,  17,  20,  24, 30, 40};

/// True if it has a reason that tells one fault from another.
bool has_reason(judge::Fault what) {
  return what == judge::Fault::crash || what == judge::Fault::exit ||
         what == judge::Fault::exception;
}

void add_end(const std::optional<int>& exponent, ScaleEnds& all) {
  if (!exponent) return;
  const bool is_below = *exponent < least_everyday;
  const bool is_above = *exponent > greatest_everyday;
  all.below_everyday = all.below_everyday || is_below;
  all.above_everyday = all.above_everyday || is_above;
  all.everyday = all.everyday || (!is_below && !is_above);
}

ContactTime time_of(const FailingCase& failing) {
  if (!failing.toi) return ContactTime::never;
  if (failing.toi->upper == 0.0) return ContactTime::at_start;
  return failing.toi->lower == 1.0 ? ContactTime::at_end : ContactTime::between;
}

Shape shape_of(const AnyQuery& query) {
  if (collapsed_elements(query) != 0) return Shape::collapsed;
  return degeneracy(query) != 0 ? Shape::coplanar : Shape::general;
}

}  // namespace

int least_scale(double tolerance) {
  constexpr int margin = 4;
  // In this form NaN and 0 fail, too.
  if (!(tolerance > 0x1p-44)) return scales_to_ask.front();
  return std::min(std::ilogb(tolerance) + margin, 0);
}

ScaleRange scale_range(const fast::Method& method, const FuzzOptions& options,
                       const base::Deadline& deadline, const Finding& finding) {
  if (finding.what == judge::Fault::hang || !is_zero(finding.separation)) return {};
  const AnyQuery& query = finding.simplest.query;
  const int exponent = size_exponent(query), least = least_scale(options.method.tolerance);
  Recheck recheck(method, finding, options);
  const auto is_right_at = [&](int scale) {
    AnyQuery scaled = query;
    for_each_coordinate(scaled, point_axes,
                        [&](double& x) { x = std::ldexp(x, scale - exponent); });
    // A missing answer at the deadline proves nothing.
    return !recheck.ask(scaled, deadline) && !deadline.is_over();
  };
  ScaleRange result;
  const std::vector<int> downwards(scales_to_ask.rbegin(), scales_to_ask.rend());
  for (const int scale : downwards) {
    if (result.end_below || scale < least) break;
    if (scale < exponent && is_right_at(scale)) result.end_below = scale;
  }
  for (const int scale : scales_to_ask) {
    if (scale <= exponent || !is_right_at(scale)) continue;
    result.end_above = scale;
    break;
  }
  return result;
}

Signature signature_of(const Finding& finding) {
  const FailingCase& simplest = finding.simplest;
  Signature result{.method = finding.method, .what = finding.what, .is_slight = finding.is_slight};
  if (has_reason(finding.what)) result.reason = simplest.detail;
  add_end(finding.scales.end_below, result.ends);
  add_end(finding.scales.end_above, result.ends);
  if (result.ends.any()) return result;
  result.kind = finding.kind();
  // The query of a hang is not simplified, and gives no hint of the cause.
  if (finding.what == judge::Fault::hang) return result;
  result.shape = shape_of(simplest.query);
  result.is_on_curves = !simplest.query.shape().is_straight();
  result.time = time_of(simplest);
  return result;
}

std::string to_text(const ScaleEnds& scales) {
  if (!scales.any()) return "any scale";
  std::string text;
  const auto add = [&text](bool is_there, const char* words) {
    if (is_there) text += (text.empty() ? "ends " : " and ") + std::string(words);
  };
  add(scales.below_everyday, "below 2^-10");
  add(scales.everyday, "near 1");
  add(scales.above_everyday, "above 2^10");
  return text;
}

std::string to_text(const std::optional<ContactTime>& time) {
  static constexpr std::array<const char*, 4> names{"none", "t=0", "between", "t=1"};
  return time ? names.at(static_cast<std::size_t>(*time)) : "any";
}

std::string to_text(const std::optional<Shape>& shape) {
  static constexpr std::array<const char*, 3> names{"general", "coplanar", "collapsed"};
  return shape ? names.at(static_cast<std::size_t>(*shape)) : "any";
}

}  // namespace touchstone::verify::fuzz
