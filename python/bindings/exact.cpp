/// \file
/// touchstone._exact: the oracle, certificates, and every method by name.
/// The package `touchstone` says what the functions mean.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "fast/method.hpp"
#include "python/bindings/arguments.hpp"
#include "python/bindings/background.hpp"
#include "python/bindings/blocks.hpp"
#include "python/bindings/exact_numbers.hpp"
#include "python/bindings/mesh_arguments.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/scene_certificate.hpp"
#include "touchstone/step.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::python {
namespace {

/// Queries a block: the oracle takes up to a second for one.
constexpr std::size_t oracle_block = 1;
constexpr std::size_t method_block = 16;  ///< of methods that take microseconds a query

// ---- Exact numbers ------------------------------------------------------------------------------

/// The value, if it is rational. If a number p/q in lowest terms is a root of an integer polynomial
/// with the leading coefficient a, then q divides a, so that a p/q is an integer: the only one in
/// an interval around it that is shorter than 1.
std::optional<exact::Rational> rational_value(exact::AlgebraicNumber number) {
  if (number.rational()) return number.rational();
  const exact::Rational leading = number.polynomial().leading();
  number.refine(exact::Rational(1, 2) / abs(leading));
  const auto [lower, upper] = number.interval();
  const exact::Rational middle = leading * (lower + upper) / 2 + exact::Rational(1, 2);
  exact::Integer nearest;
  mpz_fdiv_q(nearest.get_mpz_t(), middle.get_num_mpz_t(), middle.get_den_mpz_t());
  const exact::Rational candidate = exact::Rational(nearest) / leading;
  if (candidate < lower || candidate > upper) return std::nullopt;
  if (exact::sign_at(number.polynomial(), candidate) != 0) return std::nullopt;
  return candidate;
}

/// None, (numerator, denominator), or (coefficients, lower end, upper end).
py::object time_to_python(const std::optional<exact::AlgebraicNumber>& time) {
  if (!time) return py::none();
  if (const auto value = rational_value(*time)) return to_python(*value);
  py::list coefficients;
  for (const exact::Integer& one : time->polynomial().coefficients()) {
    coefficients.append(to_python(one));
  }
  const auto [lower, upper] = time->interval();
  return py::make_tuple(py::tuple(coefficients), to_python(lower), to_python(upper));
}

// ---- The oracle ---------------------------------------------------------------------------------

struct DecisionItem {
  bool is_yes;
  double toi_lower;
  double toi_upper;
};

/// The verdict's name: what is decided.
py::dict decision_layout(const std::string& verdict) {
  using Item = DecisionItem;
  return Layout(sizeof(Item))
      .add(verdict.c_str(), "?", offsetof(Item, is_yes))
      .add("toi_lower", "f8", offsetof(Item, toi_lower))
      .add("toi_upper", "f8", offsetof(Item, toi_upper))
      .dict();
}

/// The exact times of the queries that are done, where time_of(i) is that of query i.
template <class TimeOf>
py::list decided(std::size_t size, py::array results, int threads, const py::object& progress,
                 const TimeOf& time_of) {
  const auto items = items_of<DecisionItem>(results, size);
  std::vector<std::optional<exact::AlgebraicNumber>> times(size);
  const auto decide_some = [&](std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) {
      times[i] = time_of(i);
      items[i] = {.is_yes = times[i].has_value(),
                  .toi_lower = fast::no_number,
                  .toi_upper = fast::no_number};
      if (!times[i]) continue;
      const auto [lower, upper] = times[i]->enclosure();
      items[i].toi_lower = lower;
      items[i].toi_upper = upper;
    }
  };
  const std::size_t done = in_blocks(size, oracle_block, threads, progress, decide_some);
  py::list exact_times;
  for (std::size_t i = 0; i < done; ++i) exact_times.append(time_to_python(times[i]));
  return exact_times;
}

py::list decide(const std::string& kind, const Doubles& array, py::array results, double distance,
                const std::string& norm, int threads, const py::object& progress) {
  const AnyQueries queries = queries_of(kind_from(kind), array);
  const Separation separation = separation_from(distance, norm);
  return decided(queries.size(), std::move(results), threads, progress, [&](std::size_t i) {
    require_valid(queries, i);
    return verify::base::decide(queries, i, separation).toi;
  });
}

