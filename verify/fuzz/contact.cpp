#include "verify/fuzz/contact.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "touchstone/mesh.hpp"
#include "verify/generate/draws.hpp"
#include "verify/generate/symmetry.hpp"

namespace touchstone::verify::fuzz {
namespace {

namespace draws = generate::draws;
using draws::below;
using draws::one_in;
using generate::Random;

using Vector = Eigen::Vector3d;

/// The query under a random symmetry that keeps distances and the time.
Query turned(ContactKind kind, const Query& query, Random& random) {
  // A positive distance excludes symmetries that do not keep distances.
  generate::Symmetry symmetry =
      generate::draw_symmetry(kind, query, {.distance = 1.0, .norm = Norm::linf}, random);
  symmetry.reversed = false;
  return image(symmetry, query).value_or(query);
}

// ---- On a grid ----------------------------------------------------------------------------------

/// Vectors of integers below 2^bits, with occasional zeros: few, because motion in a plane takes
/// the judge long.
class Grid {
 public:
  Grid(Random& random, int bits) : random_(random), bound_(std::int64_t{1} << bits) {}

  [[nodiscard]] Vector draw() {
    Vector vector = Vector::Zero();
    for (double& x : vector) {
      if (!one_in(random_, 24)) x = static_cast<double>(random_.between(-bound_, bound_));
    }
    return one_in(random_, 24) ? Vector(Vector::Zero()) : vector;
  }

 private:
  Random& random_;
  std::int64_t bound_;
};

int draw_bits(Random& random) {
  static constexpr std::array<int, 8> bits{1, 2, 3, 5, 12, 24, 40, 47};
  return bits.at(below(random, bits.size()));
}

/// The four points at the time of contact.
std::array<Vector, moving_points> touching_points(ContactKind kind, Random& random) {
  Grid places(random, draw_bits(random)), shapes(random, draw_bits(random));
  const auto m = static_cast<std::int64_t>(1 + below(random, 6));
  const Vector p = places.draw(), a = shapes.draw(), b = shapes.draw();
  const std::int64_t i = random.between(0, m);
  const std::int64_t j = random.between(0, kind == ContactKind::vertex_face ? m - i : m);
  const auto times = [](std::int64_t factor, const Vector& vector) -> Vector {
    return static_cast<double>(factor) * vector;
  };
  if (kind == ContactKind::vertex_face) {
    return {p + times(i, a) + times(j, b), p, p + times(m, a), p + times(m, b)};
  }
  return {p - times(i, a), p + times(m - i, a), p - times(j, b), p + times(m - j, b)};
}

std::array<Vector, moving_points> draw_velocities(ContactKind kind, Random& random) {
  Grid velocities(random, draw_bits(random));
  std::array<Vector, moving_points> result{};
  for (Vector& velocity : result) velocity = velocities.draw();
  if (one_in(random, 3)) {
    const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
    for (std::size_t point = 0; point < moving_points; ++point) {
      result.at(point) = result.at(point < second ? 0 : second);
    }
  }
  return result;
}

// ---- Level --------------------------------------------------------------------------------------

/// The relative position of the projections.
enum class Spot : std::uint8_t { inside, side, corner };

/// Takes a list in braces, in which the order of draws is defined.
void put_plane(Query& query, std::size_t end, std::size_t point, const std::array<double, 2>& xy) {
  query.at(end, point, 0) = xy[0];
  query.at(end, point, 1) = xy[1];
}

/// The vertex above the triangle: within x + y < 1 and right of and above its legs.
void put_vertex_over_face(Query& query, std::size_t end, Spot spot, Random& random) {
  const double left = random.uniform(-4.0, -2.0);
  const bool level_side = spot != Spot::inside;
  put_plane(query, end, 1, {left, random.uniform(-4.0, -2.0)});
  put_plane(query, end, 2, {random.uniform(5.0, 8.0), random.uniform(-4.0, -2.0)});
  put_plane(query, end, 3,
            {level_side ? left : random.uniform(-4.0, -2.0), random.uniform(5.0, 8.0)});
  put_plane(query, end, 0,
            {level_side ? left : random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)});
  if (spot == Spot::corner) put_plane(query, end, 0, {left, query.at(end, 1, 1)});
}

/// Edge a along x across edge b along y.
void put_edge_over_edge(Query& query, std::size_t end, Spot spot, Random& random) {
  const double x = random.uniform(-0.4, 0.4);
  const bool level_side = spot != Spot::inside;
  put_plane(query, end, 0,
            {level_side ? x : random.uniform(-4.0, -1.0), random.uniform(-0.4, 0.4)});
  put_plane(query, end, 1, {random.uniform(1.0, 4.0), random.uniform(-0.4, 0.4)});
  put_plane(query, end, 2, {x, random.uniform(-4.0, -1.0)});
  put_plane(query, end, 3, {level_side ? x : random.uniform(-0.4, 0.4), random.uniform(1.0, 4.0)});
  if (spot == Spot::corner) put_plane(query, end, 0, {x, query.at(end, 2, 1)});
}

/// Projections that meet at all times, at height 0.
Query draw_plan(ContactKind kind, Random& random) {
  Query query{};
  const auto spot = static_cast<Spot>(below(random, 3));
  for (std::size_t end = 0; end < 2; ++end) {
    if (kind == ContactKind::vertex_face) {
      put_vertex_over_face(query, end, spot, random);
    } else {
      put_edge_over_edge(query, end, spot, random);
    }
  }
  return query;
}

/// Heights whose difference has a zero in [0,1]: inside, at an end, or everywhere.
struct Heights {
  std::array<double, 2> first;
  std::array<double, 2> second;
};

Heights draw_heights(Random& random) {
  const double middle = one_in(random, 2) ? 0.0 : random.uniform(-4.0, 4.0);
  const auto off = [&] {
    const double step = draws::power_of_two(-static_cast<int>(below(random, 40)));
    return one_in(random, 5) ? 0.0 : random.uniform(0.0, 1.0) * step;
  };
  const bool downward = random.coin();
  const double sign = downward ? 1.0 : -1.0;
  const double start = random.uniform(-1.0, 1.0), end = random.uniform(-1.0, 1.0);
  return {.first = {middle + start + sign * off(), middle + end - sign * off()},
          .second = {middle + start, middle + end}};
}

void put_heights(ContactKind kind, const Heights& heights, Query& query) {
  const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      query.at(end, point, 2) = point < second ? heights.first.at(end) : heights.second.at(end);
    }
  }
}

