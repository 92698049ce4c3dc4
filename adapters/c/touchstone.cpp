#include "touchstone/touchstone.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/step.hpp"

// A step, and what is found in it.
struct TouchstoneStep {
  touchstone::fast::Step step;
  // The arrays whose addresses the functions return.
  std::vector<TouchstoneCollision> collisions = {};
  std::vector<TouchstonePair> nearest = {};
  std::vector<TouchstoneActiveContact> active = {};
  std::vector<TouchstoneStepInversion> inversions = {};
  std::vector<TouchstoneCollision> limiting = {};
  std::vector<TouchstoneStepInversion> limiting_cells = {};
};

namespace touchstone::adapters {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

static_assert(sizeof(Query) == 24 * sizeof(double), "queries are 24 doubles, as in C");

/// The last error of this thread.
std::string& last_error() {
  thread_local std::string text;
  return text;
}

/// The status for the exception that is being handled. Its message becomes the last error.
std::int32_t status_of_exception() {
  const auto failed = [](std::int32_t status, const char* reason) {
    last_error() = reason;
    return status;
  };
  try {
    throw;
  } catch (const std::invalid_argument& error) {
    return failed(TOUCHSTONE_INVALID_ARGUMENT, error.what());
  } catch (const std::out_of_range& error) {
    return failed(TOUCHSTONE_OUT_OF_RANGE, error.what());
  } catch (const std::domain_error& error) {
    return failed(TOUCHSTONE_NOT_FINITE, error.what());
  } catch (const std::length_error& error) {
    return failed(TOUCHSTONE_TOO_MANY, error.what());
  } catch (const std::bad_alloc&) {
    return failed(TOUCHSTONE_TOO_MANY, "not enough memory");
  } catch (const std::exception& error) {
    return failed(TOUCHSTONE_FAILURE, error.what());
  } catch (...) {
    return failed(TOUCHSTONE_FAILURE, "an error without a name");
  }
}

/// Runs the work; no exception leaves the library.
template <class Work>
std::int32_t guarded(const Work& work) {
  try {
    work();
    return TOUCHSTONE_OK;
  } catch (...) {
    return status_of_exception();
  }
}

template <class T>
T& required(T* pointer, const char* name) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is null");
  return *pointer;
}

/// The numbers of `count` elements; null if there are none.
template <class Element, class Number>
const Number* numbers_of(const Number* numbers, std::size_t count, const char* name) {
  if (count == 0) return nullptr;
  if (count > std::numeric_limits<std::size_t>::max() / sizeof(Element)) {
    throw std::length_error(std::string(name) + ": too many");
  }
  return &required(numbers, name);
}

/// Converts numbers to `count` elements.
template <class Element, class Number>
std::vector<Element> copied(const Number* numbers, std::size_t count, const char* name) {
  const Number* const first = numbers_of<Element>(numbers, count, name);
  std::vector<Element> result(count);
  if (count != 0) std::memcpy(result.data(), first, count * sizeof(Element));
  return result;
}

Norm norm_of(std::int32_t norm) {
  if (norm == TOUCHSTONE_LINF) return Norm::linf;
  if (norm == TOUCHSTONE_L2) return Norm::l2;
  throw std::invalid_argument("norm is neither TOUCHSTONE_LINF nor TOUCHSTONE_L2");
}

AnyKind any_kind_of(std::int32_t number) {
  const std::optional<AnyKind> kind = AnyKind::with_number(number);
  if (!kind) throw std::invalid_argument("kind is none of TouchstoneKind");
  return *kind;
}

ContactKind kind_of(std::int32_t number) {
  const AnyKind kind = any_kind_of(number);
  if (!kind.is_cell()) return kind.contact();
  throw std::invalid_argument("kind is one of a cell: touchstone_inversions decides cells");
}

CellKind cell_kind_of(std::int32_t number) {
  const AnyKind kind = any_kind_of(number);
  if (kind.is_cell()) return kind.cell();
  throw std::invalid_argument("kind is none of a cell: touchstone_solve decides contacts");
}

/// The caller's structure; members beyond its size are those of `usual`, which the header's
/// function `initialiser` returns. Its first version had the size `first`.
template <class Structure>
Structure taken(const Structure* given, Structure usual, std::size_t first,
                const char* initialiser) {
  if (given == nullptr) return usual;
  const std::size_t size = given->size;
  if (size < first || size > sizeof(Structure) || size % alignof(Structure) != 0) {
    const std::string is = "size is " + std::to_string(size) + " bytes, ";
    throw std::invalid_argument(
        size > sizeof(Structure)
            ? is + "but this library, version " TOUCHSTONE_VERSION ", knows " +
                  std::to_string(sizeof(Structure)) + ": start from " + initialiser +
                  "(), with the header of this library or an older one"
            : is + "which no version of this structure has: start from " + initialiser +
                  "(), which sets it");
  }
  std::memcpy(&usual, given, size);
  return usual;
}

