/// \file
/// The certified solver in place of the solver of the templates' reader.

#include "examples/plugin/your_solver.hpp"

#include <cstddef>

#include "touchstone/certified.hpp"
#include "touchstone/inversion.hpp"

namespace yours {
namespace {

using touchstone::CellKind;
using touchstone::ContactKind;
using touchstone::Query;
using touchstone::fast::CertifiedResult;
using touchstone::fast::Inversion;
using touchstone::fast::Verdict;

/// The query whose coordinates at(point, end, axis) gives.
template <class At>
Query query_with(const At& at) {
  Query query{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    query.coordinates.at(i) = static_cast<double>(at(i / 3 % 4, i / 12, i % 3));
  }
  return query;
}

template <class Points>
Query query_of(const Points& start, const Points& end) {
  return query_with([&](std::size_t point, std::size_t when, std::size_t axis) {
    return when == 0 ? start[point][axis] : end[point][axis];
  });
}

template <class Points>
CertifiedResult solve(ContactKind kind, const Points& start, const Points& end) {
  return touchstone::fast::solve(kind, query_of(start, end), {});
}

CertifiedResult solve(ContactKind kind, const Trajectories& points) {
  const Query query = query_with([&](std::size_t point, std::size_t when, std::size_t axis) {
    return points[point][when][axis];
  });
  return touchstone::fast::solve(kind, query, {});
}

Inversion solve(CellKind kind, const Points& start, const Points& end) {
  return touchstone::fast::inversion(kind, query_of(start, end), {});
}

template <class Result, class Time>
bool note(const Result& result, Time& toi) {
  toi = static_cast<Time>(result.toi_lower);
  return result.verdict == Verdict::yes;
}

}  // namespace

bool vertex_face(const Points& start, const Points& end) {
  return solve(ContactKind::vertex_face, start, end).verdict == Verdict::yes;
}
bool edge_edge(const Points& start, const Points& end) {
  return solve(ContactKind::edge_edge, start, end).verdict == Verdict::yes;
}

bool vertex_face(const Points& start, const Points& end, double& toi) {
  return note(solve(ContactKind::vertex_face, start, end), toi);
}
bool edge_edge(const Points& start, const Points& end, double& toi) {
  return note(solve(ContactKind::edge_edge, start, end), toi);
}

bool vertex_face(const FloatPoints& start, const FloatPoints& end, float& toi) {
  return note(solve(ContactKind::vertex_face, start, end), toi);
}
bool edge_edge(const FloatPoints& start, const FloatPoints& end, float& toi) {
  return note(solve(ContactKind::edge_edge, start, end), toi);
}

bool vertex_face(const Trajectories& points, double& toi) {
  return note(solve(ContactKind::vertex_face, points), toi);
}
bool edge_edge(const Trajectories& points, double& toi) {
  return note(solve(ContactKind::edge_edge, points), toi);
}

bool tetrahedron(const Points& start, const Points& end, double& toi) {
  return note(solve(CellKind::tetrahedron, start, end), toi);
}
bool plane_triangle(const Points& start, const Points& end, double& toi) {
  return note(solve(CellKind::plane_triangle, start, end), toi);
}

}  // namespace yours
