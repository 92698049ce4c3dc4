#include "verify/view/query_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <sstream>

#include "touchstone/algebraic_number.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/judge/terms.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/certificate_facts.hpp"
#include "verify/view/nearest_approach.hpp"

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

/// Lists for j = 0 … K, K the greatest degree, of one value for each point: value(curve, j), or
/// null for curves of lower degree.
template <class Value>
nlohmann::json control_lists(const CurvedQuery& curves, const Value& value) {
  std::size_t count = 0;
  for (const Trajectory& curve : curves) count = std::max(count, curve.control.size());
  nlohmann::json lists = nlohmann::json::array();
  for (std::size_t j = 0; j < count; ++j) {
    nlohmann::json& list = lists.emplace_back(nlohmann::json::array());
    for (const Trajectory& curve : curves) {
      list.push_back(j < curve.control.size() ? value(curve, j) : nlohmann::json());
    }
  }
  return lists;
}

bool is_rational(const Trajectory& curve) { return !curve.weights.empty(); }

/// Adds `coordinates`; for curves `control`, and `weights` if any of them is rational.
void add_points(const ViewedQuery& viewed, nlohmann::json& facts) {
  if (const Query* const query = straight_of(viewed)) {
    facts["coordinates"] = numbers(query->coordinates);
    return;
  }
  const CurvedQuery curves = curves_of(viewed);
  facts["control"] = control_lists(
      curves, [](const Trajectory& curve, std::size_t j) { return numbers(curve.control[j]); });
  if (std::ranges::none_of(curves, is_rational)) return;
  facts["weights"] = control_lists(curves, [](const Trajectory& curve, std::size_t j) {
    return number(is_rational(curve) ? curve.weights[j] : 1.0);
  });
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
  const Query* const query = straight_of(viewed);
  if (!viewed.with_approach || query == nullptr) return {};
  const auto approach = nearest_approach(kind_of(viewed), *query);
  if (!approach) return {};
  nlohmann::json facts = moment(approach->time);
  facts["above"] = number(approach->above);
  facts["at_most"] = number(approach->at_most);
  return facts;
}

/// The oracle's own certificate. \return nothing where it is beyond the format's limits
std::string proof_of(const ViewedQuery& viewed, const exact::Decision& verdict) {
  try {
    return exact::certificate_stream(prove(viewed, verdict), io::printable(viewed.label));
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
  const base::AnyQuery query = in_one_shape(viewed).value();
  const base::AnyQuery asked = judge::as_asked(standard.terms, query);
  const judge::Question question{asked.queries(), viewed.separation};
  const judge::GroundTruth truth =
      asked == query ? judged.truth
                     : judge::truth_of(0, exact::decide(question.query, 0, viewed.separation));
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
  require_contact(kind_of(viewed));
  const exact::Decision verdict = decide(viewed);
  nlohmann::json notes = nlohmann::json::array();
  for (const std::string& note : viewed.notes) notes.push_back(io::printable(note));
  nlohmann::json facts{
      {"label", io::printable(viewed.label)},
      {"kind", to_string(kind_of(viewed))},
      {"min_separation", number(viewed.separation.distance)},
      {"norm", to_string(viewed.separation.norm)},
      {"notes", notes},
      {"truth", truth_facts(verdict)},
      {"approach", approach_facts(viewed)},
      {"certificate", certificate_of(viewed, verdict)},
      {"answers", answers_of({.viewed = viewed, .truth = judge::truth_of(0, verdict)}, asked)}};
  add_points(viewed, facts);
  return facts;
}

}  // namespace touchstone::verify::view