/// Control points and weights; none for a polynomial curve.
using CurveArguments = std::pair<std::vector<std::array<double, 3>>, std::vector<double>>;

/// The same of queries whose points move on curves of degrees of their own.
py::list decide_curves(const std::string& kind_name,
                       const std::vector<std::array<CurveArguments, moving_points>>& curves,
                       py::array results, double distance, const std::string& norm, int threads,
                       const py::object& progress) {
  const AnyKind kind = kind_from(kind_name);
  const Separation separation = separation_from(distance, norm);
  return decided(curves.size(), std::move(results), threads, progress, [&](std::size_t i) {
    CurvedQuery query;
    for (std::size_t point = 0; point < moving_points; ++point) {
      query[point] = {.control = curves[i][point].first, .weights = curves[i][point].second};
    }
    return kind.is_cell() ? exact::first_inversion(kind.cell(), query)
                          : exact::decide(kind.contact(), query, separation).toi;
  });
}

// ---- Certificates -------------------------------------------------------------------------------

exact::Claim claim_from(const std::string& name) {
  if (name == "collision") return exact::Claim::collision;
  if (name == "time_of_impact") return exact::Claim::time_of_impact;
  throw std::invalid_argument("claim must be 'collision' or 'time_of_impact', not '" + name + "'");
}

/// The number of queries that are done, and a stream of their certificates.
py::tuple prove(const std::string& kind_name, const Doubles& array, double distance,
                const std::string& norm, const std::string& claim, int threads,
                const py::object& progress) {
  const AnyQueries queries = queries_of(kind_from(kind_name), array);
  const Separation separation = separation_from(distance, norm);
  const exact::ProveOptions options{.collision_claim = claim_from(claim)};
  std::vector<std::string> texts(queries.size());
  const std::size_t done = in_blocks(
      queries.size(), oracle_block, threads, progress, [&](std::size_t first, std::size_t count) {
        for (std::size_t i = first; i < first + count; ++i) {
          require_valid(queries, i);
          const exact::Decision decision = verify::base::decide(queries, i, separation);
          exact::write(texts[i], verify::base::prove(queries, i, decision, options));
        }
      });
  std::string stream(exact::certificates_header());
  for (std::size_t i = 0; i < done; ++i) stream += texts[i];
  stream += exact::certificates_closing_line(done);
  return py::make_tuple(done, py::bytes(stream));
}

/// Calls prove(options), where they have a progress in thousandths for `progress`.
/// \returns the claim, the rules and the stream. \throws std::runtime_error with the reason for a missing
/// proof.
template <class Prove>
py::tuple scene_proof(const std::string& label, int threads, std::atomic<bool>& stop,
                      const py::object& progress, const Prove& prove_scene) {
  std::atomic<int> done = 0;
  const exact::SceneProofOptions options{
      .label = label,
      .max_threads = threads,
      .on_progress = [&](double part) { done = static_cast<int>(1000 * part); },
      .stop = &stop};
  py::object show = py::none();
  if (!progress.is_none()) show = py::cpp_function([&] { progress(done.load()); });
  const exact::SceneProof proof = in_background([&] { return prove_scene(options); }, stop, show);
  if (!proof.is_complete()) throw std::runtime_error("prove: no proof: " + proof.failure);
  return py::make_tuple(proof.claim, proof.rules, py::bytes(proof.stream));
}

py::tuple prove_step(const Doubles& before, const Doubles& after, const Integers& faces,
                     const Integers& edges, const Integers& points, const Integers& groups,
                     const Integers& apart, const CellLists& cells, const Doubles& radii,
                     const Integers& separated, const Doubles& separations, double separation,
                     const std::string& norm, double t_max, int threads, const std::string& label,
                     const py::object& progress) {
  std::atomic<bool> stop = false;
  fast::Motion vertices = motion_of(before, after);
  fast::Mesh mesh = mesh_from(faces, edges, points, cells);
  const fast::StepOptions of_step{
      .solve = {.t_max = t_max,
                .separation = separation_from(separation, norm),
                .max_threads = threads},
      .groups = groups_from(groups, apart, radii, separated, separations),
      .stop = &stop};
  return scene_proof(label, threads, stop, progress, [&](const auto& options) {
    return exact::prove_step({std::move(vertices), std::move(mesh), of_step}, options);
  });
}

