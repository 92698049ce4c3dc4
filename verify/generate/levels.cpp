#include "verify/generate/levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "verify/generate/curved_families.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/grid.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {
namespace {

/// Numbers of the families, in their order.
enum class Order : std::uint8_t { near, parallel, far, near_on_curves, end, decimal_end };

constexpr std::array<LevelFamily, 6> list{{{"near", "2^-4L sizes apart, or an overlap of as much"},
                                           {"parallel", "a tangent of 2^-3L"},
                                           {"far", "2^3L sizes from the origin"},
                                           {"near-on-curves", "2^(2-3L) apart, or an overlap"},
                                           {"end-contact", "coordinates up to 10^(L-4)"},
                                           {"decimal-end-contact", "the same in decimals"}}};

/// The matrix times a vector.
template <class Number>
std::array<Number, 3> turned(const std::array<Number, 3>& at) {
  const auto& [x, y, z] = at;
  return {2 * x - 2 * y + z, x + 2 * y + 2 * z, 2 * x + y - 2 * z};
}

// ---- Straight lines -----------------------------------------------------------------------------

class LevelScene {
 public:
  LevelScene(Order family, ContactKind kind, int level, bool collides, Random& random)
      : family_(family), kind_(kind), level_(level), collides_(collides), random_(random) {
    log_size_ = family == Order::far ? log_frame - 3 * level - 1 : log_frame;
    size_ = std::int64_t{1} << log_size_;
    gap_ = family == Order::near ? size_ >> (4 * level) : size_ / 8;
    if (kind == ContactKind::vertex_face) {
      place_triangle();
    } else {
      place_edges();
    }
    move_all();
  }

  [[nodiscard]] Query query() const {
    Query result{};
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        const Vector place = turned(points_.at(end).at(point));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          result.at(end, point, axis) = std::ldexp(static_cast<double>(place.at(axis)), -log_size_);
        }
      }
    }
    return result;
  }

 private:
  static constexpr int log_frame = 50;

  /// Between two fractions of a length.
  std::int64_t draw(double low, double high, std::int64_t length) {
    const auto part = [&](double fraction) {
      return std::llround(fraction * static_cast<double>(length));
    };
    return random_.between(part(low), part(high));
  }
  std::int64_t draw(double low, double high) { return draw(low, high, size_); }
  std::int64_t by_angle(std::int64_t length) const { return length >> (3 * level_); }

  /// Puts a point in the plane, with drift along x.
  void put(std::size_t point, std::int64_t x, std::int64_t y) {
    points_[0].at(point) = {x, y, 0};
    points_[1].at(point) = {x + draw(-0.05, 0.05), y, 0};
  }

  /// Gives the first primitive its heights. It ends above the plane by `rest`, or below it.
  void let_down(std::int64_t rest) {
    const std::int64_t start = rest < 0 && family_ != Order::near ? -rest : draw(0.4, 0.6);
    for (std::size_t point = 0; point < (kind_ == ContactKind::vertex_face ? 1U : 2U); ++point) {
      points_[0].at(point)[2] = start;
      points_[1].at(point)[2] = rest;
    }
  }

  /// True to miss beside the border, or to overlap it, instead of above the plane.
  bool is_beside() { return family_ == Order::parallel || (random_.coin() && may_graze()); }
  [[nodiscard]] bool may_graze() const { return !collides_ || family_ == Order::near; }

  /// With its side along x; the vertex over the inside, or beside that side. It slides along x if
  /// it is nearly parallel.
  void place_triangle() {
    const std::int64_t side = -size_ / 4;
    put(1, draw(-0.55, -0.45), side);
    put(2, draw(0.45, 0.55), side);
    put(3, draw(-0.05, 0.05), size_ / 2);
    const bool beside = is_beside() && !(family_ == Order::parallel && collides_);
    put(0, draw(-0.05, 0.05), beside ? side + (collides_ ? gap_ : -gap_) : draw(-0.1, 0.1));
    if (family_ == Order::parallel) {
      const std::int64_t reach = size_ / 2;
      points_[0][0][0] = -reach;
      points_[1][0][0] = reach;
      let_down(-by_angle(reach));
    } else {
      let_down(beside ? -draw(0.4, 0.6) : collides_ ? -gap_ : gap_);
    }
  }

  /// Edge b along x, edge a across it, or with one end beside it.
  void place_edges() {
    put(2, draw(-0.55, -0.45), 0);
    put(3, draw(0.45, 0.55), 0);
    const bool is_parallel = family_ == Order::parallel;
    const std::int64_t along = is_parallel ? draw(0.8, 0.8) : draw(-0.4, 0.4);
    const std::int64_t across = is_parallel ? by_angle(along) : draw(0.8, 0.8);
    const bool beside = is_beside() && !(is_parallel && collides_);
    const double part = 0.35 + 0.3 * random_.unit();
    const std::int64_t gap = is_parallel ? across / 4 : gap_;
    const std::int64_t x = beside && !is_parallel ? draw(-0.1, 0.1) : -draw(part, part, along);
    const std::int64_t y = beside ? (collides_ ? -gap : gap) : -draw(part, part, across);
    put(0, x, y);
    put(1, x + along, y + across);
    let_down(beside || is_parallel ? -draw(0.4, 0.6) : collides_ ? -gap_ : gap_);
  }

  /// Moves all points away from the origin, with a common motion.
  void move_all() {
    const std::int64_t offset = family_ == Order::far ? size_ << (3 * level_) : size_ / 4;
    const auto away = [&] {
      const std::int64_t length = draw(0.5, 1.0, offset);
      return random_.coin() ? length : -length;
    };
    const Vector start{away(), away(), away()};
    Vector end = start;
    for (std::int64_t& component : end) component += draw(-0.1, 0.1);
    for (Vector& point : points_[0]) point = point + start;
    for (Vector& point : points_[1]) point = point + end;
  }

  Order family_;
  ContactKind kind_;
  int level_;
  bool collides_;
  Random& random_;
  int log_size_ = 0;
  std::int64_t size_ = 0;
  std::int64_t gap_ = 0;
  /// At both ends of the motion.
  std::array<std::array<Vector, moving_points>, 2> points_{};
};

