#include "verify/generate/hardness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include "touchstone/certified.hpp"
#include "verify/generate/curved_families.hpp"
#include "verify/generate/everyday.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/grid.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {
namespace {

/// The base-2 logarithm of the maximum size of the frame. Its coordinates are up to 1.6 times the
/// size.
constexpr int log_frame = 50;
constexpr double greatest_distance = 0x1p14;
constexpr int most_attempts = 16;

/// Numbers of the kinds of difficulty, in their order.
struct Index {
  enum : std::size_t {
    distance,
    aspect,
    angle,
    speed,
    offset,
    scale,
    everyday_scale,
    digits,
    ends,
    frame,
    curve_distance,
    rotation_distance,
    curve_degree
  };
};

const std::array<Hardness, 13>& table() {
  static const std::array<Hardness, 13> list{{
      {"distance",
       "distance to contact, in sizes",
       "At the nearest they are so far apart, or overlap by so little: the motion ends there, or "
       "one passes beside the other's border.",
       {-1, -5, -10, -15, -20, -25, -30, -35, -40, -45, -50}},
      {"aspect",
       "triangle: height by longest side; edges: shorter by longer",
       "Needles, and edges of very different length.",
       {0, -4, -8, -12, -16, -20, -24, -28, -32, -36, -40}},
      {"angle",
       "tangent of the angle to parallel",
       "Edges that are nearly parallel; a vertex that moves nearly along the plane of the "
       "triangle.",
       {-1, -4, -8, -12, -16, -20, -24, -28, -32, -36, -40}},
      {"speed",
       "relative motion, in sizes",
       "Slow and fast motion, of the first primitive.",
       {-40, -32, -24, -16, -8, 0, 8, 16, 24, 32, 40}},
      {"offset",
       "distance from the origin, in sizes",
       "Few bits of the coordinates are left for the shape.",
       {0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40}},
      {"scale",
       "factor of all coordinates, and of the separation",
       "From near the smallest doubles to near the greatest.",
       {-1000, -800, -600, -400, -200, 0, 200, 400, 600, 800, 1000}},
      {"everyday-scale",
       "factor of all coordinates, and of the separation",
       "Contacts at the ends of the step, in decimals times a power of two.",
       {-20, -16, -12, -8, -4, 0, 4, 8, 12, 16, 20}},
      {"digits",
       "significant digits of coordinates",
       "Contacts at the ends of the step, in decimals of so many digits.",
       {1, 2, 3, 4, 5, 6, 7, 9, 11, 13, 15},
       LevelUnit::digits},
      {"ends",
       "share of contacts at t=0 and t=1, of the collisions",
       "Other collisions cross in the middle of the step.",
       {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100},
       LevelUnit::percent},
      {"frame",
       "offset of the local frame, in sizes",
       "Contacts at the ends of the step, in decimals to which an offset is added and rounded.",
       {0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40}},
      {"curve-distance",
       "distance to contact, in sizes",
       "Cubic curves: at the nearest they are so far apart, or overlap by so little.",
       {-8, -11, -14, -17, -20, -23, -26, -29, -32, -35, -38}},
      {"rotation-distance",
       "distance to contact, by the radius",
       "Rotations as rational curves: at the nearest they are so far apart, or overlap by so "
       "little.",
       {-6, -9, -12, -15, -18, -21, -24, -27, -30, -33, -36}},
      {"curve-degree",
       "degree of the curves",
       "They touch at one time, or are 2^-20 sizes apart then.",
       {2, 3, 4, 5, 6, 7, 8},
       LevelUnit::degree},
  }};
  return list;
}

std::size_t index_of(const Hardness& hardness) {
  return static_cast<std::size_t>(std::ranges::find(table(), hardness.name, &Hardness::name) -
                                  table().begin());
}

/// The properties of a class of queries, in units of the frame.
struct Setup {
  explicit Setup(const HardSort& sort);