// ---- Rounded, apart -----------------------------------------------------------------------------

Vector linear(double s, const Vector& a, double t, const Vector& b) { return s * a + t * b; }

/// The position of point 0 with F = 0 at the time of these places. \pre u < 1 for edges
Vector aim(ContactKind kind, const std::array<Vector, moving_points>& at_t, double u, double v) {
  if (kind == ContactKind::vertex_face) {
    return (1.0 - u - v) * at_t[1] + (u * at_t[2] + v * at_t[3]);
  }
  const Vector on_b = linear(1.0 - v, at_t[2], v, at_t[3]);
  return (1.0 / (1.0 - u)) * (on_b - u * at_t[1]);
}

/// A vector with the separation's distance as its norm, up to rounding.
Vector draw_offset(const Separation& separation, Random& random) {
  // (2,3,6) and (1,2,2) have lengths 7 and 3; (7,7,−2) has length 7 in L∞.
  static const std::array<Vector, 3> of_l2{{{2.0, 3.0, 6.0}, {1.0, 2.0, 2.0}, {0.0, 3.0, 4.0}}};
  static constexpr std::array<double, 3> lengths{7.0, 3.0, 5.0};
  const double d = separation.distance;
  if (random.coin()) return {0.0, 0.0, random.coin() ? d : -d};
  if (separation.norm == Norm::linf) {
    return {random.uniform(-1.0, 1.0) * d, random.coin() ? d : random.uniform(-1.0, 1.0) * d, d};
  }
  const std::size_t choice = below(random, of_l2.size());
  return (d / lengths.at(choice)) * of_l2.at(choice);
}

