#include "verify/view/query_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "exact/checker/certificate.hpp"
#include "exact/checker/checker.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/terms.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::view {
namespace {

/// The bits to which irrational times and places are given.
constexpr unsigned long time_bits = 256;

nlohmann::json number(double value) {
  if (std::isnan(value)) return {};
  if (std::isinf(value)) return value > 0.0 ? "Infinity" : "-Infinity";
  std::string text;
  exact::write_hexadecimal(text, value);
  return text;
}

/// Doubles around an interval, and the number itself where it is one.
nlohmann::json enclosure(const exact::RationalInterval& interval) {
  return {{"lower", number(exact::round_down(interval.lower))},
          {"upper", number(exact::round_up(interval.upper))},
          {"exact", interval.lower == interval.upper ? nlohmann::json(interval.lower.get_str())
                                                     : nlohmann::json()}};
}

/// A time to look at: the number itself where it is known to be rational, else one within 2^-256 of
/// it.
exact::Rational time_near(exact::AlgebraicNumber number) {
  if (!number.rational()) number.refine_to_level(time_bits);
  if (number.rational()) return *number.rational();
  const exact::RationalInterval interval = number.interval();
  return (interval.lower + interval.upper) / 2;
}

nlohmann::json moment(const exact::AlgebraicNumber& number_in_time) {
  const exact::DoubleInterval doubles = number_in_time.enclosure();
  const exact::Rational near = time_near(number_in_time);
  const bool is_exact = number_in_time == near;
  return {{"lower", number(doubles.lower)},
          {"upper", number(doubles.upper)},
          {"exact", is_exact ? nlohmann::json(near.get_str()) : nlohmann::json()},
          {"time", near.get_str()}};
}

nlohmann::json numbers(std::span<const double> values) {
  nlohmann::json texts = nlohmann::json::array();
  for (const double value : values) texts.push_back(number(value));
  return texts;
}

// ---- The points ---------------------------------------------------------------------------------

/// Adds `coordinates`; for curves `control`, and `weights` if they are rational.
void add_points(const base::AnyQuery& query, nlohmann::json& facts) {
  const AnyShape& shape = query.shape();
  if (shape.is_straight()) {
    facts["coordinates"] = numbers(query.numbers());
    return;
  }
  const std::size_t size = shape.numbers_of_point();
  for (std::size_t i = 0; i < query.numbers().size() / size; ++i) {
    const auto point = query.numbers().subspan(size * i, size);
    facts["control"][i / moving_points].push_back(numbers(point.first(3)));
    if (shape.is_rational) facts["weights"][i / moving_points].push_back(number(point[3]));
  }
}

// ---- The truth ----------------------------------------------------------------------------------

nlohmann::json truth_facts(const exact::Decision& verdict) {
  nlohmann::json truth{{"collides", verdict.collides()},
                       {"text", judge::to_text(judge::truth_of(0, verdict))}};
  if (!verdict.toi) return truth;
  truth["toi"] = moment(*verdict.toi);
  std::ostringstream polynomial;
  polynomial << verdict.toi->polynomial();
  truth["toi"]["polynomial"] = polynomial.str();
  if (!verdict.contact) return truth;
  const exact::ContactParameters place =
      exact::contact_parameters(verdict, exact::power_of_two(-static_cast<long>(time_bits)));
  truth["u"] = enclosure(place.u);
  truth["v"] = enclosure(place.v);
  return truth;
}

nlohmann::json approach_facts(const ViewedQuery& viewed) {
  if (!viewed.with_approach || !viewed.query.shape().is_straight()) return {};
  const auto approach = nearest_approach(viewed.query.kind().contact(), viewed.query.straight());
  if (!approach) return {};
  nlohmann::json facts = moment(approach->time);
  facts["above"] = number(approach->above);
  facts["at_most"] = number(approach->at_most);
  return facts;
}

/// The oracle's own certificate. \return nothing where it is beyond the format's limits
std::string proof_of(const ViewedQuery& viewed, const exact::Decision& verdict) {
  try {
    return exact::certificate_stream(base::prove(viewed.query.queries(), 0, verdict),
                                     io::printable(viewed.label));
  } catch (const exact::CertificateLimitError&) {
    return {};
  }
}

nlohmann::json certificate_of(const ViewedQuery& viewed, const exact::Decision& verdict) {
  const bool is_given = !viewed.certificate.empty();
  const std::string stream = is_given ? viewed.certificate : proof_of(viewed, verdict);
  if (stream.empty()) return {};
  nlohmann::json facts = certificate_facts(stream);
  facts["given"] = is_given;
  return facts;
}

// ---- Solvers ------------------------------------------------------------------------------------

/// The query with its truth.
struct Judged {
  const ViewedQuery& viewed;
  judge::GroundTruth truth;
};

std::vector<judge::Fault> faults_of(const judge::GivenAnswer& given,
                                    const judge::Standard& standard, const Judged& judged) {
  const ViewedQuery& viewed = judged.viewed;
  const judge::Failure* const failure = given.failure ? &*given.failure : nullptr;
  const base::AnyQuery asked = judge::as_asked(standard.terms, viewed.query);
  const judge::Question question{asked.queries(), viewed.separation};
  const judge::GroundTruth truth =
      asked == viewed.query
          ? judged.truth
          : judge::truth_of(0, base::decide(question.query, 0, viewed.separation));
  return judge::judge(question, truth, given.answer, standard, failure);
}

/// An answer, and the judgement on it.
nlohmann::json answer_facts(const judge::GivenAnswer& given, const judge::Standard& standard,
                            bool is_recorded, const Judged& judged) {
  nlohmann::json faults = nlohmann::json::array();
  bool is_broken = false;
  for (const judge::Fault fault : faults_of(given, standard, judged)) {
    is_broken = is_broken || judge::breaks(fault, standard.promise);
    // A failure that is no error has a text of its own below.
    if (fault == judge::Fault::hang || fault == judge::Fault::undecided) continue;
    faults.push_back(judge::to_text(fault));
  }
  const auto failure = given.failure ? given.failure : judge::failure_of(given.answer);
  return {{"solver", io::printable(given.solver)},
          {"promise", solvers::to_string(standard.promise)},
          {"recorded", is_recorded},
          {"verdict", judge::to_string(given.answer.verdict)},
          {"failure", failure ? judge::to_text(*failure) : ""},
          {"toi_lower", number(given.answer.toi_lower)},
          {"toi_upper", number(given.answer.toi_upper)},
          {"tolerance", number(given.answer.tolerance)},
          {"faults", faults},
          {"breaks_promise", is_broken}};
}

/// The standard of a solver by its name: it promises nothing where it is not known.
judge::Standard standard_of(const std::string& solver) {
  const fast::MethodInfo* info = solvers::find_info(solver);
  return info == nullptr ? judge::Standard{.promise = fast::Promise::none}
                         : judge::standard_of(*info);
}

nlohmann::json answers_of(const Judged& judged, std::span<const judge::GivenAnswer> asked) {
  nlohmann::json answers = nlohmann::json::array();
  const auto add = [&](const judge::GivenAnswer& given, bool is_recorded) {
    const judge::Standard standard = given.standard.value_or(standard_of(given.solver));
    answers.push_back(answer_facts(given, standard, is_recorded, judged));
  };
  for (const judge::GivenAnswer& given : judged.viewed.answers) add(given, true);
  for (const judge::GivenAnswer& given : asked) add(given, false);
  return answers;
}

}  // namespace

