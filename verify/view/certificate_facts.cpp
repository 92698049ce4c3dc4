#include "verify/view/certificate_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "exact/checker/certificate.hpp"
#include "exact/checker/checker.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"

namespace touchstone::verify::view {
namespace {

checker::Certificate parsed(std::string_view stream) {
  std::istringstream lines{std::string(stream)};
  checker::Reader reader(lines);
  checker::Certificate certificate;
  try {
    reader.advance();
    if (!stream.starts_with(exact::certificates_header())) checker::reject("it is no certificate");
    reader.advance();
    checker::read_certificate(reader, certificate);
    if (certificate.query.kind == checker::Kind::tetrahedron) {
      checker::reject("a tetrahedron is no query that can be viewed");
    }
  } catch (const checker::Rejection& rejection) {
    throw std::invalid_argument(rejection.reason);
  }
  return certificate;
}

double as_double(const mpq_class& value, std::string_view name) {
  const double nearest = exact::round_to_nearest(value);
  if (!is_finite({&nearest, 1}) || exact::Rational(nearest) != value) {
    throw std::invalid_argument(fmt::format("{} is no double", name));
  }
  return nearest;
}

std::string_view axis_name(std::size_t axis) { return std::string_view("xyz").substr(axis, 1); }

/// The feature in the words of the certificate.
std::string feature_text(const checker::Subinterval& subinterval) {
  const char sign = subinterval.is_negative ? '-' : '+';
  switch (subinterval.feature) {
    case checker::Feature::vertex:
      return fmt::format("vertex {}", subinterval.corners[0]);
    case checker::Feature::edge:
      return fmt::format("edge {} {}", subinterval.corners[0], subinterval.corners[1]);
    case checker::Feature::face:
      return fmt::format("face {}", sign);
    case checker::Feature::axis:
      return fmt::format("axis {} {}", axis_name(subinterval.axis), sign);
    default:
      return fmt::format("cross {} {} {}", axis_name(subinterval.axis), subinterval.corners[0],
                         subinterval.corners[1]);
  }
}

std::string_view claim_text(checker::Claim claim) {
  switch (claim) {
    case checker::Claim::no_collision:
      return "no_collision";
    case checker::Claim::collision:
      return "collision";
    default:
      return "time_of_impact";
  }
}

bool is_straight(const checker::Curve& curve) {
  return curve.control.size() == 2 && curve.weights.empty();
}

Trajectory trajectory_of(const checker::Curve& curve) {
  Trajectory result;
  for (const checker::Point& point : curve.control) {
    std::array<double, 3>& control = result.control.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      control.at(axis) = as_double(point.at(axis), "a coordinate");
    }
  }
  for (const mpq_class& weight : curve.weights) {
    result.weights.push_back(as_double(weight, "a weight"));
  }
  return result;
}

OwnCurves curves_of(const checker::Query& query) {
  OwnCurves result{.kind = query.kind == checker::Kind::edge_edge ? Kind::edge_edge
                                                                  : Kind::vertex_face};
  std::ranges::transform(query.points, result.curves.begin(), trajectory_of);
  return result;
}

}  // namespace

ViewedQuery certified_query(std::string stream) {
  const checker::Certificate certificate = parsed(stream);
  ViewedQuery result{.label = checker::printable(certificate.label),
                     .query = curves_of(certificate.query)};
  if (std::ranges::all_of(certificate.query.points, is_straight)) {
    result.query = in_one_shape(result).value();
  }
  const auto& [distance, is_l2] = certificate.separation;
  result.separation = {.distance = as_double(distance, "the distance"),
                       .norm = is_l2 ? Norm::l2 : Norm::linf};
  result.certificate = std::move(stream);
  return result;
}

nlohmann::json certificate_facts(const std::string& stream) {
  const checker::Certificate certificate = parsed(stream);
  nlohmann::json subintervals = nlohmann::json::array();
  for (const checker::Subinterval& subinterval : certificate.subintervals) {
    subintervals.push_back({{"from", subinterval.from.get_str()},
                            {"to", subinterval.to.get_str()},
                            {"feature", feature_text(subinterval)}});
  }
  std::istringstream lines(stream);
  const checker::Report report = checker::check(lines);
  return {{"claim", claim_text(certificate.claim)},
          {"accepted", report.all_accepted()},
          {"reason", report.rejections.empty() ? "" : report.rejections.front().reason},
          {"subintervals", subintervals},
          {"text", stream}};
}

}  // namespace touchstone::verify::view
