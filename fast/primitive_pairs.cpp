#include "touchstone/certified.hpp"

#include <algorithm>

namespace touchstone::fast {
namespace {

using Points = std::array<const Point*, query_points>;

Query query_of(const Points& points) {
  Query query;
  double* to = query.coordinates.data();
  for (const Point* const point : points) to = std::ranges::copy(point->coordinates, to).out;
  return query;
}

}  // namespace

CertifiedResult solve_vertex_face(const Point& p_t0, const Point& t0_t0, const Point& t1_t0,
                                  const Point& t2_t0, const Point& p_t1, const Point& t0_t1,
                                  const Point& t1_t1, const Point& t2_t1,
                                  const CertifiedOptions& options) {
  const Points points{&p_t0, &t0_t0, &t1_t0, &t2_t0, &p_t1, &t0_t1, &t1_t1, &t2_t1};
  return solve(ContactKind::vertex_face, query_of(points), options);
}

CertifiedResult solve_edge_edge(const Point& ea0_t0, const Point& ea1_t0, const Point& eb0_t0,
                                const Point& eb1_t0, const Point& ea0_t1, const Point& ea1_t1,
                                const Point& eb0_t1, const Point& eb1_t1,
                                const CertifiedOptions& options) {
  const Points points{&ea0_t0, &ea1_t0, &eb0_t0, &eb1_t0, &ea0_t1, &ea1_t1, &eb0_t1, &eb1_t1};
  return solve(ContactKind::edge_edge, query_of(points), options);
}

CertifiedResult solve_vertex_edge(const Point& p_t0, const Point& e0_t0, const Point& e1_t0,
                                  const Point& p_t1, const Point& e0_t1, const Point& e1_t1,
                                  const CertifiedOptions& options) {
  CertifiedResult result = solve_vertex_face(p_t0, e0_t0, e1_t0, e0_t0,  //
                                             p_t1, e0_t1, e1_t1, e0_t1, options);
  if (result.verdict == Verdict::yes) result.v = 0.0;
  return result;
}

CertifiedResult solve_vertex_vertex(const Point& p0_t0, const Point& p1_t0, const Point& p0_t1,
                                    const Point& p1_t1, const CertifiedOptions& options) {
  CertifiedResult result = solve_vertex_face(p0_t0, p1_t0, p1_t0, p1_t0,  //
                                             p0_t1, p1_t1, p1_t1, p1_t1, options);
  if (result.verdict == Verdict::yes) result.u = result.v = 0.0;
  return result;
}

}  // namespace touchstone::fast
