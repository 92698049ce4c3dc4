#include "verify/generate/curved_families.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "verify/generate/random.hpp"

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

/// Appends the control points of a query: its shape at each, moved along a curve.
template <class ShapeAt>
void append(CurvedFamily& family, Draws& draws, const ShapeAt& shape_at) {
  for (std::size_t k = 0; k <= family.degree; ++k) {
    const std::array<double, 3> moved{draws.coordinate(), draws.coordinate(), draws.coordinate()};
    const Points points = shape_at(k);
    for (const auto& point : points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        family.numbers.push_back(point.at(axis) + moved.at(axis));
      }
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
  }
  return families;
}

}  // namespace touchstone::verify::generate
