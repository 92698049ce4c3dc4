#include "verify/judge/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "touchstone/certified.hpp"
#include "verify/base/any_decision.hpp"

namespace touchstone::verify::judge {
namespace {

double nearest_float(double x) {
  constexpr auto greatest = static_cast<double>(std::numeric_limits<float>::max());
  // A conversion beyond the range of float is undefined.
  if (std::abs(x) > greatest) return std::copysign(std::numeric_limits<double>::infinity(), x);
  return static_cast<double>(static_cast<float>(x));
}

/// The distance at t=0, where each point is its first control point, is that at all times of a
/// query that does not move; so is the sign of a cell's volume.
bool starts_within(const AnyQueries& query, Separation distance) {
  Query at_rest{};
  for (std::size_t i = 0; i < at_rest.coordinates.size(); ++i) {
    const std::size_t point = i / 3 % moving_points;
    at_rest.coordinates[i] = query.numbers[point * query.numbers_of_point() + i % 3];
  }
  fast::CertifiedResult result;
  base::solve({query.kind, {&at_rest, 1}}, {&result, 1}, {.separation = distance});
  return result.verdict == fast::Verdict::yes;
}

/// The kinds that it answers; empty if those are all about contact, and perhaps others.
std::string other_kinds(const fast::Terms& terms, std::string_view separator) {
  std::string text;
  if (std::ranges::all_of(contact_kinds, [&](AnyKind kind) { return terms.answers(kind); }))
    return {};
  for (const AnyKind kind : all_kinds) {
    if (!terms.answers(kind)) continue;
    text += text.empty() ? "" : separator;
    text += to_string(kind);
  }
  return text;
}

}  // namespace

bool select_queries(const fast::Terms& terms, const AnyShape& shape) {
  return !terms.answers(shape) || terms.starts_apart || terms.float_coordinates;
}

base::AnyQuery as_asked(const fast::Terms& terms, base::AnyQuery query) {
  if (terms.float_coordinates) {
    std::ranges::transform(query.numbers(), query.numbers().begin(), nearest_float);
  }
  return query;
}

bool admits(const fast::Terms& terms, const base::AnyQuery& query, const Separation& separation) {
  if (!terms.answers(query.shape())) return false;
  const bool is_finite = touchstone::is_finite(query.numbers());
  if (terms.float_coordinates && !(is_finite && as_asked(terms, query) == query)) return false;
  if (!terms.starts_apart || !is_finite) return true;
  if (query.kind().is_cell()) return !starts_within(query.queries(), {});
  return !starts_within(query.queries(),
                        {separation.distance + *terms.starts_apart, separation.norm});
}

std::string to_text(const fast::Terms& terms) {
  std::string text;
  if (const std::string kinds = other_kinds(terms, " and "); !kinds.empty()) {
    text += ", " + kinds + " alone";
  }
  if (terms.starts_apart) {
    text += *terms.starts_apart == 0.0 ? ", starts apart"
                                       : fmt::format(", starts apart by {}", *terms.starts_apart);
  }
  if (terms.float_coordinates) text += ", float coordinates";
  if (terms.times == fast::Times::none) text += ", without times";
  if (terms.times == fast::Times::estimates) {
    text += fmt::format(", times are estimates to {}", terms.time_error);
  }
  return text;
}

std::string as_options(const fast::Terms& terms) {
  std::string words = other_kinds(terms, " --answers-kinds ");
  if (!words.empty()) words.insert(0, " --answers-kinds ");
  if (terms.starts_apart) words += fmt::format(" --starts-apart={}", *terms.starts_apart);
  if (terms.float_coordinates) words += " --float-coordinates";
  if (terms.times == fast::Times::none) words += " --times none";
  if (terms.times == fast::Times::estimates) {
    words += fmt::format(" --times estimates --time-error {}", terms.time_error);
  }
  return words;
}

}  // namespace touchstone::verify::judge
