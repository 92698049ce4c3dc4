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

Json json_of(const JudgedAnswers& judged) {
  return {{"collisions", judged.collisions},
          {"false_positives", judged.false_positives},
          {"false_negatives", judged.false_negatives},
          {"late_tois", judged.late_tois},
          {"early_upper_tois", judged.early_upper_tois},
          {"beyond_tolerance", judged.beyond_tolerance},
          {"errors", judged.errors},
          {"undecided", judged.undecided},
          {"toi_error", json_of(judged.toi_error)},
          {"ns_per_query", io::number_to_json(judged.nanoseconds)}};
}

void read(const Json& json, JudgedAnswers& judged) {
  json.at("collisions").get_to(judged.collisions);
  json.at("false_positives").get_to(judged.false_positives);
  json.at("false_negatives").get_to(judged.false_negatives);
  judged.nanoseconds = io::number_from_json(json.at("ns_per_query"));
  // (Earlier files do not have all of these.)
  judged.late_tois = json.value("late_tois", judged.late_tois);
  judged.early_upper_tois = json.value("early_upper_tois", judged.early_upper_tois);
  judged.beyond_tolerance = json.value("beyond_tolerance", judged.beyond_tolerance);
  judged.errors = json.value("errors", judged.errors);
  judged.undecided = json.value("undecided", judged.undecided);
  judged.toi_error = spread_from(json.value("toi_error", Json()));
}

Json json_of(const Measurement& m) {
  Json json = json_of(static_cast<const JudgedAnswers&>(m));
  json.update({{"experiment", to_string(m.experiment)},
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
               {"late", report::to_json(m.late)},
               {"at_limit", m.at_limit},
               {"keeps_promise", m.keeps_promise},
               {"repetitions", m.repetitions},
               {"certified_ns_per_query", io::number_to_json(m.certified_nanoseconds)},
               {"achieved_tolerance", json_of(m.achieved_tolerance)},
               {"stages", json_of(m.stages)},
               {"collision_times", json_of(m.collision_times)},
               {"no_collision_times", json_of(m.no_collision_times)}});
  return json;
}

Measurement measurement_from(const Json& json) {
  Measurement m;
  read(json, m);
  m.experiment = experiment_from_string(json.at("experiment").get<std::string>());
  json.at("group").get_to(m.group);
  m.kind = kind_from_string(json.at("kind").get<std::string>());
  json.at("method").get_to(m.method);
  m.promise = promise_from(json.at("promise").get<std::string>());
  m.tolerance = io::number_from_json(json.at("tolerance"));
  json.at("max_checks").get_to(m.max_checks);
  const Json& separation = json.at("separation");
  separation.at("min_separation").get_to(m.separation.distance);
  m.separation.norm = norm_from_string(separation.at("norm").get<std::string>());
  json.at("group_queries").get_to(m.group_queries);
  json.at("asked").get_to(m.asked);
  // (Files from before there was a scale have none, and their solvers answered all.)
  const Json scale = json.value("scale", Json());
  if (!scale.is_null()) m.scale = io::number_from_json(scale);
  m.outside = json.value("outside", m.outside);
  m.left_out = json.value("left_out", m.left_out);
  m.late = late_times_from(json.value("late", Json()));
  json.at("at_limit").get_to(m.at_limit);
  json.at("keeps_promise").get_to(m.keeps_promise);
  json.at("repetitions").get_to(m.repetitions);
  m.certified_nanoseconds = io::number_from_json(json.at("certified_ns_per_query"));
  m.achieved_tolerance = spread_from(json.at("achieved_tolerance"));
  for (const Json& stage : json.at("stages")) {
    m.stages.push_back({stage.at(0).get<std::string>(), stage.at(1).get<std::uint64_t>()});
  }
  m.collision_times = histogram_from(json.at("collision_times"));
  m.no_collision_times = histogram_from(json.at("no_collision_times"));
  return m;
}

Json json_of(const StabilityMark& mark) {
  Json json = json_of(static_cast<const JudgedAnswers&>(mark));
  json.update({{"method", mark.method},
               {"hardness", mark.hardness},
               {"measure", mark.measure},
               {"exponent", mark.exponent},
               {"is_power", mark.is_power},
               {"kind", to_string(mark.kind)},
               {"queries", mark.queries},
               {"hangs", mark.hangs},
               {"worst", mark.worst ? judge::to_text(*mark.worst) : ""},
               {"is_slight", mark.is_slight},
               {"worst_rate", mark.worst_rate},
               {"checks_per_query", io::number_to_json(mark.checks)}});
  return json;
}

StabilityMark mark_from(const Json& json) {
  StabilityMark mark;
  read(json, mark);
  json.at("method").get_to(mark.method);
  json.at("hardness").get_to(mark.hardness);
  json.at("measure").get_to(mark.measure);
  json.at("exponent").get_to(mark.exponent);
  mark.kind = kind_from_string(json.at("kind").get<std::string>());
  json.at("queries").get_to(mark.queries);
  const auto worst = json.at("worst").get<std::string>();
  mark.worst = judge::fault_from_text(worst);
  if (!mark.worst && !worst.empty()) throw std::invalid_argument("no fault is called " + worst);
  json.at("worst_rate").get_to(mark.worst_rate);
  // (Earlier files have no more than that.)
  mark.is_power = json.value("is_power", mark.is_power);
  mark.is_slight = json.value("is_slight", mark.is_slight);
  mark.hangs = json.value("hangs", mark.hangs);
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