py::tuple prove_mesh(const Doubles& vertices, const Integers& faces, const Integers& edges,
                     const Integers& points, const Integers& groups, const Integers& apart,
                     bool weld, int threads, const std::string& label, const py::object& progress) {
  std::atomic<bool> stop = false;
  const fast::Motion at_rest = motion_of(vertices, vertices);
  const fast::Mesh mesh = mesh_from(faces, edges, points);
  const fast::IntersectionOptions search{
      .groups = groups_from(groups, apart), .weld = weld, .max_threads = threads, .stop = &stop};
  return scene_proof(label, threads, stop, progress, [&](const auto& options) {
    return exact::prove_mesh(at_rest, mesh, search, options);
  });
}

/// A text as a stream that ends early at a stop.
class StoppableText : public std::streambuf {
 public:
  StoppableText(std::string_view text, const std::atomic<bool>& stop) : rest_(text), stop_(stop) {}

 protected:
  int_type underflow() override {
    if (rest_.empty() || stop_) return traits_type::eof();
    const std::string_view part = rest_.substr(0, part_bytes);
    rest_.remove_prefix(part.size());
    char* const begin = const_cast<char*>(part.data());  // is only read
    setg(begin, begin, begin + part.size());
    return traits_type::to_int_type(part.front());
  }

 private:
  static constexpr std::size_t part_bytes = 4096;
  std::string_view rest_;
  const std::atomic<bool>& stop_;
};

py::dict check(const std::string& certificates, const std::optional<std::string>& scenes,
               const std::optional<std::string>& claim, const std::optional<std::string>& distance,
               const std::string& norm, const std::string& rules) {
  checker::Options options{.rules = rules};
  try {
    if (claim) options.claim = checker::demanded_claim(*claim);
    if (distance) options.separation = checker::demanded_separation(*distance, norm);
  } catch (const checker::Rejection& rejection) {
    throw std::invalid_argument(rejection.reason);
  }
  std::atomic<bool> stop = false;
  StoppableText text(certificates, stop);
  std::istream stream(&text);
  StoppableText scenes_text(scenes ? std::string_view(*scenes) : std::string_view(), stop);
  std::istream scenes_stream(&scenes_text);
  if (scenes) options.scenes = &scenes_stream;
  const auto report = in_background([&] { return checker::check(stream, options); }, stop);
  py::dict result;
  result["no_collision"] = report.no_collision;
  result["collision"] = report.collision;
  result["time_of_impact"] = report.time_of_impact;
  result["no_inversion"] = report.no_inversion;
  result["inversion"] = report.inversion;
  result["time_of_inversion"] = report.time_of_inversion;
  result["steps"] = py::tuple(py::cast(report.steps));
  result["meshes"] = py::tuple(py::cast(report.meshes));
  result["summary"] = report.summary;
  result["rejected"] = report.rejected;
  py::list rejections;
  for (const auto& [line, label, reason] : report.rejections) {
    rejections.append(py::make_tuple(line, label, reason));
  }
  result["rejections"] = py::tuple(rejections);
  return result;
}

// ---- Methods ------------------------------------------------------------------------------------

py::list methods() {
  py::list all;
  for (const auto& method : verify::solvers::methods()) {
    const fast::MethodInfo& info = method->info();
    py::list norms;
    for (const Norm norm : info.norms) norms.append(std::string(to_string(norm)));
    all.append(py::make_tuple(
        std::string(info.name), std::string(verify::solvers::to_string(info.promise)),
        std::string(info.reference), info.is_baseline, info.is_tolerance_driven, py::tuple(norms)));
  }
  return all;
}