  bool near = false;         ///< true if collisions overlap by the gap only
  std::int64_t size = 0;     ///< of the scene
  std::int64_t gap = 0;      ///< gap without collision, and overlap of near collisions
  std::int64_t breadth = 0;  ///< height of the triangle, length of edge b
  std::int64_t descent = 0;  ///< maximum descent of the first primitive
  std::int64_t least_descent = 0;
  std::int64_t drift = 0;       ///< extent of other motion
  std::int64_t offset = 0;      ///< from the origin
  int log_angle = 0;            ///< of the angle's tangent; 0: far from parallel
  std::int64_t separation = 0;  ///< along z, rounded
  bool passes_beside = true;    ///< true if a scene may be decided beside the border
  int exponent = 0;             ///< of the factor from the frame to the world
};

/// The factor that enlarges the scene to at least 16 times the separation.
int enlargement(double distance) {
  if (distance == 0.0) return 0;
  return std::max(0, std::ilogb(distance) + 5);
}

Setup::Setup(const HardSort& sort) {
  const std::size_t index = index_of(*sort.hardness);
  const int level = sort.level;
  // The frame has a margin for lengths beyond the size.
  const int log_size = index == Index::speed    ? log_frame - std::max(level, 0)
                       : index == Index::offset ? log_frame - level - 1
                                                : log_frame;
  const auto by_level = [&](std::size_t of) {
    return static_cast<std::int64_t>(
        std::ldexp(static_cast<double>(size), of == index ? level : 0));
  };
  size = std::int64_t{1} << log_size;
  near = index == Index::distance;
  gap = near ? by_level(Index::distance) : size / 8;
  breadth = by_level(Index::aspect);
  log_angle = index == Index::angle ? level : 0;
  descent = index == Index::speed ? by_level(Index::speed) : size * 5 / 8;
  least_descent = descent - descent / 4;
  drift = std::min(size, descent) / 20;
  offset = index == Index::offset ? by_level(Index::offset) : size / 4;
  const int larger = enlargement(sort.separation.distance);
  // 1 in the frame is 3 along z in the world, or 9/5 by the greatest component: z is (1, 2, 2)/3.
  const double per_unit = sort.separation.norm == Norm::l2 ? 3.0 : 1.8;
  separation = std::llround(std::ldexp(sort.separation.distance / per_unit, log_size - larger));
  passes_beside = separation == 0 || sort.separation.norm == Norm::l2;
  exponent = larger - log_size + (index == Index::scale ? level : 0);
}

/// Builds one scene.
class FrameScene {
 public:
  FrameScene(const Setup& setup, Kind kind, bool collides, Random& random)
      : setup_(setup), random_(random), collides_(collides) {
    const bool beside = setup.passes_beside && random.coin() && (!collides || may_graze());
    if (kind == Kind::vertex_face) {
      place_triangle();
      place_vertex(beside);
    } else {
      place_edges(beside);
    }
    let_down(kind, beside);
    move_all();
  }

