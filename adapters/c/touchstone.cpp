#include "adapters/c/touchstone.h"

#include <array>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fast/certified.hpp"
#include "fast/step.hpp"

// The inputs and outputs of a step.
struct TouchstoneStep {
  std::vector<touchstone::fast::Edge> edges;
  std::vector<touchstone::fast::Face> faces;
  std::vector<std::int32_t> points;
  std::optional<touchstone::fast::Step> step;
  std::vector<TouchstoneCollision> collisions;
};

namespace touchstone::adapters {
namespace {

constexpr std::int32_t well = 0, bad_input = 2;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

static_assert(sizeof(Query) == 24 * sizeof(double), "queries are 24 doubles, as in C");

/// The last error of this thread.
std::string& last_error() {
  thread_local std::string text;
  return text;
}

/// Runs the work; no exception leaves the library.
template <class Work>
std::int32_t guarded(const Work& work) {
  try {
    work();
    return well;
  } catch (const std::exception& error) {
    last_error() = error.what();
  } catch (...) {
    last_error() = "an error without a name";
  }
  return bad_input;
}

template <class T>
T& required(T* pointer, const char* name) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is null");
  return *pointer;
}

/// Converts `count` · `size` numbers to elements.
template <class Element, class Number>
std::vector<Element> copied(const Number* numbers, std::size_t count, const char* name) {
  if (count == 0) return {};
  if (count > std::numeric_limits<std::size_t>::max() / sizeof(Element)) {
    throw std::length_error(std::string(name) + ": too many");
  }
  std::vector<Element> result(count);
  std::memcpy(result.data(), &required(numbers, name), count * sizeof(Element));
  return result;
}

Norm norm_of(std::int32_t norm) {
  if (norm == TOUCHSTONE_LINF) return Norm::linf;
  if (norm == TOUCHSTONE_L2) return Norm::l2;
  throw std::invalid_argument("norm is neither TOUCHSTONE_LINF nor TOUCHSTONE_L2");
}

Kind kind_of(std::int32_t kind) {
  if (kind == TOUCHSTONE_VERTEX_FACE) return Kind::vertex_face;
  if (kind == TOUCHSTONE_EDGE_EDGE) return Kind::edge_edge;
  throw std::invalid_argument("kind is neither TOUCHSTONE_VERTEX_FACE nor TOUCHSTONE_EDGE_EDGE");
}

TouchstoneOptions given(const TouchstoneOptions* options) {
  return options != nullptr ? *options : touchstone_default_options();
}

Separation separation_of(const TouchstoneOptions& options) {
  return {.distance = options.min_separation, .norm = norm_of(options.norm)};
}

TouchstoneImpact impact_of(const fast::CertifiedResult& result) {
  TouchstoneImpact impact{TOUCHSTONE_NO, none, none, none, none};
  if (result.verdict == fast::Verdict::error) impact.verdict = TOUCHSTONE_ERROR;
  if (result.verdict == fast::Verdict::yes) {
    impact = {TOUCHSTONE_YES, result.toi_lower, result.toi_upper, result.u, result.v};
  }
  return impact;
}

void solve(std::int32_t kind, std::size_t count, const double* coordinates,
           const TouchstoneOptions& options, TouchstoneImpact* impacts) {
  const auto queries = copied<Query>(coordinates, count, "coordinates");
  std::vector<fast::CertifiedResult> results(count);
  fast::solve(kind_of(kind), queries, results,
              {.toi_tolerance = options.toi_tolerance,
               .t_max = options.t_max,
               .separation = separation_of(options),
               .max_threads = options.max_threads});
  for (std::size_t i = 0; i < count; ++i)
    (&required(impacts, "impacts"))[i] = impact_of(results[i]);
}

std::unique_ptr<TouchstoneStep> step_of(const TouchstoneMesh& mesh,
                                        const TouchstoneOptions& options) {
  auto result = std::make_unique<TouchstoneStep>();
  result->edges = copied<fast::Edge>(mesh.edge_vertices, mesh.edges, "edge_vertices");
  result->faces = copied<fast::Face>(mesh.face_vertices, mesh.faces, "face_vertices");
  result->points = copied<std::int32_t>(mesh.point_vertices, mesh.points, "point_vertices");
  const auto apart =
      copied<std::array<std::int32_t, 2>>(mesh.apart_groups, mesh.apart, "apart_groups");
  const auto before = copied<std::array<double, 3>>(mesh.before, mesh.vertices, "before");
  const auto after = copied<std::array<double, 3>>(mesh.after, mesh.vertices, "after");
  const auto coordinates = [](const std::vector<std::array<double, 3>>& points) {
    return std::span<const double>(points.empty() ? nullptr : points.front().data(),
                                   3 * points.size());
  };
  fast::CollisionGroups groups{.of_vertices = {}, .apart = apart};
  if (mesh.groups != nullptr) groups.of_vertices = std::span(mesh.groups, mesh.vertices);
  result->step.emplace(
      coordinates(before), coordinates(after),
      fast::MeshElements{.edges = result->edges, .faces = result->faces, .points = result->points},
      fast::StepOptions{.separation = separation_of(options),
                        .toi_tolerance = options.toi_tolerance,
                        .t_max = options.t_max,
                        .max_threads = options.max_threads,
                        .groups = groups});
  return result;
}

TouchstoneCollision collision_of(const fast::StepCollision& collision) {
  return {static_cast<std::int32_t>(collision.kind),
          collision.pair[0],
          collision.pair[1],
          collision.toi_lower,
          collision.toi_upper,
          collision.u,
          collision.v};
}

static_assert(static_cast<int>(fast::PairKind::vertex_face) == TOUCHSTONE_VERTEX_FACE);
static_assert(static_cast<int>(fast::PairKind::edge_edge) == TOUCHSTONE_EDGE_EDGE);
static_assert(static_cast<int>(fast::PairKind::vertex_edge) == TOUCHSTONE_VERTEX_EDGE);
static_assert(static_cast<int>(fast::PairKind::vertex_vertex) == TOUCHSTONE_VERTEX_VERTEX);

}  // namespace
}  // namespace touchstone::adapters

