#include "verify/mesh/self_intersection.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <numeric>

#include "touchstone/step.hpp"

namespace touchstone::verify::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

/// A closed segment and a point or segment that may be degenerate.
bool segments_meet(const Point& a, const Point& b, const Point& p, const Point& q) {
  if (a == b && p == q) return a == p;
  if (a == b) return Kernel::Segment_3(p, q).has_on(a);
  if (p == q) return Kernel::Segment_3(a, b).has_on(p);
  return CGAL::do_intersect(Kernel::Segment_3(a, b), Kernel::Segment_3(p, q));
}

/// True if a closed segment and the convex hull of three points have a point in common.
bool meets(const Point& a, const Point& b, const std::array<Point, 3>& face) {
  const auto& [p, q, r] = face;
  if (CGAL::collinear(p, q, r)) {
    return segments_meet(a, b, p, q) || segments_meet(a, b, q, r) || segments_meet(a, b, r, p);
  }
  const Kernel::Triangle_3 triangle(p, q, r);
  return a == b ? triangle.has_on(a) : CGAL::do_intersect(Kernel::Segment_3(a, b), triangle);
}

/// True if the segment from the corner v of the triangle v, q, r to w meets it elsewhere, too.
bool enters(const Point& v, const Point& q, const Point& r, const Point& w) {
  if (w == v) return false;
  if (CGAL::collinear(v, q, r)) {
    // The triangle is a segment through v, or v itself: they overlap iff w is on the side of one of
    // its ends.
    const auto overlaps = [&](const Point& end) {
      return end != v && CGAL::collinear(v, w, end) &&
             !CGAL::collinear_are_strictly_ordered_along_line(w, v, end);
    };
    return overlaps(q) || overlaps(r);
  }
  return CGAL::coplanar(v, q, r, w) && CGAL::coplanar_orientation(v, q, r, w) != CGAL::NEGATIVE &&
         CGAL::coplanar_orientation(v, r, q, w) != CGAL::NEGATIVE;
}

class Search {
 public:
  Search(const Vertices& vertices, std::span<const fast::Edge> edges,
         std::span<const fast::Face> faces, const std::atomic<bool>* stop)
      : vertices_(vertices), edges_(edges), faces_(faces), stop_(stop) {
    points_.reserve(static_cast<std::size_t>(vertices.rows()));
    for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
      points_.emplace_back(vertices(i, 0), vertices(i, 1), vertices(i, 2));
    }
  }

  [[nodiscard]] std::vector<Piercing> run(const PiercingFilter& filter) const {
    if (edges_.empty() || faces_.empty()) return {};
    std::vector<Piercing> found;
    std::mutex mutex;
    for_each_overlap([&](std::span<const Piercing> pairs) {
      std::vector<Piercing> piercing;
      std::ranges::copy_if(pairs, std::back_inserter(piercing), [&](const Piercing& pair) {
        return (!filter || filter(pair.edge, pair.face)) && pierces(pair);
      });
      const std::scoped_lock lock(mutex);
      found.insert(found.end(), piercing.begin(), piercing.end());
    });
    std::ranges::sort(found);
    return found;
  }

 private:
  /// Calls use(pairs) for all pairs whose boxes overlap, some at a time, in several threads at
  /// once: the candidates of a step in which faces rest, and a vertex moves along each edge.
  template <class Use>
  void for_each_overlap(const Use& use) const {
    const auto resting = static_cast<std::int32_t>(vertices_.rows());
    const auto moving = static_cast<Eigen::Index>(edges_.size());
    Vertices before(vertices_.rows() + moving, 3), after(vertices_.rows() + moving, 3);
    before.topRows(resting) = vertices_;
    after.topRows(resting) = vertices_;
    for (Eigen::Index i = 0; i < moving; ++i) {
      const auto [a, b] = edges_[static_cast<std::size_t>(i)];
      before.row(resting + i) = vertices_.row(a);
      after.row(resting + i) = vertices_.row(b);
    }
    std::vector<std::int32_t> groups(static_cast<std::size_t>(before.rows()), 0);
    std::fill(groups.begin() + resting, groups.end(), 1);
    std::vector<std::int32_t> points(edges_.size());
    std::iota(points.begin(), points.end(), resting);
    static constexpr std::array<std::array<std::int32_t, 2>, 2> apart{{{0, 0}, {1, 1}}};
    const fast::MeshElements elements{.edges = {}, .faces = faces_, .points = points};
    const fast::Step step(before, after, elements,
                          {.groups = {.of_vertices = groups, .apart = apart}, .stop = stop_});
    step.candidates([&](const fast::StepCandidates& candidates) {
      // A face that names one vertex three times makes this one a point, which the moving ones are
      // too.
      if (candidates.kind != fast::PairKind::vertex_face) return;
      std::vector<Piercing> pairs;
      for (const auto& [vertex, face] : candidates.pairs) {
        pairs.push_back({.edge = vertex - resting, .face = face});
      }
      use(std::span<const Piercing>(pairs));
    });
  }

  [[nodiscard]] bool pierces(const Piercing& pair) const {
    const auto [a, b] = edges_[static_cast<std::size_t>(pair.edge)];
    const fast::Face& face = faces_[static_cast<std::size_t>(pair.face)];
    const auto at_a = std::ranges::find(face, a), at_b = std::ranges::find(face, b);
    if (at_a != face.end() && at_b != face.end()) return false;
    if (at_a != face.end())
      return enters_face(face, static_cast<std::size_t>(at_a - face.begin()), b);
    if (at_b != face.end())
      return enters_face(face, static_cast<std::size_t>(at_b - face.begin()), a);
    return meets(point(a), point(b), {point(face[0]), point(face[1]), point(face[2])});
  }

  [[nodiscard]] bool enters_face(const fast::Face& face, std::size_t corner,
                                 std::int32_t other) const {
    return enters(point(face[corner]), point(face[(corner + 1) % 3]), point(face[(corner + 2) % 3]),
                  point(other));
  }

  [[nodiscard]] const Point& point(std::int32_t vertex) const {
    return points_[static_cast<std::size_t>(vertex)];
  }

  const Vertices& vertices_;
  std::span<const fast::Edge> edges_;
  std::span<const fast::Face> faces_;
  const std::atomic<bool>* stop_;
  std::vector<Point> points_;
};

}  // namespace

std::vector<Piercing> find_piercings(const Vertices& vertices, std::span<const fast::Edge> edges,
                                     std::span<const fast::Face> faces,
                                     const PiercingFilter& filter, const std::atomic<bool>* stop) {
  return Search(vertices, edges, faces, stop).run(filter);
}

}  // namespace touchstone::verify::mesh