TouchstoneOptions given(const TouchstoneOptions* options) {
  return taken(options, touchstone_default_options(), sizeof(TouchstoneOptions),
               "touchstone_default_options");
}

TouchstoneMesh given(const TouchstoneMesh* mesh) {
  return taken(&required(mesh, "mesh"), touchstone_empty_mesh(),
               offsetof(TouchstoneMesh, cell_lists), "touchstone_empty_mesh");
}

TouchstoneLineSearchOptions given(const TouchstoneLineSearchOptions* options) {
  return taken(options, touchstone_default_line_search_options(),
               offsetof(TouchstoneLineSearchOptions, kept_volume),
               "touchstone_default_line_search_options");
}

fast::CertifiedOptions certified_of(const TouchstoneOptions& options) {
  return {.toi_tolerance = options.toi_tolerance,
          .t_max = options.t_max,
          .separation = {.distance = options.min_separation, .norm = norm_of(options.norm)},
          .max_threads = options.max_threads};
}

TouchstoneImpact impact_of(const fast::CertifiedResult& result) {
  return {static_cast<std::int32_t>(result.verdict), result.toi_lower, result.toi_upper, result.u,
          result.v};
}

Query query_of(const double* coordinates) {
  Query query;
  std::memcpy(&query, &required(coordinates, "coordinates"), sizeof(Query));
  return query;
}

void solve(std::int32_t kind, std::size_t count, const double* coordinates,
           const TouchstoneOptions& options, TouchstoneImpact* impacts) {
  const fast::CertifiedOptions certified = certified_of(options);
  if (count == 1) {
    const Query query = query_of(coordinates);
    required(impacts, "impacts") = impact_of(fast::solve(kind_of(kind), query, certified));
    return;
  }
  const auto queries = copied<Query>(coordinates, count, "coordinates");
  std::vector<fast::CertifiedResult> results(count);
  fast::solve({kind_of(kind), queries}, results, certified);
  if (count > 0) std::ranges::transform(results, &required(impacts, "impacts"), impact_of);
}

void invert(std::int32_t kind, std::size_t count, const double* coordinates,
            const TouchstoneOptions& options, TouchstoneInversion* inversions) {
  if (!is_zero(certified_of(options).separation)) {
    throw std::invalid_argument("a cell has no min_separation");
  }
  const auto cells = copied<Query>(coordinates, count, "coordinates");
  std::vector<fast::Inversion> results(count);
  fast::inversions({cell_kind_of(kind), cells}, results,
                   {.toi_tolerance = options.toi_tolerance,
                    .t_max = options.t_max,
                    .max_threads = options.max_threads});
  if (count == 0) return;
  std::ranges::transform(results, &required(inversions, "inversions"),
                         [](const fast::Inversion& one) {
                           return TouchstoneInversion{static_cast<std::int32_t>(one.verdict),
                                                      one.start, one.toi_lower, one.toi_upper};
                         });
}

TouchstoneDistance distance_of(const fast::Distance& distance) {
  return {distance.lower, distance.upper};
}

void measure(std::int32_t kind, std::size_t count, const double* coordinates, double t,
             std::int32_t norm, std::int32_t max_threads, TouchstoneDistance* distances) {
  // (The function for several queries names the query that is not finite.)
  if (count == 1 && max_threads >= 0 && is_finite(query_of(coordinates))) {
    required(distances, "distances") =
        distance_of(fast::distance(kind_of(kind), query_of(coordinates), t, norm_of(norm)));
    return;
  }
  const auto queries = copied<Query>(coordinates, count, "coordinates");
  std::vector<fast::Distance> results(count);
  fast::distances(kind_of(kind), queries, t, norm_of(norm), results, max_threads);
  if (count > 0) std::ranges::transform(results, &required(distances, "distances"), distance_of);
}

std::vector<fast::GroupSeparation> separations_of(const TouchstoneMesh& mesh) {
  const auto groups = copied<std::array<std::int32_t, 2>>(mesh.separated_groups, mesh.separations,
                                                          "separated_groups");
  const auto distances =
      copied<double>(mesh.group_separations, mesh.separations, "group_separations");
  std::vector<fast::GroupSeparation> result;
  for (std::size_t i = 0; i < groups.size(); ++i) result.push_back({groups[i], distances[i]});
  return result;
}