nlohmann::json query_facts(const ViewedQuery& viewed, std::span<const judge::GivenAnswer> asked) {
  const exact::Decision verdict = base::decide(viewed.query.queries(), 0, viewed.separation);
  nlohmann::json notes = nlohmann::json::array();
  for (const std::string& note : viewed.notes) notes.push_back(io::printable(note));
  nlohmann::json facts{
      {"label", io::printable(viewed.label)},
      {"kind", to_string(viewed.query.kind())},
      {"min_separation", number(viewed.separation.distance)},
      {"norm", to_string(viewed.separation.norm)},
      {"notes", notes},
      {"truth", truth_facts(verdict)},
      {"approach", approach_facts(viewed)},
      {"certificate", certificate_of(viewed, verdict)},
      {"answers", answers_of({.viewed = viewed, .truth = judge::truth_of(0, verdict)}, asked)}};
  add_points(viewed.query, facts);
  return facts;
}

namespace {

/// Doubles that are not negative are in the order of their bits.
std::uint64_t bits_of(double distance) { return std::bit_cast<std::uint64_t>(distance); }
double distance_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }

exact::Decision at_distance(ContactKind kind, const Query& query, std::uint64_t bits) {
  return exact::decide(kind, query, {.distance = distance_of(bits), .norm = Norm::l2});
}

}  // namespace

std::optional<NearestApproach> nearest_approach(ContactKind kind, const Query& query) {
  if (exact::decide(kind, query).collides()) return std::nullopt;
  std::uint64_t above = 0;
  std::uint64_t at_most = bits_of(std::numeric_limits<double>::max());
  exact::Decision verdict = at_distance(kind, query, at_most);
  if (!verdict.collides()) return std::nullopt;
  while (at_most - above > 1) {
    const std::uint64_t middle = above + (at_most - above) / 2;
    exact::Decision answer = at_distance(kind, query, middle);
    (answer.collides() ? at_most : above) = middle;
    if (answer.collides()) verdict = std::move(answer);
  }
  return NearestApproach{
      .above = distance_of(above), .at_most = distance_of(at_most), .time = *verdict.toi};
}

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

AnyKind kind_of(checker::Kind kind) {
  if (kind == checker::Kind::tetrahedron) return CellKind::tetrahedron;
  return kind == checker::Kind::edge_edge ? ContactKind::edge_edge : ContactKind::vertex_face;
}

/// \throws std::invalid_argument if curves that are not constant differ in degree
base::AnyQuery query_of(const checker::Query& query) {
  AnyShape shape{.kind = kind_of(query.kind)};
  for (const checker::Curve& curve : query.points) {
    shape.degree = std::max(shape.degree, curve.control.size() - 1);
    shape.is_rational = shape.is_rational || !curve.weights.empty();
  }
  std::vector<double> numbers;
  for (std::size_t j = 0; j <= shape.degree; ++j) {
    for (const checker::Curve& curve : query.points) {
      const std::size_t degree = curve.control.size() - 1, i = std::min(j, degree);
      if (degree != 0 && degree != shape.degree) {
        throw std::invalid_argument("its curves differ in degree");
      }
      for (const mpq_class& x : curve.control[i]) numbers.push_back(as_double(x, "a coordinate"));
      if (!shape.is_rational) continue;
      numbers.push_back(curve.weights.empty() ? 1.0 : as_double(curve.weights[i], "a weight"));
    }
  }
  return {shape, numbers};
}

}  // namespace

ViewedQuery certified_query(std::string stream) {
  const checker::Certificate certificate = parsed(stream);
  ViewedQuery result{.label = checker::printable(certificate.label),
                     .query = query_of(certificate.query)};
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
