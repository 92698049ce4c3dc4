#include "verify/report/measurement.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/report/judgement_report.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

constexpr std::array<std::pair<Experiment, std::string_view>, 5> names{{
    {Experiment::field, "field"},
    {Experiment::separation, "separation"},
    {Experiment::tolerance, "tolerance"},
    {Experiment::checks, "checks"},
    {Experiment::filter, "filter"},
}};

}  // namespace

std::string_view to_string(Experiment experiment) {
  return names.at(static_cast<std::size_t>(experiment)).second;
}

Experiment experiment_from_string(std::string_view name) {
  for (const auto& [experiment, known] : names) {
    if (known == name) return experiment;
  }
  throw std::invalid_argument("no experiment is called " + std::string(name));
}

void TimeHistogram::add(double nanoseconds) {
  const double place = std::log10(std::max(nanoseconds, 1.0)) * bins_per_decade;
  ++bins[static_cast<int>(std::floor(place))];
}

Measurements with_printable_texts(Measurements measurements) {
  const auto clean = [](std::string& text) { text = io::printable(text); };
  clean(measurements.command);
  clean(measurements.machine);
  clean(measurements.date);
  clean(measurements.version);
  for (MeasuredGroup& group : measurements.groups) clean(group.name);
  for (Measurement& measurement : measurements.all) {
    clean(measurement.group);
    clean(measurement.method);
    for (StageShare& share : measurement.stages) clean(share.stage);
  }
  for (StabilityMark& mark : measurements.stability) {
    for (std::string* text : {&mark.method, &mark.hardness, &mark.measure}) clean(*text);
  }
  return measurements;
}

bool has_wrong_answers(const Measurements& measurements) {
  return !std::ranges::all_of(measurements.all, &Measurement::keeps_promise);
}

namespace {

using Json = nlohmann::json;

constexpr const char* format_name = "touchstone measurements 1";

Json json_of(const std::optional<Spread>& spread) {
  if (!spread) return {};
  return {{"count", spread->count},
          {"median", io::number_to_json(spread->median)},
          {"max", io::number_to_json(spread->max)}};
}

std::optional<Spread> spread_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return Spread{.count = json.at("count").get<std::uint64_t>(),
                .median = io::number_from_json(json.at("median")),
                .max = io::number_from_json(json.at("max"))};
}

judge::LateTimes late_times_from(const Json& json) {
  judge::LateTimes late;
  if (json.is_null()) return late;
  json.at("count").get_to(late.count);
  json.at("beyond").get_to(late.beyond);
  late.greatest = {.step = io::number_from_json(json.at("greatest")),
                   .ulps = io::number_from_json(json.at("greatest_ulps"))};
  return late;
}

Json json_of(const TimeHistogram& times) {
  Json list = Json::array();
  for (const auto& [bin, count] : times.bins) list.push_back({bin, count});
  return list;
}

TimeHistogram histogram_from(const Json& json) {
  TimeHistogram times;
  for (const Json& bin : json) times.bins[bin.at(0).get<int>()] = bin.at(1).get<std::uint64_t>();
  return times;
}

Json json_of(const std::vector<StageShare>& stages) {
  Json list = Json::array();
  for (const StageShare& share : stages) list.push_back({share.stage, share.queries});
  return list;
}

fast::Promise promise_from(const std::string& name) {
  for (const auto promise :
       {fast::Promise::none, fast::Promise::conservative, fast::Promise::exact}) {
    if (solvers::to_string(promise) == name) return promise;
  }
  throw std::invalid_argument("no promise is called " + name);
}

Json json_of(const Measurement& measurement) {
  const Measurement& m = measurement;
  return {{"experiment", to_string(m.experiment)},
          {"group", m.group},
          {"kind", to_string(m.kind)},
          {"method", m.method},
          {"promise", solvers::to_string(m.promise)},
          {"tolerance", io::number_to_json(m.tolerance)},
          {"max_checks", m.max_checks},
          {"separation", judge::to_json(m.separation)},
          {"scale", io::number_to_json(m.scale)},
          {"group_queries", m.group_queries},
          {"asked", m.asked},
          {"outside", m.outside},
          {"left_out", m.left_out},
          {"collisions", m.collisions},
          {"false_positives", m.false_positives},
          {"false_negatives", m.false_negatives},
          {"late_tois", m.late_tois},
          {"late", report::to_json(m.late)},
          {"early_upper_tois", m.early_upper_tois},
          {"beyond_tolerance", m.beyond_tolerance},
          {"errors", m.errors},
          {"undecided", m.undecided},
          {"at_limit", m.at_limit},
          {"keeps_promise", m.keeps_promise},
          {"ns_per_query", io::number_to_json(m.nanoseconds)},
          {"repetitions", m.repetitions},
          {"certified_ns_per_query", io::number_to_json(m.certified_nanoseconds)},
          {"toi_error", json_of(m.toi_error)},
          {"achieved_tolerance", json_of(m.achieved_tolerance)},
          {"stages", json_of(m.stages)},
          {"collision_times", json_of(m.collision_times)},
          {"no_collision_times", json_of(m.no_collision_times)}};
}

