/// \file
/// The certified solver in place of the solver of the templates' reader.

#include "examples/plugin/your_solver.hpp"

#include <cstddef>

#include "touchstone/certified.hpp"

namespace yours {
namespace {

using touchstone::Kind;
using touchstone::Query;
using touchstone::fast::CertifiedResult;
using touchstone::fast::Verdict;

/// Solves the query whose coordinates at(point, end, axis) gives.
template <class At>
CertifiedResult solve(Kind kind, const At& at) {
  Query query{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    query.coordinates.at(i) = static_cast<double>(at(i / 3 % 4, i / 12, i % 3));
  }
  return touchstone::fast::solve(kind, query, {});
}

template <class Points>
CertifiedResult solve(Kind kind, const Points& start, const Points& end) {
  return solve(kind, [&](std::size_t point, std::size_t when, std::size_t axis) {
    return when == 0 ? start[point][axis] : end[point][axis];
  });
}

template <class Time>
bool note(const CertifiedResult& result, Time& toi) {
  toi = static_cast<Time>(result.toi_lower);
  return result.verdict == Verdict::yes;
}

CertifiedResult solve(Kind kind, const Trajectories& points) {
  return solve(kind, [&](std::size_t point, std::size_t when, std::size_t axis) {
    return points[point][when][axis];
  });
}

}  // namespace

bool vertex_face(const Points& start, const Points& end) {
  return solve(Kind::vertex_face, start, end).verdict == Verdict::yes;
}
bool edge_edge(const Points& start, const Points& end) {
  return solve(Kind::edge_edge, start, end).verdict == Verdict::yes;
}

bool vertex_face(const Points& start, const Points& end, double& toi) {
  return note(solve(Kind::vertex_face, start, end), toi);
}
bool edge_edge(const Points& start, const Points& end, double& toi) {
  return note(solve(Kind::edge_edge, start, end), toi);
}

bool vertex_face(const FloatPoints& start, const FloatPoints& end, float& toi) {
  return note(solve(Kind::vertex_face, start, end), toi);
}
bool edge_edge(const FloatPoints& start, const FloatPoints& end, float& toi) {
  return note(solve(Kind::edge_edge, start, end), toi);
}

bool vertex_face(const Trajectories& points, double& toi) {
  return note(solve(Kind::vertex_face, points), toi);
}
bool edge_edge(const Trajectories& points, double& toi) {
  return note(solve(Kind::edge_edge, points), toi);
}

bool tetrahedron(const Points& start, const Points& end, double& toi) {
  return note(solve(Kind::tetrahedron, start, end), toi);
}
bool plane_triangle(const Points& start, const Points& end, double& toi) {
  return note(solve(Kind::plane_triangle, start, end), toi);
}

}  // namespace yours
