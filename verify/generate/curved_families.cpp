#include "verify/generate/curved_families.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {
namespace {

/// Σ c_k (1−t)^(n−k) t^k.
using Coefficients = std::vector<double>;

constexpr double eighths = 8.0;

/// form · (8t − a): times −a (1−t) + (8−a) t.
Coefficients times_root(const Coefficients& form, double a) {
  Coefficients product(form.size() + 1, 0.0);
  for (std::size_t k = 0; k < form.size(); ++k) {
    product[k] -= a * form[k];
    product[k + 1] += (eighths - a) * form[k];
  }
  return product;
}

/// The control values of a form of this degree or a lower one, times the factor that makes them
/// whole.
Coefficients control_of(Coefficients form, std::size_t degree) {
  while (form.size() <= degree) {
    Coefficients raised(form.size() + 1, 0.0);
    for (std::size_t k = 0; k < form.size(); ++k) {
      raised[k] += form[k];
      raised[k + 1] += form[k];
    }
    form = std::move(raised);
  }
  const auto n = static_cast<double>(degree);  // the binomials between are n
  form.front() *= n;
  form.back() *= n;
  return form;
}

/// The height of a query and its first root.
struct Height {
  Coefficients control;
  std::optional<double> root;
};

class Draws {
 public:
  Draws(std::size_t degree, std::uint64_t seed) : degree_(degree), random_(seed) {}

  Height transversal() { return with_roots({inner()}); }
  Height tangential() {
    const double a = inner();
    if (degree_ == 3 && random_.coin()) return with_roots({a, a, a});
    return with_roots({a, a});
  }
  Height at_start() { return with_roots({0.0}); }
  Height at_end() { return with_roots({eighths}); }
  Height twice() {
    const auto a = static_cast<double>(random_.between(1, 3));
    const auto b = static_cast<double>(random_.between(5, 7));
    return with_roots({a, b});
  }
  /// Positive until the root.
  Height falling() {
    Height height = transversal();
    if (height.control.front() < 0.0) {
      for (double& c : height.control) c = -c;
    }
    return height;
  }
  Height near_miss() {
    Height height = tangential_of_two();
    for (double& c : height.control) c += 0x1p-20;
    height.root = std::nullopt;
    return height;
  }

  double coordinate() { return static_cast<double>(random_.between(-8, 8)); }
  Random& random() { return random_; }

 private:
  double inner() { return static_cast<double>(random_.between(1, 7)); }
  Height tangential_of_two() {
    const double a = inner();
    return {control_of(times_root(times_root({1.0}, a), a), degree_), a / eighths};
  }

  /// A product of these roots, of either sign, times a root outside [0,1] if there is room for one.
  Height with_roots(const std::vector<double>& roots) {
    Coefficients form{random_.coin() ? 1.0 : -1.0};
    for (const double a : roots) form = times_root(form, a);
    if (form.size() <= degree_ && random_.coin()) {
      form = times_root(form, static_cast<double>(random_.coin() ? -random_.between(1, 9)
                                                                 : random_.between(9, 20)));
    }
    return {control_of(std::move(form), degree_), *std::ranges::min_element(roots) / eighths};
  }

  std::size_t degree_;
  Random random_;
};

/// The control points of the quarter of the unit circle.
constexpr std::array<std::array<double, 2>, 3> quarter_circle{{{1, 0}, {1, 1}, {0, 1}}};

/// The weights of these.
constexpr std::array<double, 3> quarter_weights{1, 1, 2};

/// A rotation that is nearest to the other primitive at t = eighth/8.
struct Rotation {
  double eighth;
  double scale;
  /// 1, or −1 to turn the other way.
  double direction;
  double gap;  ///< the least distance by the radius
};

/// Control point k of a vertex that turns towards a triangle, or of an edge along the axis that
/// turns towards a crossing one.
Points turning(ContactKind kind, const Rotation& rotation, std::size_t k) {
  const double square = rotation.eighth * rotation.eighth;
  const double normal_x = 64.0 - square, normal_y = 16.0 * rotation.eighth;
  const auto across = [&](double x, double y, double height) -> std::array<double, 3> {
    return {rotation.scale * x, rotation.direction * rotation.scale * y, height};
  };
  const auto turned = [&](double height) {
    const double radius = 64.0 + square;
    return across(radius * quarter_circle.at(k)[0], radius * quarter_circle.at(k)[1], height);
  };
  const auto in_plane = [&](double along, double height) {
    const double out = 1.0 + rotation.gap;
    return across(out * normal_x - along * normal_y, out * normal_y + along * normal_x, height);
  };
  if (kind == ContactKind::vertex_face) {
    return {turned(0), in_plane(-1, -1), in_plane(2, -1), in_plane(-1, 2)};
  }
  return {turned(-3), turned(2), in_plane(-1, -1), in_plane(2, 1)};
}

/// A query of these points at each control point, moved along a curve, with the weights of the
/// quarter of a circle if it is rational.
template <class PointsAt>
base::AnyQuery moved_query(const QueryShape& shape, Draws& draws, const PointsAt& points_at) {
  std::vector<double> numbers;
  numbers.reserve(shape.numbers_of_query());
  for (std::size_t k = 0; k <= shape.degree; ++k) {
    const std::array<double, 3> moved{draws.coordinate(), draws.coordinate(), draws.coordinate()};
    const Points points = points_at(k);
    for (const auto& point : points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        numbers.push_back(point.at(axis) + moved.at(axis));
      }
      if (shape.is_rational) numbers.push_back(quarter_weights.at(k));
    }
  }
  return {shape, numbers};
}