fast::Mesh elements_of(const TouchstoneMesh& mesh) {
  fast::Mesh result{
      .edges = copied<fast::Edge>(mesh.edge_vertices, mesh.edges, "edge_vertices"),
      .faces = copied<fast::Face>(mesh.face_vertices, mesh.faces, "face_vertices"),
      .points = copied<std::int32_t>(mesh.point_vertices, mesh.points, "point_vertices")};
  for (std::size_t i = 0; i < mesh.cell_lists; ++i) {
    const TouchstoneCells& some = (&required(mesh.cells, "cells"))[i];
    const CellKind kind = cell_kind_of(some.kind);
    const std::size_t numbers = some.count * record_of(kind).point_count;
    if (numbers / record_of(kind).point_count != some.count)
      throw std::length_error("cells: too many");
    result.add_cells(kind, copied<std::int32_t>(some.vertices, numbers, "vertices of cells"));
  }
  return result;
}

fast::CollisionGroups groups_of(const TouchstoneMesh& mesh) {
  fast::CollisionGroups groups{
      .of_vertices = {},
      .apart = copied<std::array<std::int32_t, 2>>(mesh.apart_groups, mesh.apart, "apart_groups"),
      .radii = copied<double>(mesh.group_radii, mesh.radii, "group_radii"),
      .separations = separations_of(mesh)};
  if (mesh.groups != nullptr) {
    groups.of_vertices = copied<std::int32_t>(mesh.groups, mesh.vertices, "groups");
  }
  return groups;
}

std::function<bool(std::int32_t, std::int32_t)> rule_of(const TouchstoneMesh& mesh) {
  if (mesh.can_collide == nullptr) return nullptr;
  return [rule = mesh.can_collide, context = mesh.can_collide_context](
             std::int32_t a, std::int32_t b) { return rule(context, a, b) != 0; };
}

fast::Motion motion_of(const TouchstoneMesh& mesh) {
  if (mesh.degree != 0) {
    const QueryShape shape{.degree = static_cast<std::size_t>(std::max(mesh.degree, 0)),
                           .is_rational = mesh.is_rational != 0};
    require_degree(shape.degree);
    constexpr std::size_t most = 4 * (greatest_degree + 1);
    numbers_of<std::array<double, most>>(mesh.control_points, mesh.vertices, "control_points");
    const std::size_t size = (shape.degree + 1) * shape.numbers_of_point() * mesh.vertices;
    return {shape.degree, shape.is_rational,
            copied<double>(mesh.control_points, size, "control_points")};
  }
  const auto coordinates = [&mesh](const double* numbers, const char* name) {
    return std::span(numbers_of<std::array<double, 3>>(numbers, mesh.vertices, name),
                     3 * mesh.vertices);
  };
  return {coordinates(mesh.before, "before"), coordinates(mesh.after, "after")};
}

fast::Step step_of(const TouchstoneMesh& mesh, const TouchstoneOptions& options) {
  fast::Motion motion = motion_of(mesh);
  return {
      std::move(motion), elements_of(mesh),
      fast::StepOptions{
          .solve = certified_of(options), .groups = groups_of(mesh), .can_collide = rule_of(mesh)}};
}

TouchstonePair pair_of(ContactKind kind, const fast::IndexPair& pair) {
  return {static_cast<std::int32_t>(kind), pair[0], pair[1]};
}

TouchstoneCollision collision_of(const fast::StepCollision& collision) {
  return {pair_of(collision.kind, collision.pair), collision.toi_lower, collision.toi_upper,
          collision.u, collision.v};
}

TouchstoneStepInversion inversion_in_step(const fast::StepInversion& one) {
  return {static_cast<std::int32_t>(AnyKind(one.kind).number()), one.cell, one.start, one.toi_lower,
          one.toi_upper};
}

fast::StepCollision collision_from(const TouchstoneCollision& collision) {
  const auto [kind, first, second] = collision.pair;
  if (kind < TOUCHSTONE_VERTEX_FACE || kind > TOUCHSTONE_VERTEX_VERTEX) {
    throw std::invalid_argument("the kind of a pair is none of TouchstoneKind");
  }
  return {.kind = static_cast<ContactKind>(kind),
          .pair = {first, second},
          .toi_lower = collision.toi_lower,
          .toi_upper = collision.toi_upper,
          .u = collision.u,
          .v = collision.v};
}