  /// The query in world coordinates, before the exact symmetry.
  [[nodiscard]] Query query() const {
    Query result{};
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        const auto& [x, y, z] = points_.at(end).at(point);
        const Vector turned{2 * x - 2 * y + z, x + 2 * y + 2 * z, 2 * x + y - 2 * z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          result.at(end, point, axis) =
              std::ldexp(static_cast<double>(turned.at(axis)), setup_.exponent);
        }
      }
    }
    return result;
  }

 private:
  /// True if collisions may be at the border: for near ones, if the triangle is wide enough.
  [[nodiscard]] bool may_graze() const { return setup_.near && setup_.gap <= setup_.size / 8; }

  /// Between two fractions of a length.
  std::int64_t draw(double low, double high, std::int64_t length) {
    const auto part = [&](double fraction) {
      return std::llround(fraction * static_cast<double>(length));
    };
    return random_.between(part(low), part(high));
  }

  /// Puts a point, with x drifting by up to `drift`.
  void put(std::size_t point, std::int64_t x, std::int64_t y, std::int64_t drift) {
    points_[0].at(point) = {x, y, 0};
    points_[1].at(point) = {x + draw(-1.0, 1.0, drift), y, 0};
  }

  void place_triangle() {
    const std::int64_t base = -draw(0.4, 0.4, setup_.breadth);
    put(1, draw(-0.55, -0.45, setup_.size), base, setup_.drift);
    put(2, draw(0.45, 0.55, setup_.size), base, setup_.drift);
    put(3, draw(-0.05, 0.05, setup_.size), base + setup_.breadth, setup_.drift);
  }

  /// Over the interior, or beside the side along x; nearly parallel it goes along x from one side
  /// of the triangle to the other.
  void place_vertex(bool beside) {
    const std::int64_t base = points_[0][1][1];
    const std::int64_t inside =
        collides_ ? setup_.gap - setup_.separation : -setup_.gap - setup_.separation;
    const std::int64_t y = base + (beside ? inside : draw(0.3, 0.5, setup_.breadth));
    put(0, draw(-0.05, 0.05, setup_.size), y, setup_.drift);
    if (setup_.log_angle == 0) return;
    const std::int64_t reach = slide() / 2;
    points_[0][0][0] = -reach;
    points_[1][0][0] = reach;
  }

  /// Across the interior, or with one end beside it.
  void place_edges(bool beside) {
    const std::int64_t drift = std::min(setup_.drift, setup_.breadth / 20);
    put(2, draw(-0.55, -0.45, setup_.breadth), 0, drift);
    put(3, draw(0.45, 0.55, setup_.breadth), 0, drift);
    const bool parallel = setup_.log_angle != 0;
    const std::int64_t along = draw(parallel ? 0.8 : -0.4, parallel ? 0.8 : 0.4, setup_.size);
    const std::int64_t across =
        parallel ? std::llround(std::ldexp(static_cast<double>(along), setup_.log_angle))
                 : std::min(setup_.size / 5 * 4, setup_.size - setup_.gap);
    const std::int64_t crossing = draw(-0.15, 0.15, setup_.breadth);
    const double part = 0.35 + 0.3 * random_.unit();
    const std::int64_t inside =
        collides_ ? -setup_.gap + setup_.separation : setup_.gap + setup_.separation;
    const std::int64_t x = beside ? crossing : crossing - draw(part, part, along);
    const std::int64_t y = beside ? inside : -draw(part, part, across);
    put(0, x, y, drift);
    put(1, x + along, y + across, drift);
  }

  /// The distance that a vertex slides along the plane.
  [[nodiscard]] std::int64_t slide() const { return setup_.size / 5 * 6; }

  /// Gives the first primitive its heights over the second.
  void let_down(Kind kind, bool beside) {
    const bool slides = setup_.log_angle != 0 && kind == Kind::vertex_face;
    const std::int64_t down =
        slides ? std::llround(std::ldexp(static_cast<double>(slide()), setup_.log_angle))
               : random_.between(setup_.least_descent, setup_.descent);
    const bool stops_short = !collides_ && !beside;
    const bool just_arrives = collides_ && setup_.near && !beside;
    // The distance from contact at the end.
    const std::int64_t rest = stops_short    ? setup_.gap
                              : just_arrives ? -setup_.gap
                              : slides       ? -draw(0.45, 0.55, down)
                                             : -draw(0.3, 0.7, down);
    const std::int64_t start = just_arrives ? down : rest + down;
    for (std::size_t point = 0; point < (kind == Kind::vertex_face ? 1U : 2U); ++point) {
      points_[0].at(point)[2] = setup_.separation + start;
      points_[1].at(point)[2] = setup_.separation + rest;
    }
  }

  /// Moves all points away from the origin, with a common motion.
  void move_all() {
    const auto away = [&] {
      const std::int64_t length = draw(0.5, 1.0, setup_.offset);
      return random_.coin() ? length : -length;
    };
    const Vector start{away(), away(), away()};
    Vector end = start;
    for (std::int64_t& component : end) component += 2 * draw(-1.0, 1.0, setup_.drift);
    for (Vector& point : points_[0]) point = point + start;
    for (Vector& point : points_[1]) point = point + end;
  }

  const Setup& setup_;
  Random& random_;
  bool collides_;
  /// At both ends of the motion.
  std::array<std::array<Vector, moving_points>, 2> points_{};
};

// ---- Scenes of decimals -------------------------------------------------------------------------

/// The greatest coordinates are below 10 to this power, before a factor.
constexpr int decimal_exponent = -1;
constexpr int usual_digits = 3;

ContactMoment draw_time(std::size_t index, int level, Random& random) {
  const bool is_at_an_end =
      index != Index::ends || random.between(1, 100) <= static_cast<std::int64_t>(level);
  if (!is_at_an_end) return ContactMoment::between;
  return random.coin() ? ContactMoment::at_start : ContactMoment::at_end;
}

/// Queries without collision have a clearance of one unit, increased with each attempt until no
/// contact is possible.
std::int64_t clearance_of(const EverydayScene& scene, double separation_in_units, int attempt) {
  const std::int64_t growing = power_of_ten(scene.digits * attempt / (most_attempts - 2));
  return (attempt == 0 ? 1 : 4 * growing) +
         static_cast<std::int64_t>(std::ceil(separation_in_units));
}

/// \param separation at the level
Query decimal_query(const HardSort& sort, bool collides, const Separation& separation, int attempt,
                    Random& random) {
  const std::size_t index = index_of(*sort.hardness);
  EverydayScene scene{.digits = index == Index::digits ? sort.level : usual_digits,
                      .exponent = decimal_exponent,
                      .time = draw_time(index, sort.level, random)};
  // A power of two does not change contact. The scene is enlarged like others.
  const int larger = enlargement(sort.separation.distance) == 0
                         ? 0
                         : enlargement(sort.separation.distance) - 3 * decimal_exponent;
  const int factor = larger + (index == Index::everyday_scale ? sort.level : 0);
  if (!collides) {
    const double unit = std::ldexp(from_decimal(1, scene.exponent - scene.digits), factor);
    scene.clearance = clearance_of(scene, separation.distance / unit, attempt);
  }
  Query query = everyday_query(sort.kind, scene, random);
  const double away =
      index == Index::frame ? std::ldexp(from_decimal(1, decimal_exponent), sort.level) : 0.0;
  for (double& x : query.coordinates) x = std::ldexp(x + away, factor);
  return query;
}

