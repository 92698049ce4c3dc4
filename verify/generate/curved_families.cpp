#include "verify/generate/curved_families.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "verify/generate/random.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::generate {
namespace {

/// Σ c_k (1−t)^(n−k) t^k.
using Form = std::vector<double>;

constexpr double eighths = 8.0;

/// form · (8t − a): times −a (1−t) + (8−a) t.
Form times_root(const Form& form, double a) {
  Form product(form.size() + 1, 0.0);
  for (std::size_t k = 0; k < form.size(); ++k) {
    product[k] -= a * form[k];
    product[k + 1] += (eighths - a) * form[k];
  }
  return product;
}

/// The control values of a form of lower or this degree, times what makes them whole.
Form control_of(Form form, std::size_t degree) {
  while (form.size() <= degree) {
    Form raised(form.size() + 1, 0.0);
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
  Form control;
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
    Form form{random_.coin() ? 1.0 : -1.0};
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

using Points = std::array<std::array<double, 3>, moving_points>;

/// The control points and weights of the quarter of the unit circle.
constexpr std::array<std::array<double, 2>, 3> quarter_circle{{{1, 0}, {1, 1}, {0, 1}}};
constexpr std::array<double, 3> quarter_weights{1, 1, 2};

/// Appends the control points of a query: its shape at each, moved along a curve, and the weights
/// of the quarter of a circle if the family is rational.
template <class ShapeAt>
void append(CurvedFamily& family, Draws& draws, const ShapeAt& shape_at) {
  io::throw_if_interrupted();
  for (std::size_t k = 0; k <= family.degree; ++k) {
    const std::array<double, 3> moved{draws.coordinate(), draws.coordinate(), draws.coordinate()};
    const Points points = shape_at(k);
    for (const auto& point : points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        family.numbers.push_back(point.at(axis) + moved.at(axis));
      }
      if (family.is_rational) family.numbers.push_back(quarter_weights.at(k));
    }
  }
}

/// At this height above the middle of a triangle or an edge.
Points above(Kind kind, double height) {
  if (kind == Kind::vertex_face) {
    return {{{1, 1, height}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  }
  return {{{-3, 0, height}, {2, 0, height}, {0, -2, 0}, {0, 3, 0}}};
}

/// In a common plane, at this place beside the triangle (outside if positive), or before the end of
/// the other edge.
Points beside(Kind kind, double place) {
  if (kind == Kind::vertex_face) return {{{1, -place, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4096, 0}}};
  return {{{1, place, 0}, {1, place + 4096, 0}, {0, 0, 0}, {4, 0, 0}}};
}

/// A rotation that is nearest to the other primitive at t = eighth/8.
struct Rotation {
  double eighth;
  double scale;
  /// 1, or −1 to turn the other way.
  double direction;
  /// The least distance by the radius.
  double gap;
};

Rotation draw_rotation(Random& random, bool misses) {
  Rotation rotation{};
  rotation.eighth = static_cast<double>(random.between(1, 7));
  rotation.scale = std::ldexp(1.0, static_cast<int>(random.between(-2, 2)));
  rotation.direction = random.coin() ? 1.0 : -1.0;
  if (misses) rotation.gap = std::ldexp(1.0, -static_cast<int>(random.between(10, 36)));
  return rotation;
}

/// Control point k of a vertex that turns towards a triangle, or of an edge along the axis that
/// turns towards a crossing one.
Points turning(Kind kind, const Rotation& rotation, std::size_t k) {
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
  if (kind == Kind::vertex_face) {
    return {turned(0), in_plane(-1, -1), in_plane(2, -1), in_plane(-1, 2)};
  }
  return {turned(-3), turned(2), in_plane(-1, -1), in_plane(2, 1)};
}

CurvedFamily rotations(std::string_view name, Kind kind, bool misses, std::size_t count,
                       std::uint64_t seed) {
  CurvedFamily family{name, kind, 2, {}, {}, true};
  Draws draws(family.degree, mix(seed + hash(name)));
  for (std::size_t i = 0; i < count; ++i) {
    const Rotation rotation = draw_rotation(draws.random(), misses);
    append(family, draws, [&](std::size_t k) { return turning(kind, rotation, k); });
    family.toi.push_back(misses ? std::nullopt : std::optional(rotation.eighth / eighths));
  }
  return family;
}

using MakeHeight = Height (Draws::*)();

struct CurvedRecipe {
  std::string_view name;
  MakeHeight make;
};

}  // namespace

std::vector<CurvedFamily> curved_families(std::size_t degree, std::size_t count,
                                          std::uint64_t seed) {
  static constexpr std::array recipes{CurvedRecipe{"transversal", &Draws::transversal},
                                      CurvedRecipe{"tangential", &Draws::tangential},
                                      CurvedRecipe{"at_start", &Draws::at_start},
                                      CurvedRecipe{"at_end", &Draws::at_end},
                                      CurvedRecipe{"twice", &Draws::twice},
                                      CurvedRecipe{"near_miss", &Draws::near_miss}};
  std::vector<CurvedFamily> families;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const auto& [name, make] : recipes) {
      CurvedFamily& family = families.emplace_back(CurvedFamily{name, kind, degree, {}, {}});
      Draws draws(degree, mix(seed + hash(name) + degree));
      for (std::size_t i = 0; i < count; ++i) {
        const Height height = (draws.*make)();
        append(family, draws, [&](std::size_t k) { return above(kind, height.control[k]); });
        family.toi.push_back(height.root);
      }
    }
    CurvedFamily& plane = families.emplace_back(CurvedFamily{"in_plane", kind, degree, {}, {}});
    Draws draws(degree, mix(seed + hash(plane.name) + degree));
    for (std::size_t i = 0; i < count; ++i) {
      // Outside until the root: the form falls from positive values.
      Height place = draws.transversal();
      if (place.control.front() < 0.0) {
        for (double& c : place.control) c = -c;
      }
      append(plane, draws, [&](std::size_t k) { return beside(kind, place.control[k]); });
      plane.toi.push_back(place.root);
    }
    if (degree != 2) continue;
    families.push_back(rotations("rotation_touch", kind, false, count, seed));
    families.push_back(rotations("rotation_miss", kind, true, count, seed));
  }
  return families;
}

}  // namespace touchstone::verify::generate