/// Level primitives that come to the distance at an end, or stay there.
Query hovering(ContactKind kind, const Separation& separation, Random& random) {
  Query query = draw_plan(kind, random);
  const double d = separation.distance;
  const double size = std::min(d, 0x1p1000) * static_cast<double>(1U << below(random, 12));
  draws::multiply(query, {size, size, size});
  // A third, so that the sum has to be rounded for a power of two too.
  const double height = one_in(random, 2) ? 0.0 : random.uniform(-1.0, 4.0) / 3.0 * d;
  std::array<double, 2> above{height + d, height + d};
  const std::size_t end = below(random, 2);
  if (!one_in(random, 4)) above.at(end) = height + d * random.uniform(1.0, 2.0);
  put_heights(kind, {.first = above, .second = {height, height}}, query);
  return is_finite(query) ? turned(kind, query, random) : level_contact(kind, random);
}

}  // namespace

Query grid_contact(ContactKind kind, Random& random) {
  const auto k = static_cast<int>(below(random, 4));
  const auto denominator = static_cast<double>(1 << k);
  const auto n = static_cast<double>(random.between(0, 1 << k));
  const auto points = touching_points(kind, random);
  const auto velocities = draw_velocities(kind, random);
  Query query{};
  for (std::size_t point = 0; point < moving_points; ++point) {
    point_of(query, 0, point) = points.at(point) - n * velocities.at(point);
    point_of(query, 1, point) = points.at(point) + (denominator - n) * velocities.at(point);
  }
  const auto factor = [&random] {
    return draws::power_of_two(static_cast<int>(random.between(-50, 10)));
  };
  const double common = factor();
  const std::array<double, 3> factors = one_in(random, 3) ? std::array{factor(), factor(), factor()}
                                                          : std::array{common, common, common};
  draws::multiply(query, factors);
  return query;
}

Query level_contact(ContactKind kind, Random& random) {
  Query query = draw_plan(kind, random);
  if (one_in(random, 6)) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      point_of(query, 1, point) = point_of(query, 0, point);
    }
  }
  put_heights(kind, draw_heights(random), query);
  draws::multiply(query, draws::scales(random));
  return turned(kind, query, random);
}

Query rounded_contact(ContactKind kind, Random& random) {
  Query query{};
  for (double& x : query.coordinates) x = random.uniform(-1.0, 1.0);
  const double t = one_in(random, 4) ? 1.0 : random.uniform(0.125, 1.0);
  double u = one_in(random, 4) ? 0.0 : random.uniform(0.0, 0.75);
  double v = one_in(random, 4)
                 ? 0.0
                 : random.uniform(0.0, kind == ContactKind::vertex_face ? 1.0 - u : 1.0);
  if (one_in(random, 8)) v = kind == ContactKind::vertex_face ? 1.0 - u : 1.0;
  std::array<Vector, moving_points> at_t{};
  for (std::size_t point = 1; point < moving_points; ++point) {
    at_t.at(point) = linear(1.0 - t, point_of(query, 0, point), t, point_of(query, 1, point));
  }
  const Vector target = aim(kind, at_t, u, v);
  point_of(query, 1, 0) = (1.0 / t) * (target - (1.0 - t) * point_of(query, 0, 0));
  draws::multiply(query, draws::scales(random));
  return turned(kind, query, random);
}

Query contact_apart(ContactKind kind, const Separation& separation, Random& random) {
  if (random.coin()) return hovering(kind, separation, random);
  Query query = random.coin() ? level_contact(kind, random) : grid_contact(kind, random);
  // The size of the scene relative to the distance: from one to a million.
  double greatest = 0.0;
  for (const double x : query.coordinates) greatest = std::max(greatest, std::abs(x));
  if (greatest > 0.0 && !one_in(random, 4)) {
    const int exponent = std::ilogb(separation.distance) - std::ilogb(greatest) +
                         static_cast<int>(random.between(0, 20));
    Query scaled = query;
    for (double& x : scaled.coordinates) x = std::ldexp(x, exponent);
    if (is_finite(scaled)) query = scaled;
  }
  const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
  const Vector offset = draw_offset(separation, random);
  Query moved = query;
  for (std::size_t end = 0; end < 2; ++end) {
    if (one_in(random, 3)) continue;
    for (std::size_t point = 0; point < second; ++point) {
      point_of(moved, end, point) = point_of(query, end, point) + offset;
    }
  }
  return is_finite(moved) ? moved : query;
}

}  // namespace touchstone::verify::fuzz
