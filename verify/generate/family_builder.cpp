#include "verify/generate/family_builder.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "verify/generate/symmetry.hpp"

namespace touchstone::verify::generate {

using exact::Rational;

namespace {

template <class Function>
void for_each_point(Function&& function) {
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) function(end, point);
  }
}

void swap_points(Query& query, std::size_t a, std::size_t b) {
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::swap(query.at(end, a, axis), query.at(end, b, axis));
    }
  }
}

void swap_axes(KnownQuery& known, std::size_t a, std::size_t b) {
  for_each_point([&](std::size_t end, std::size_t point) {
    std::swap(known.query.at(end, point, a), known.query.at(end, point, b));
  });
  if (known.separating_direction) {
    std::swap((*known.separating_direction)[a], (*known.separating_direction)[b]);
  }
}

void mirror_axis(KnownQuery& known, std::size_t axis) {
  for_each_point([&](std::size_t end, std::size_t point) {
    known.query.at(end, point, axis) = -known.query.at(end, point, axis);
  });
  if (known.separating_direction) {
    (*known.separating_direction)[axis] = -(*known.separating_direction)[axis];
  }
}

/// Exchanges vertices `a` and `b` (0..2) of the face, and the weights (1−u−v, u, v) with them.
void swap_face_vertices(KnownQuery& known, std::size_t a, std::size_t b) {
  swap_points(known.query, 1 + a, 1 + b);
  if (!known.contact) return;
  const auto [u, v] = *known.contact;
  std::array<Rational, 3> weights{Rational(1 - u - v), u, v};
  std::swap(weights.at(a), weights.at(b));
  known.contact = Contact{weights[1], weights[2]};
}

void swap_edge_ends(KnownQuery& known, std::size_t edge) {
  swap_points(known.query, 2 * edge, 2 * edge + 1);
  if (known.contact) known.contact->at(edge) = 1 - known.contact->at(edge);
}

/// Exchanges the two edges: F becomes −F.
void swap_edges(KnownQuery& known) {
  swap_points(known.query, 0, 2);
  swap_points(known.query, 1, 3);
  if (known.contact) std::swap((*known.contact)[0], (*known.contact)[1]);
  if (known.separating_direction) {
    for (double& component : *known.separating_direction) component = -component;
  }
}

bool scales_exactly(const Query& query, std::size_t axis, int exponent) {
  bool exact = true;
  for_each_point([&](std::size_t end, std::size_t point) {
    const double value = query.at(end, point, axis);
    const double scaled = std::ldexp(value, exponent);
    exact = exact && std::isfinite(scaled) && std::ldexp(scaled, -exponent) == value;
  });
  return exact;
}

}  // namespace

KnownQuery collision(const Query& query, std::optional<Rational> toi,
                     std::optional<Contact> contact) {
  KnownQuery known;
  known.query = query;
  known.collides = true;
  known.toi = std::move(toi);
  known.contact = std::move(contact);
  return known;
}

KnownQuery no_collision(const Query& query) {
  KnownQuery known;
  known.query = query;
  return known;
}

KnownQuery no_collision_along(const Query& query, std::size_t axis, double direction) {
  KnownQuery known = no_collision(query);
  known.separating_direction = std::array<double, 3>{};
  known.separating_direction->at(axis) = direction;
  return known;
}

Rational corner_at(const Query& query, const Corner& corner, std::size_t axis, const Rational& t) {
  const auto difference = [&](std::size_t end) {
    return Rational(Rational(query.at(end, corner.plus, axis)) -
                    Rational(query.at(end, corner.minus, axis)));
  };
  const Rational start = difference(0);
  return {start + t * (difference(1) - start)};
}

std::optional<Contact> planar_contact(Kind kind, const Query& query, const Rational& t,
                                      const std::array<std::size_t, 2>& axes) {
  const auto all = corners(kind);
  std::array<Rational, 2> w0, along_u, along_v;
  for (std::size_t i = 0; i < 2; ++i) {
    w0.at(i) = corner_at(query, all.front(), axes.at(i), t);
    along_u.at(i) = corner_at(query, all[1], axes.at(i), t) - w0.at(i);
    along_v.at(i) = corner_at(query, all.back(), axes.at(i), t) - w0.at(i);
  }
  const Rational area = along_u[0] * along_v[1] - along_u[1] * along_v[0];
  if (area == 0) return std::nullopt;
  return Contact{Rational((along_v[0] * w0[1] - along_v[1] * w0[0]) / area),
                 Rational((along_u[1] * w0[0] - along_u[0] * w0[1]) / area)};
}

bool uses_full_significands(const Query& query) {
  constexpr int bits = 45;
  std::set<double> magnitudes;
  std::set<int> exponents;
  for (const double coordinate : query.coordinates) {
    if (coordinate == 0) continue;
    magnitudes.insert(std::abs(coordinate));
    exponents.insert(std::ilogb(coordinate));
  }
  const auto is_full = [](double magnitude) {
    // A number of at most 44 bits is an integer when its leading bit stands for 2^43.
    const double shortened = std::ldexp(magnitude, bits - 2 - std::ilogb(magnitude));
    return shortened != std::floor(shortened);
  };
  const auto full = std::count_if(magnitudes.begin(), magnitudes.end(), is_full);
  return exponents.size() > 1 && 2 * static_cast<std::size_t>(full) > magnitudes.size();
}

void apply_random_symmetry(Kind kind, Random& random, KnownQuery& known) {
  if (is_element(kind)) {
    known.query = image(draw_isometry(kind, random), known.query).value();
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    swap_axes(known, axis, static_cast<std::size_t>(random.between(static_cast<int>(axis), 2)));
    if (random.coin()) mirror_axis(known, axis);
  }
  if (kind == Kind::vertex_face) {
    for (std::size_t i = 0; i < 2; ++i) {
      swap_face_vertices(known, i,
                         static_cast<std::size_t>(random.between(static_cast<int>(i), 2)));
    }
    return;
  }
  for (std::size_t edge = 0; edge < 2; ++edge) {
    if (random.coin()) swap_edge_ends(known, edge);
  }
  if (random.coin()) swap_edges(known);
}

void scale_axes(const std::array<int, 3>& exponents, KnownQuery& known) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int wanted = exponents.at(axis);
    const int exponent = scales_exactly(known.query, axis, wanted) ? wanted : -wanted;
    for_each_point([&](std::size_t end, std::size_t point) {
      double& coordinate = known.query.at(end, point, axis);
      coordinate = std::ldexp(coordinate, exponent);
    });
    if (known.separating_direction) {
      double& component = known.separating_direction->at(axis);
      component = std::ldexp(component, -exponent);
    }
  }
}

}  // namespace touchstone::verify::generate