Separation separation_from(const Json& json) {
  return {.distance = json.at("min_separation").get<double>(),
          .norm = norm_from_string(json.at("norm").get<std::string>())};
}

/// The method, and the options and queries of the call.
void read_question(const Json& json, Measurement& m) {
  m.experiment = experiment_from_string(json.at("experiment").get<std::string>());
  json.at("group").get_to(m.group);
  m.kind = kind_from_string(json.at("kind").get<std::string>());
  json.at("method").get_to(m.method);
  m.promise = promise_from(json.at("promise").get<std::string>());
  m.tolerance = io::number_from_json(json.at("tolerance"));
  json.at("max_checks").get_to(m.max_checks);
  m.separation = separation_from(json.at("separation"));
  // (Files from before there was a scale have none.)
  const Json scale = json.value("scale", Json());
  if (!scale.is_null()) m.scale = io::number_from_json(scale);
  json.at("group_queries").get_to(m.group_queries);
  json.at("asked").get_to(m.asked);
  // (Earlier files were made by solvers that answered all.)
  m.outside = json.value("outside", m.outside);
  m.left_out = json.value("left_out", m.left_out);
}

void read_faults(const Json& json, Measurement& m) {
  json.at("collisions").get_to(m.collisions);
  json.at("false_positives").get_to(m.false_positives);
  json.at("false_negatives").get_to(m.false_negatives);
  json.at("late_tois").get_to(m.late_tois);
  json.at("early_upper_tois").get_to(m.early_upper_tois);
  // (Earlier files do not count them.)
  m.beyond_tolerance = json.value("beyond_tolerance", m.beyond_tolerance);
  m.late = late_times_from(json.value("late", Json()));
  json.at("errors").get_to(m.errors);
  json.at("undecided").get_to(m.undecided);
  json.at("at_limit").get_to(m.at_limit);
  json.at("keeps_promise").get_to(m.keeps_promise);
}

Measurement measurement_from(const Json& json) {
  Measurement m;
  read_question(json, m);
  read_faults(json, m);
  m.nanoseconds = io::number_from_json(json.at("ns_per_query"));
  json.at("repetitions").get_to(m.repetitions);
  m.certified_nanoseconds = io::number_from_json(json.at("certified_ns_per_query"));
  m.toi_error = spread_from(json.at("toi_error"));
  m.achieved_tolerance = spread_from(json.at("achieved_tolerance"));
  for (const Json& stage : json.at("stages")) {
    m.stages.push_back({stage.at(0).get<std::string>(), stage.at(1).get<std::uint64_t>()});
  }
  m.collision_times = histogram_from(json.at("collision_times"));
  m.no_collision_times = histogram_from(json.at("no_collision_times"));
  return m;
}

Json json_of(const StabilityMark& mark) {
  return {{"method", mark.method},
          {"hardness", mark.hardness},
          {"measure", mark.measure},
          {"exponent", mark.exponent},
          {"is_power", mark.is_power},
          {"kind", to_string(mark.kind)},
          {"queries", mark.queries},
          {"collisions", mark.collisions},
          {"false_positives", mark.false_positives},
          {"false_negatives", mark.false_negatives},
          {"late_tois", mark.late_tois},
          {"early_upper_tois", mark.early_upper_tois},
          {"beyond_tolerance", mark.beyond_tolerance},
          {"errors", mark.errors},
          {"hangs", mark.hangs},
          {"undecided", mark.undecided},
          {"worst", mark.worst ? judge::to_text(*mark.worst) : ""},
          {"is_slight", mark.is_slight},
          {"worst_rate", mark.worst_rate},
          {"toi_error", json_of(mark.toi_error)},
          {"ns_per_query", io::number_to_json(mark.nanoseconds)},
          {"checks_per_query", io::number_to_json(mark.checks)}};
}