Query straight_query(Order family, ContactKind kind, int level, bool collides, Random& random) {
  Query query = LevelScene(family, kind, level, collides, random).query();
  apply_random_symmetry(kind, random, query);
  return query;
}

// ---- Curves -------------------------------------------------------------------------------------

base::AnyQuery curved_query(ContactKind kind, int level, bool collides, Random& random) {
  const double sign = random.coin() ? 1.0 : -1.0, a = static_cast<double>(random.between(1, 7));
  const double gap = std::ldexp(collides ? -1.0 : 1.0, 2 - 3 * level);
  const std::array<double, 3> square{a * a, -a * (8.0 - a), (8.0 - a) * (8.0 - a)};
  constexpr std::int64_t reach = std::int64_t{1} << 41U;
  std::vector<double> numbers;
  for (const double control : square) {
    std::array<double, 3> moved{};
    for (double& x : moved) x = static_cast<double>(random.between(-reach, reach)) * 0x1p-38;
    for (std::array<double, 3> point : above(kind, sign * (control + gap))) {
      for (std::size_t axis = 0; axis < 3; ++axis) point.at(axis) += moved.at(axis);
      for (const double x : turned(point)) numbers.push_back(x);
    }
  }
  return {{.kind = kind, .degree = 2}, numbers};
}

// ---- Contacts at t=1 ----------------------------------------------------------------------------

/// A quotient of whole numbers is rounded like the decimal.
double end_coordinate(double scale, bool two_decimals, Random& random) {
  if (!two_decimals) return scale * (2.0 * random.unit() - 1.0);
  const double parts = std::round(100.0 / std::min(scale, 1.0));
  const auto most = static_cast<std::int64_t>(std::round(scale * parts));
  return static_cast<double>(random.between(-most, most)) / parts;
}

Query end_query(ContactKind kind, int level, bool two_decimals, Random& random) {
  constexpr std::array<double, greatest_level> scales{1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2,
                                                      1e3,  1e4,  1e5,  1e6, 1e7, 1e8};
  const double scale = scales.at(static_cast<std::size_t>(level - 1));
  Query query{};
  for (double& x : query.coordinates) x = end_coordinate(scale, two_decimals, random);
  const bool has_face = kind == ContactKind::vertex_face;
  const auto first = static_cast<std::size_t>(has_face ? 0 : random.between(0, 1));
  const auto second =
      static_cast<std::size_t>(has_face ? random.between(1, 3) : random.between(2, 3));
  for (std::size_t axis = 0; axis < 3; ++axis) query.at(1, first, axis) = query.at(1, second, axis);
  return query;
}

}  // namespace

std::span<const LevelFamily> level_families() { return list; }

const LevelFamily& level_family(std::string_view name) {
  std::string names;
  for (const LevelFamily& family : list) {
    if (family.name == name) return family;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", family.name);
  }
  throw std::invalid_argument(
      fmt::format("no family of growing difficulty is called {} (there are: {})", name, names));
}

data::QueryGroup level_group(const LevelFamily& family, ContactKind kind, int level,
                             std::uint64_t seed, std::uint64_t count) {
  const auto number = static_cast<Order>(&family - list.data());
  const bool is_end = number == Order::end || number == Order::decimal_end;
  // The contacts are the same at all scales.
  Random random(is_end ? mix(seed ^ hash("end contacts"))
                       : mix(mix(seed ^ hash(family.name)) + static_cast<std::uint64_t>(level)));
  const auto draw = [&](std::uint64_t index) -> data::RecordedQuery {
    const bool collides = is_end || index % 2 == 0;
    data::RecordedQuery made{
        .query = {}, .index = index, .collides = collides, .toi = std::nullopt};
    if (is_end) {
      made.query = {kind, end_query(kind, level, number == Order::decimal_end, random)};
    } else if (number == Order::near_on_curves) {
      made.query = curved_query(kind, level, collides, random);
    } else {
      made.query = {kind, straight_query(number, kind, level, collides, random)};
    }
    return made;
  };
  const AnyShape shape{.kind = kind, .degree = number == Order::near_on_curves ? 2U : 1U};
  data::QueryGroup group(std::string(family.name), shape);
  group.read(
      *open_drawn({group.name(), shape}, count, draw), [](double) {}, [] { return false; });
  return group;
}

}  // namespace touchstone::verify::generate