/// In a common plane, at this place beside the triangle (outside if positive), or before the end of
/// the other edge.
Points beside(ContactKind kind, double place) {
  if (kind == ContactKind::vertex_face)
    return {{{1, -place, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4096, 0}}};
  return {{{1, place, 0}, {1, place + 4096, 0}, {0, 0, 0}, {4, 0, 0}}};
}

Rotation draw_rotation(Random& random, bool misses) {
  Rotation rotation{};
  rotation.eighth = static_cast<double>(random.between(1, 7));
  rotation.scale = std::ldexp(1.0, static_cast<int>(random.between(-2, 2)));
  rotation.direction = random.coin() ? 1.0 : -1.0;
  if (misses) rotation.gap = std::ldexp(1.0, -static_cast<int>(random.between(10, 36)));
  return rotation;
}

/// The families of degree 2 and 3 of one construction.
struct HeightConstruction {
  std::string_view key;  ///< of the seed; their names end like it
  std::string_view reason;
  Height (Draws::*height)();
  Verdicts verdicts = Verdicts::collisions;
  Points (*place)(ContactKind, double) = &above;
};

constexpr std::array<HeightConstruction, 7> heights{
    {{"transversal",
      "The height over the inside is a product of known factors, with one root in [0,1].",
      &Draws::transversal},
     {"tangential",
      "The height is a product of known factors, with one double or triple root in [0,1].",
      &Draws::tangential},
     {"at_start", "The height has a factor t.", &Draws::at_start},
     {"at_end", "The height has a factor 1−t, and no other root in [0,1].", &Draws::at_end},
     {"twice", "The height has two roots in [0,1]: through and back.", &Draws::twice},
     {"in_plane",
      "All is in one plane: the vertex enters the triangle, or one edge comes into the other's "
      "way, at a known root.",
      &Draws::falling, Verdicts::collisions, &beside},
     {"near_miss", "The height is a positive multiple of (8t−a)² plus 2^-20.", &Draws::near_miss,
      Verdicts::no_collisions}}};

/// "quadratic-at-start"
std::string name_of(const HeightConstruction& construction, std::size_t degree) {
  std::string name = (degree == 2 ? "quadratic-" : "cubic-") + std::string(construction.key);
  std::ranges::replace(name, '_', '-');
  return name;
}

constexpr std::array<Family, 2> rotations{
    {{"rotation-touch",
      "A rotating point, or edge along the axis, touches a plane at a known time.",
      Verdicts::collisions, 2, true},
     {"rotation-miss", "The plane is beyond the circle by 2^-36 to 2^-10 of the radius.",
      Verdicts::no_collisions, 2, true}}};

data::RecordedQuery draw_height(const HeightConstruction& construction, const QueryShape& shape,
                                Draws& draws, std::uint64_t index) {
  const Height height = (draws.*construction.height)();
  const auto points_at = [&](std::size_t k) {
    return construction.place(shape.kind, height.control[k]);
  };
  return {.query = moved_query(shape, draws, points_at),
          .index = index,
          .collides = height.root.has_value(),
          .toi = height.root};
}

data::RecordedQuery draw_turning(bool misses, const QueryShape& shape, Draws& draws,
                                 std::uint64_t index) {
  const Rotation rotation = draw_rotation(draws.random(), misses);
  const auto points_at = [&](std::size_t k) { return turning(shape.kind, rotation, k); };
  data::RecordedQuery result{.query = moved_query(shape, draws, points_at),
                             .index = index,
                             .collides = !misses,
                             .toi = std::nullopt};
  if (!misses) result.toi = rotation.eighth / eighths;
  return result;
}

}  // namespace

Points above(ContactKind kind, double height) {
  if (kind == ContactKind::vertex_face) {
    return {{{1, 1, height}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  }
  return {{{-3, 0, height}, {2, 0, height}, {0, -2, 0}, {0, 3, 0}}};
}

std::span<const Family> curved_families() {
  static std::deque<std::string> names;
  static const std::vector<Family> all = [] {
    std::vector<Family> list;
    for (const std::size_t degree : {2U, 3U}) {
      for (const HeightConstruction& of : heights) {
        list.push_back({names.emplace_back(name_of(of, degree)), of.reason, of.verdicts, degree});
      }
    }
    list.insert(list.end(), rotations.begin(), rotations.end());
    return list;
  }();
  return all;
}

std::function<data::RecordedQuery(std::uint64_t)> curved_draws(const Family& family,
                                                               ContactKind kind,
                                                               std::uint64_t seed) {
  const QueryShape shape{kind, family.degree, family.is_rational};
  if (family.is_rational) {
    const bool misses = family.verdicts == Verdicts::no_collisions;
    const std::uint64_t state = mix(seed + hash(misses ? "rotation_miss" : "rotation_touch"));
    return [=, draws = Draws(shape.degree, state)](std::uint64_t index) mutable {
      return draw_turning(misses, shape, draws, index);
    };
  }
  const auto has_name = [&](const HeightConstruction& of) {
    return name_of(of, shape.degree) == family.name;
  };
  const HeightConstruction& of = *std::ranges::find_if(heights, has_name);
  const std::uint64_t state = mix(seed + hash(of.key) + shape.degree);
  return [=, &of, draws = Draws(shape.degree, state)](std::uint64_t index) mutable {
    return draw_height(of, shape, draws, index);
  };
}

}  // namespace touchstone::verify::generate
