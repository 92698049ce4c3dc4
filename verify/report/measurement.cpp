#include "verify/report/measurement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "verify/io/printable.hpp"

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

}  // namespace touchstone::verify::report