TouchstoneActiveContact active_contact_of(const fast::ActiveContact& contact) {
  TouchstoneActiveContact result{.collision = collision_of(contact),
                                 .first = {},
                                 .second = {},
                                 .normal = {},
                                 .point_error = contact.point_error,
                                 .normal_error = contact.normal_error,
                                 .has_side = contact.has_side ? 1 : 0};
  Eigen::Vector3d::Map(result.first) = contact.first;
  Eigen::Vector3d::Map(result.second) = contact.second;
  Eigen::Vector3d::Map(result.normal) = contact.normal;
  return result;
}

/// Fills an array of a step for the caller; `convert` makes its items.
template <class Item, class Given, class Convert>
void refill(std::vector<Item>& array, const std::vector<Given>& given, const Convert& convert) {
  std::vector<Item> items;
  items.reserve(given.size());
  for (const Given& one : given) items.push_back(convert(one));
  array = std::move(items);
}

fast::LineSearchOptions line_search_options_of(const TouchstoneLineSearchOptions& options) {
  if (options.start_distance != TOUCHSTONE_OF_SCENE &&
      options.start_distance != TOUCHSTONE_OF_PAIR) {
    throw std::invalid_argument(
        "start_distance is neither TOUCHSTONE_OF_SCENE nor TOUCHSTONE_OF_PAIR");
  }
  return {.norm = norm_of(options.norm),
          .start_distance = static_cast<fast::StartDistance>(options.start_distance),
          .kept_volume = options.kept_volume};
}

static_assert(static_cast<int>(fast::Verdict::no) == TOUCHSTONE_NO);
static_assert(static_cast<int>(fast::Verdict::yes) == TOUCHSTONE_YES);
static_assert(static_cast<int>(fast::Verdict::error) == TOUCHSTONE_ERROR);
static_assert(static_cast<int>(fast::StartDistance::of_scene) == TOUCHSTONE_OF_SCENE);
static_assert(static_cast<int>(fast::StartDistance::of_pair) == TOUCHSTONE_OF_PAIR);
static_assert(static_cast<int>(fast::LineSearchStatus::whole) == TOUCHSTONE_WHOLE);
static_assert(static_cast<int>(fast::LineSearchStatus::limited) == TOUCHSTONE_LIMITED);
static_assert(static_cast<int>(fast::LineSearchStatus::in_contact) == TOUCHSTONE_IN_CONTACT);
static_assert(static_cast<int>(fast::LineSearchStatus::too_small) == TOUCHSTONE_TOO_SMALL);
static_assert(static_cast<int>(fast::LineSearchStatus::inverted) == TOUCHSTONE_INVERTED);

static_assert(AnyKind(ContactKind::vertex_face).number() == TOUCHSTONE_VERTEX_FACE);
static_assert(AnyKind(ContactKind::edge_edge).number() == TOUCHSTONE_EDGE_EDGE);
static_assert(AnyKind(ContactKind::vertex_edge).number() == TOUCHSTONE_VERTEX_EDGE);
static_assert(AnyKind(ContactKind::vertex_vertex).number() == TOUCHSTONE_VERTEX_VERTEX);
static_assert(AnyKind(cell_kinds.front()).number() == TOUCHSTONE_TETRAHEDRON);

}  // namespace
}  // namespace touchstone::adapters

using namespace touchstone::
    adapters;  // NOLINT(google-build-using-namespace): definitions of C functions

const char* touchstone_version() { return TOUCHSTONE_VERSION; }

const char* touchstone_last_error() { return last_error().c_str(); }

std::int32_t touchstone_solve(std::int32_t kind, std::size_t count, const double* coordinates,
                              const TouchstoneOptions* options, TouchstoneImpact* impacts) {
  return guarded([&] { solve(kind, count, coordinates, given(options), impacts); });
}

std::int32_t touchstone_inversions(std::int32_t kind, std::size_t count, const double* coordinates,
                                   const TouchstoneOptions* options,
                                   TouchstoneInversion* inversions) {
  return guarded([&] { invert(kind, count, coordinates, given(options), inversions); });
}

std::int32_t touchstone_distances(std::int32_t kind, std::size_t count, const double* coordinates,
                                  double t, std::int32_t norm, std::int32_t max_threads,
                                  TouchstoneDistance* distances) {
  return guarded([&] { measure(kind, count, coordinates, t, norm, max_threads, distances); });
}

std::int32_t touchstone_step_new(const TouchstoneMesh* mesh, const TouchstoneOptions* options,
                                 TouchstoneStep** step) {
  return guarded([&] {
    TouchstoneStep*& written = required(step, "step");
    written = new TouchstoneStep{.step = step_of(given(mesh), given(options))};
  });
}