py::dict answer_layout() {
  using fast::Answer;
  return Layout(sizeof(Answer))
      .add("verdict", "u1", offsetof(Answer, verdict))
      .add("checks", "u4", offsetof(Answer, checks))
      .add("toi_lower", "f8", offsetof(Answer, toi_lower))
      .add("toi_upper", "f8", offsetof(Answer, toi_upper))
      .add("tolerance", "f8", offsetof(Answer, tolerance))
      .dict();
}

std::size_t solve(const std::string& name, const std::string& kind_name, const Doubles& array,
                  py::array results, double distance, const std::string& norm, double tolerance,
                  std::int64_t max_checks, double t_max, int threads, const py::object& progress) {
  const fast::Method& method = verify::solvers::find_method(name);
  AnyQueries queries = queries_of(kind_from(kind_name), array);
  std::vector<double> memory;
  if (!queries.kind.is_cell()) {
    queries = decided_queries(queries.as(queries.kind.contact()), memory);
  }
  const fast::Terms& terms = method.info().terms;
  if (!terms.answers(queries)) {
    throw std::invalid_argument(name + " does not answer queries on curves of this degree" +
                                (terms.answers(queries.kind) ? "" : ", or about a " + kind_name));
  }
  const auto items = items_of<fast::Answer>(results, queries.size());
  const fast::MethodOptions options{.tolerance = tolerance,
                                    .max_checks = max_checks,
                                    .separation = separation_from(distance, norm),
                                    .t_max = t_max};
  const auto& norms = method.info().norms;
  if (!is_zero(options.separation) && norms.empty()) {
    throw std::invalid_argument(name + " knows no separation but 0");
  }
  // A query with a tolerance can take a second.
  const std::size_t block = method.info().is_tolerance_driven ? 1 : method_block;
  return in_blocks(queries.size(), block, threads, progress,
                   [&](std::size_t first, std::size_t count) {
                     for (std::size_t i = first; i < first + count; ++i) require_valid(queries, i);
                     method.solve(queries.part(first, count), items.subspan(first, count), options);
                   });
}

}  // namespace

PYBIND11_MODULE(_exact, m) {
  using py::arg;
  m.def("decision_layout", decision_layout, arg("verdict"));
  m.def("decide", decide, arg("kind"), arg("queries").noconvert(), arg("results").noconvert(),
        arg("separation"), arg("norm"), arg("threads"), arg("progress"));
  m.def("decide_curves", decide_curves, arg("kind"), arg("curves"), arg("results").noconvert(),
        arg("separation"), arg("norm"), arg("threads"), arg("progress"));
  m.def("prove", prove, arg("kind"), arg("queries").noconvert(), arg("separation"), arg("norm"),
        arg("claim"), arg("threads"), arg("progress"));
  m.def("prove_step", prove_step, arg("before").noconvert(), arg("after").noconvert(),
        arg("faces").noconvert(), arg("edges").noconvert(), arg("points").noconvert(),
        arg("groups").noconvert(), arg("apart").noconvert(), arg("cells").noconvert(),
        arg("radii").noconvert(), arg("separated").noconvert(), arg("separations").noconvert(),
        arg("separation"), arg("norm"), arg("t_max"), arg("threads"), arg("label"),
        arg("progress"));
  m.def("prove_mesh", prove_mesh, arg("vertices").noconvert(), arg("faces").noconvert(),
        arg("edges").noconvert(), arg("points").noconvert(), arg("groups").noconvert(),
        arg("apart").noconvert(), arg("weld"), arg("threads"), arg("label"), arg("progress"));
  m.def("check", check, arg("certificates"), arg("scenes"), arg("claim"), arg("separation"),
        arg("norm"), arg("rules"));
  m.def("methods", methods);
  m.def("answer_layout", answer_layout);
  m.def("solve", solve, arg("method"), arg("kind"), arg("queries").noconvert(),
        arg("results").noconvert(), arg("separation"), arg("norm"), arg("tolerance"),
        arg("max_checks"), arg("t_max"), arg("threads"), arg("progress"));
}

}  // namespace touchstone::python