/// Queries of integers in a frame, or of decimals.
Query draw_query(const HardSort& sort, bool collides, const Separation& separation, int attempt,
                 Random& random) {
  if (index_of(*sort.hardness) >= Index::everyday_scale) {
    return decimal_query(sort, collides, separation, attempt, random);
  }
  const Setup setup(sort);
  KnownQuery known;
  known.query = FrameScene(setup, sort.kind, collides, random).query();
  apply_random_symmetry(sort.kind, random, known);
  return known.query;
}

// ---- Curves -------------------------------------------------------------------------------------

bool is_on_curves(const Hardness& hardness) { return index_of(hardness) >= Index::curve_distance; }

base::AnyQuery draw_curves(const HardSort& sort, bool collides, Random& random) {
  constexpr double curve_size = 4.0;  // of a side of the triangle
  const double gap = std::ldexp(collides ? -1.0 : 1.0, sort.level);
  switch (index_of(*sort.hardness)) {
    case Index::curve_distance:
      return hard_curves(sort.kind, 3, curve_size * gap, random);
    case Index::rotation_distance:
      return hard_rotation(sort.kind, gap, random);
    default:
      return hard_curves(sort.kind, static_cast<std::size_t>(sort.level),
                         collides ? 0.0 : curve_size * 0x1p-20, random);
  }
}

void check(const HardSort& sort) {
  const auto& levels = sort.hardness->levels;
  if (std::ranges::find(levels, sort.level) == levels.end()) {
    throw std::invalid_argument(fmt::format("{} has no level {}", sort.hardness->name,
                                            level_text(*sort.hardness, sort.level)));
  }
  if (!has_hard_queries(sort.separation)) {
    throw std::invalid_argument("hard queries are about separations up to 16384");
  }
  if (is_on_curves(*sort.hardness) && !is_zero(sort.separation)) {
    throw std::invalid_argument(fmt::format("{} is about distance 0 alone", sort.hardness->name));
  }
}

/// A number that identifies the class.
std::uint64_t key_of(const HardSort& sort, std::uint64_t seed, std::uint64_t index) {
  std::uint64_t key = mix(seed ^ hash(sort.hardness->name));
  key = mix(key + static_cast<std::uint64_t>(sort.level));
  key = mix(key + static_cast<std::uint64_t>(sort.kind));
  return mix(key + index);
}

}  // namespace

std::span<const Hardness> hardnesses() { return std::span(table()).first(Index::curve_distance); }

std::span<const Hardness> curve_hardnesses() {
  return std::span(table()).subspan(Index::curve_distance);
}

std::span<const Hardness> all_hardnesses() { return table(); }

const Hardness& hardness_from_name(std::string_view name) {
  std::string known;
  for (const Hardness& hardness : table()) {
    if (hardness.name == name) return hardness;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", hardness.name);
  }
  throw std::invalid_argument(fmt::format("no hardness is called {} (there are: {})", name, known));
}

bool has_hard_queries(const Separation& separation) {
  return is_valid(separation) && separation.distance <= greatest_distance;
}

std::string level_text(const Hardness& hardness, int level) {
  switch (hardness.unit) {
    case LevelUnit::digits:
      return fmt::format("{} digits", level);
    case LevelUnit::percent:
      return fmt::format("{} %", level);
    case LevelUnit::degree:
      return fmt::format("degree {}", level);
    default:
      return fmt::format("2^{}", level);
  }
}

double level_value(const Hardness& hardness, int level) {
  return hardness.unit == LevelUnit::power_of_two ? std::ldexp(1.0, level) : level;
}

Separation separation_at(const Hardness& hardness, int level, const Separation& separation) {
  const std::size_t index = index_of(hardness);
  if (index != Index::scale && index != Index::everyday_scale) return separation;
  return {.distance = std::ldexp(separation.distance, level), .norm = separation.norm};
}