std::optional<judge::Fault> worst_from(const std::string& text) {
  const auto fault = judge::fault_from_text(text);
  if (!fault && !text.empty()) throw std::invalid_argument("no fault is called " + text);
  return fault;
}

StabilityMark mark_from(const Json& json) {
  StabilityMark mark;
  json.at("method").get_to(mark.method);
  json.at("hardness").get_to(mark.hardness);
  json.at("measure").get_to(mark.measure);
  json.at("exponent").get_to(mark.exponent);
  mark.kind = kind_from_string(json.at("kind").get<std::string>());
  json.at("queries").get_to(mark.queries);
  json.at("collisions").get_to(mark.collisions);
  json.at("false_positives").get_to(mark.false_positives);
  json.at("false_negatives").get_to(mark.false_negatives);
  mark.worst = worst_from(json.at("worst").get<std::string>());
  json.at("worst_rate").get_to(mark.worst_rate);
  mark.nanoseconds = io::number_from_json(json.at("ns_per_query"));
  // (Earlier files have no more than that.)
  mark.late_tois = json.value("late_tois", mark.late_tois);
  mark.early_upper_tois = json.value("early_upper_tois", mark.early_upper_tois);
  mark.beyond_tolerance = json.value("beyond_tolerance", mark.beyond_tolerance);
  mark.errors = json.value("errors", mark.errors);
  mark.undecided = json.value("undecided", mark.undecided);
  mark.is_power = json.value("is_power", mark.is_power);
  mark.is_slight = json.value("is_slight", mark.is_slight);
  mark.hangs = json.value("hangs", mark.hangs);
  mark.toi_error = spread_from(json.value("toi_error", Json()));
  mark.checks = io::number_from_json(json.value("checks_per_query", Json()));
  return mark;
}

Json json_of(const MeasuredGroup& group) {
  return {{"name", group.name},
          {"kind", to_string(group.kind)},
          {"queries", group.queries},
          {"digest", fmt::format("{:016x}", group.digest)}};
}

MeasuredGroup group_from(const Json& json) {
  return {.name = json.at("name").get<std::string>(),
          .kind = kind_from_string(json.at("kind").get<std::string>()),
          .queries = json.at("queries").get<std::uint64_t>(),
          .digest = std::stoull(json.at("digest").get<std::string>(), nullptr, 16)};
}

Measurements read(const Json& json) {
  if (json.at("format") != format_name) throw std::invalid_argument("unknown format");
  Measurements measurements;
  json.at("command").get_to(measurements.command);
  json.at("machine").get_to(measurements.machine);
  // (Earlier files have no date, or no version and groups.)
  measurements.date = json.value("date", measurements.date);
  measurements.version = json.value("version", measurements.version);
  for (const Json& group : json.value("groups", Json::array())) {
    measurements.groups.push_back(group_from(group));
  }
  json.at("interrupted").get_to(measurements.interrupted);
  for (const Json& one : json.at("measurements")) {
    measurements.all.push_back(measurement_from(one));
  }
  for (const Json& one : json.at("stability")) measurements.stability.push_back(mark_from(one));
  return measurements;
}

}  // namespace

Json to_json(const Measurements& measurements) {
  Json all = Json::array();
  for (const Measurement& measurement : measurements.all) all.push_back(json_of(measurement));
  Json groups = Json::array();
  for (const MeasuredGroup& group : measurements.groups) groups.push_back(json_of(group));
  Json stability = Json::array();
  for (const StabilityMark& mark : measurements.stability) stability.push_back(json_of(mark));
  return {{"format", format_name},
          {"command", measurements.command},
          {"machine", measurements.machine},
          {"date", measurements.date},
          {"version", measurements.version},
          {"groups", std::move(groups)},
          {"interrupted", measurements.interrupted},
          {"measurements", std::move(all)},
          {"stability", std::move(stability)}};
}

Measurements measurements_from_json(const Json& json) {
  try {
    return read(json);
  } catch (const std::exception& error) {
    throw std::runtime_error("not the measurements of a report: " + io::reason_of(error));
  }
}

}  // namespace touchstone::verify::report