using namespace touchstone::
    adapters;  // NOLINT(google-build-using-namespace): definitions of C functions

const char* touchstone_version() { return TOUCHSTONE_VERSION; }

const char* touchstone_last_error() { return last_error().c_str(); }

TouchstoneOptions touchstone_default_options() {
  const touchstone::fast::CertifiedOptions usual;
  return {usual.separation.distance, usual.t_max, usual.toi_tolerance, TOUCHSTONE_LINF,
          usual.max_threads};
}

std::int32_t touchstone_solve(std::int32_t kind, std::size_t count, const double* coordinates,
                              const TouchstoneOptions* options, TouchstoneImpact* impacts) {
  return guarded([&] { solve(kind, count, coordinates, given(options), impacts); });
}

TouchstoneStep* touchstone_step_new(const TouchstoneMesh* mesh, const TouchstoneOptions* options) {
  std::unique_ptr<TouchstoneStep> step;
  static_cast<void>(guarded([&] { step = step_of(required(mesh, "mesh"), given(options)); }));
  return step.release();
}

void touchstone_step_free(TouchstoneStep* step) { delete step; }

std::int32_t touchstone_step_is_free(const TouchstoneStep* step, std::int32_t* is_free) {
  return guarded(
      [&] { required(is_free, "is_free") = required(step, "step").step->is_free() ? 1 : 0; });
}

std::int32_t touchstone_step_earliest(const TouchstoneStep* step, TouchstoneImpact* impact) {
  return guarded([&] {
    const auto earliest = required(step, "step").step->earliest();
    TouchstoneImpact& written = required(impact, "impact");
    written = {TOUCHSTONE_NO, none, none, none, none};
    if (earliest) written = {TOUCHSTONE_YES, earliest->toi_lower, earliest->toi_upper, none, none};
  });
}

std::int32_t touchstone_step_collisions(TouchstoneStep* step,
                                        const TouchstoneCollision** collisions,
                                        std::size_t* count) {
  return guarded([&] {
    TouchstoneStep& asked = required(step, "step");
    const TouchstoneCollision*& first = required(collisions, "collisions");
    std::size_t& number = required(count, "count");
    std::vector<TouchstoneCollision> found;
    for (const auto& collision : asked.step->collisions()) found.push_back(collision_of(collision));
    asked.collisions = std::move(found);
    first = asked.collisions.data();
    number = asked.collisions.size();
  });
}

std::int32_t touchstone_step_free_step_size(const TouchstoneStep* step, double* alpha) {
  return guarded([&] {
    required(alpha, "alpha") = required(step, "step").step->free_step_size().value_or(-1.0);
  });
}
