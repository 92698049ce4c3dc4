/// \file
/// Solvers that are right on their own terms, and seem wrong on others': the certified solver with
/// one habit of a solver in use, BEHAVIOUR. None states its promise.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>

#include "touchstone/certified.hpp"
#include "touchstone/plugin.h"

namespace {

constexpr int starts_apart = 1;  // misses contacts at t=0
constexpr int nearest_time = 2;  // the time is the double behind the exact one; late by 0.3 of the
                                 // step where a vertex starts at x = 7
constexpr int vertex_face = 3;   // no verdict about two edges
constexpr int single = 4;        // in single precision
constexpr int hanging = 5;       // never answers
constexpr int slow = 6;          // takes 20 ms a query

touchstone::Query query_of(const double* coordinates) {
  touchstone::Query query{};
  std::copy_n(coordinates, query.coordinates.size(), query.coordinates.begin());
  if (BEHAVIOUR == single) {
    for (double& x : query.coordinates) x = static_cast<double>(static_cast<float>(x));
  }
  return query;
}

}  // namespace

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() {
  static constexpr std::array<const char*, 7> names{
      "", "starts_apart", "nearest_time", "faces_alone", "single_precision", "hanging", "slow"};
  return names.at(BEHAVIOUR);
}

void touchstone_plugin_solve(std::int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  while (BEHAVIOUR == hanging) std::this_thread::sleep_for(std::chrono::seconds(1));
  if (BEHAVIOUR == slow) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (BEHAVIOUR == vertex_face && kind != TOUCHSTONE_VERTEX_FACE) return;
  const auto result = touchstone::fast::solve(
      static_cast<touchstone::ContactKind>(kind), query_of(coordinates),
      {.separation = {options->min_separation, static_cast<touchstone::Norm>(options->norm)}});
  answer->verdict = static_cast<std::int32_t>(result.verdict);
  answer->toi_lower = result.toi_lower;
  if (BEHAVIOUR == starts_apart && result.toi_upper == 0.0) answer->verdict = TOUCHSTONE_NO;
  if (BEHAVIOUR == nearest_time) {
    answer->toi_lower = std::nextafter(result.toi_lower, 2.0);
    if (coordinates[0] == 7.0) answer->toi_lower = result.toi_lower + 0.3;
  }
}