data::RecordedQuery make_hard_query(const HardSort& sort, std::uint64_t seed, std::uint64_t index) {
  check(sort);
  const Separation separation = separation_at(*sort.hardness, sort.level, sort.separation);
  const bool wanted = index % 2 == 0;
  Random random(key_of(sort, seed, index));
  data::RecordedQuery made{.query = {}, .index = index, .collides = wanted, .toi = std::nullopt};
  if (is_on_curves(*sort.hardness)) {
    made.query = draw_curves(sort, wanted, random);
    return made;
  }
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    const Query query = draw_query(sort, wanted, separation, attempt, random);
    made.query = {sort.kind, query};
    made.collides =
        fast::solve(sort.kind, query, {.separation = separation}).verdict == fast::Verdict::yes;
    if (made.collides == wanted) break;
  }
  return made;
}

std::unique_ptr<data::QuerySource> open_hard_queries(const HardSort& sort, std::uint64_t seed,
                                                     std::uint64_t count) {
  const QueryShape shape = make_hard_query(sort, seed, 0).query.shape();
  const std::string name =
      fmt::format("{} {}", sort.hardness->name, level_text(*sort.hardness, sort.level));
  return open_drawn(
      {name, shape, separation_at(*sort.hardness, sort.level, sort.separation)}, count,
      [sort, seed](std::uint64_t index) { return make_hard_query(sort, seed, index); });
}

namespace {

/// The binomials of a degree.
std::vector<std::int64_t> binomials(std::size_t degree) {
  std::vector<std::int64_t> row{1};
  while (row.size() <= degree) {
    row.push_back(0);
    for (std::size_t k = row.size() - 1; k > 0; --k) row[k] += row[k - 1];
  }
  return row;
}

/// The odd part of the least common multiple of numbers.
double odd_multiple(const std::vector<std::int64_t>& numbers) {
  std::int64_t multiple = 1;
  for (const std::int64_t number : numbers) multiple = std::lcm(multiple, number);
  while (multiple % 2 == 0) multiple /= 2;
  return static_cast<double>(multiple);
}

/// The control values of m (t−a/8)² q(t) + gap.
std::vector<double> control_heights(std::size_t degree, double gap, Random& random) {
  const double a = static_cast<double>(random.between(1, 7)) / 8.0;
  const std::array<double, 3> square{a * a, -2.0 * a * (1.0 - a), (1.0 - a) * (1.0 - a)};
  const std::vector<std::int64_t> of_factor = binomials(degree - 2), of_all = binomials(degree);
  std::vector<double> values(degree + 1, 0.0);
  for (std::size_t j = 0; j < of_factor.size(); ++j) {
    const auto c = static_cast<double>(of_factor[j] * random.between(1, 4));
    for (std::size_t k = 0; k < square.size(); ++k) values[j + k] += c * square.at(k);
  }
  const double multiple = odd_multiple(of_all);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = values[k] * multiple / static_cast<double>(of_all[k]) + gap;
  }
  return values;
}

/// The query of these points at each control point, moved and turned.
template <class PointsAt>
base::AnyQuery moved_and_turned(const QueryShape& shape, Random& random,
                                const PointsAt& points_at) {
  constexpr std::int64_t reach = std::int64_t{1} << 41U;
  const auto component = [&] {
    return static_cast<double>(random.between(-reach, reach)) * 0x1p-38;
  };
  std::vector<double> numbers;
  for (std::size_t k = 0; k <= shape.degree; ++k) {
    const std::array<double, 3> moved{component(), component(), component()};
    const Points points = points_at(k);
    for (const auto& point : points) {
      const double x = point[0] + moved[0], y = point[1] + moved[1], z = point[2] + moved[2];
      numbers.insert(numbers.end(), {2 * x - 2 * y + z, x + 2 * y + 2 * z, 2 * x + y - 2 * z});
      if (shape.is_rational) numbers.push_back(quarter_weights.at(k));
    }
  }
  return {shape, numbers};
}

}  // namespace

base::AnyQuery hard_curves(Kind kind, std::size_t degree, double gap, Random& random) {
  const double sign = random.coin() ? 1.0 : -1.0;
  const std::vector<double> control = control_heights(degree, gap, random);
  return moved_and_turned({.kind = kind, .degree = degree}, random,
                          [&](std::size_t k) { return above(kind, sign * control[k]); });
}

base::AnyQuery hard_rotation(Kind kind, double gap, Random& random) {
  const Rotation rotation{.eighth = static_cast<double>(random.between(1, 7)),
                          .scale = std::ldexp(1.0, static_cast<int>(random.between(-2, 2))),
                          .direction = random.coin() ? 1.0 : -1.0,
                          .gap = gap};
  return moved_and_turned({.kind = kind, .degree = 2, .is_rational = true}, random,
                          [&](std::size_t k) { return turning(kind, rotation, k); });
}

}  // namespace touchstone::verify::generate
