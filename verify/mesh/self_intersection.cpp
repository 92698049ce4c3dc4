#include "verify/mesh/self_intersection.hpp"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace touchstone::verify::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int32_t>;

/// A closed segment and a point or segment that may be degenerate.
bool segments_meet(const Point& a, const Point& b, const Point& p, const Point& q) {
  if (a == b && p == q) return a == p;
  if (a == b) return Kernel::Segment_3(p, q).has_on(a);
  if (p == q) return Kernel::Segment_3(a, b).has_on(p);
  return CGAL::do_intersect(Kernel::Segment_3(a, b), Kernel::Segment_3(p, q));
}

/// Do a closed segment and the convex hull of three points have a point in common?
bool meets(const Point& a, const Point& b, const std::array<Point, 3>& face) {
  const auto& [p, q, r] = face;
  if (CGAL::collinear(p, q, r)) {
    return segments_meet(a, b, p, q) || segments_meet(a, b, q, r) || segments_meet(a, b, r, p);
  }
  const Kernel::Triangle_3 triangle(p, q, r);
  return a == b ? triangle.has_on(a) : CGAL::do_intersect(Kernel::Segment_3(a, b), triangle);
}

/// Does the segment from the corner v of the triangle v, q, r to w meet it elsewhere too?
bool enters(const Point& v, const Point& q, const Point& r, const Point& w) {
  if (w == v) return false;
  if (CGAL::collinear(v, q, r)) {
    // The triangle is a segment through v, or v itself: they overlap iff w is on the side of one of its ends.
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
         std::span<const fast::Face> faces)
      : edges_(edges), faces_(faces) {
    points_.reserve(static_cast<std::size_t>(vertices.rows()));
    for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
      points_.emplace_back(vertices(i, 0), vertices(i, 1), vertices(i, 2));
    }
  }

  [[nodiscard]] std::vector<Piercing> run(const PiercingFilter& filter) const {
    std::vector<Piercing> found;
    std::vector<Box> edge_boxes = boxes(edges_), face_boxes = boxes(faces_);
    CGAL::box_intersection_d(edge_boxes.begin(), edge_boxes.end(), face_boxes.begin(),
                             face_boxes.end(), [&](const Box& a, const Box& b) {
                               const Piercing pair{.edge = a.info(), .face = b.info()};
                               if (filter && !filter(pair.edge, pair.face)) return;
                               if (pierces(pair)) found.push_back(pair);
                             });
    std::ranges::sort(found);
    return found;
  }

 private:
  template <class Element>
  [[nodiscard]] std::vector<Box> boxes(std::span<const Element> elements) const {
    std::vector<Box> result;
    result.reserve(elements.size());
    for (const Element& element : elements) {
      CGAL::Bbox_3 box;
      for (const std::int32_t vertex : element) box += point(vertex).bbox();
      result.emplace_back(box, static_cast<std::int32_t>(result.size()));
    }
    return result;
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

  std::span<const fast::Edge> edges_;
  std::span<const fast::Face> faces_;
  std::vector<Point> points_;
};

}  // namespace

std::vector<Piercing> find_piercings(const Vertices& vertices, std::span<const fast::Edge> edges,
                                     std::span<const fast::Face> faces,
                                     const PiercingFilter& filter) {
  return Search(vertices, edges, faces).run(filter);
}

}  // namespace touchstone::verify::mesh