void touchstone_step_free(TouchstoneStep* step) { delete step; }

std::int32_t touchstone_step_is_free(const TouchstoneStep* step, std::int32_t* is_free) {
  return guarded(
      [&] { required(is_free, "is_free") = required(step, "step").step.is_free() ? 1 : 0; });
}

std::int32_t touchstone_step_earliest(const TouchstoneStep* step, TouchstoneImpact* impact) {
  return guarded([&] {
    const auto earliest = required(step, "step").step.earliest();
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
    refill(asked.collisions, asked.step.collisions(), collision_of);
    first = asked.collisions.data();
    number = asked.collisions.size();
  });
}

std::int32_t touchstone_step_inversions(TouchstoneStep* step,
                                        const TouchstoneStepInversion** inversions,
                                        std::size_t* count) {
  return guarded([&] {
    TouchstoneStep& asked = required(step, "step");
    const TouchstoneStepInversion*& first = required(inversions, "inversions");
    std::size_t& number = required(count, "count");
    refill(asked.inversions, asked.step.inversions(), inversion_in_step);
    first = asked.inversions.data();
    number = asked.inversions.size();
  });
}

std::int32_t touchstone_step_contacts(const TouchstoneStep* step,
                                      const TouchstoneCollision* collisions, std::size_t count,
                                      TouchstoneActiveContact* contacts) {
  return guarded([&] {
    const TouchstoneStep& asked = required(step, "step");
    if (count == 0) return;
    const std::span given(&required(collisions, "collisions"), count);
    TouchstoneActiveContact& written = required(contacts, "contacts");
    std::vector<touchstone::fast::StepCollision> converted;
    converted.reserve(count);
    for (const TouchstoneCollision& one : given) converted.push_back(collision_from(one));
    std::ranges::transform(touchstone::fast::contacts_of(asked.step, converted), &written,
                           active_contact_of);
  });
}

std::int32_t touchstone_step_free_step_size(const TouchstoneStep* step, double* alpha) {
  return guarded([&] {
    required(alpha, "alpha") = required(step, "step").step.free_step_size().value_or(-1.0);
  });
}

std::int32_t touchstone_step_least_distance(TouchstoneStep* step, double t, std::int32_t norm,
                                            TouchstoneDistance* distance,
                                            const TouchstonePair** pairs, std::size_t* count) {
  return guarded([&] {
    TouchstoneStep& asked = required(step, "step");
    TouchstoneDistance& least = required(distance, "distance");
    const TouchstonePair*& first = required(pairs, "pairs");
    std::size_t& number = required(count, "count");
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto found = touchstone::fast::least_distance(asked.step, t, norm_of(norm))
                           .value_or(touchstone::fast::LeastDistance{{infinity, infinity}, {}});
    refill(asked.nearest, found.pairs, [](const auto& one) { return pair_of(one.kind, one.pair); });
    least = distance_of(found.distance);
    first = asked.nearest.data();
    number = asked.nearest.size();
  });
}

std::int32_t touchstone_step_active_set(TouchstoneStep* step, double eta, std::int32_t norm,
                                        const TouchstoneActiveContact** contacts,
                                        std::size_t* count) {
  return guarded([&] {
    TouchstoneStep& asked = required(step, "step");
    const TouchstoneActiveContact*& first = required(contacts, "contacts");
    std::size_t& number = required(count, "count");
    refill(asked.active,
           touchstone::fast::active_set(asked.step, {.distance = eta, .norm = norm_of(norm)}),
           active_contact_of);
    first = asked.active.data();
    number = asked.active.size();
  });
}

std::int32_t touchstone_step_line_search_limit(TouchstoneStep* step, double p,
                                               const TouchstoneLineSearchOptions* options,
                                               TouchstoneLineSearchLimit* limit) {
  return guarded([&] {
    TouchstoneStep& asked = required(step, "step");
    TouchstoneLineSearchLimit& written = required(limit, "limit");
    const touchstone::fast::LineSearchLimit found =
        touchstone::fast::line_search_limit(asked.step, p, line_search_options_of(given(options)));
    refill(asked.limiting, found.pairs, collision_of);
    refill(asked.limiting_cells, found.inversions, inversion_in_step);
    written = {static_cast<std::int32_t>(found.status),
               found.step_size,
               distance_of(found.distance),
               asked.limiting.data(),
               asked.limiting.size(),
               asked.limiting_cells.data(),
               asked.limiting_cells.size()};
  });
}
