#include "verify/generate/everyday.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>

#include "verify/generate/draws.hpp"
#include "verify/generate/grid.hpp"
#include "verify/generate/symmetry.hpp"

namespace touchstone::verify::generate {
namespace {

/// Points, in units.
using Layout = std::array<Vector, moving_points>;

/// The places that the primitives share at the end of the contact.
struct ContactPlaces {
  Layout places{};
  /// The two points that coincide, if any do.
  std::optional<std::array<std::size_t, 2>> shared;
};

/// Draws scenes of up to a number of units.
class Scene {
 public:
  Scene(ContactKind kind, std::int64_t size, Random& random)
      : kind_(kind), size_(size), random_(random) {}

  [[nodiscard]] ContactPlaces draw_contact() {
    ContactPlaces contact;
    for (Vector& place : contact.places) place = draw_place();
    switch (draws::below(random_, 3)) {
      case 0:
        share_a_point(contact);
        break;
      case 1:
        place_on_a_side(contact.places);
        break;
      default:
        place_in_a_plane(contact.places);
    }
    return contact;
  }

  /// The points at the other end: each primitive stays, moves along an axis, or anywhere; sometimes
  /// each point moves by itself.
  [[nodiscard]] Layout moved(const ContactPlaces& contact) {
    Layout result = contact.places;
    const std::array<Vector, 2> motions{draw_motion(), draw_motion()};
    for (std::size_t point = 0; point < moving_points; ++point) {
      result.at(point) = result.at(point) + motions.at(point < second() ? 0 : 1);
      if (draws::one_in(random_, 3)) result.at(point) = result.at(point) + draw_place();
    }
    if (contact.shared && random_.coin())
      result.at((*contact.shared)[0]) = result.at((*contact.shared)[1]);
    return result;
  }

  /// The first primitive's points begin with 0, the second one's with this.
  [[nodiscard]] std::size_t second() const { return kind_ == ContactKind::vertex_face ? 1 : 2; }

 private:
  std::int64_t between(std::int64_t low, std::int64_t high) { return random_.between(low, high); }
  std::int64_t up_to(std::int64_t most) { return between(1, most); }

  Vector draw_place() {
    return {between(-size_, size_), between(-size_, size_), between(-size_, size_)};
  }

  Vector draw_motion() {
    const std::size_t how = draws::below(random_, 4);
    if (how == 0) return {};
    Vector motion = draw_place();
    if (how == 1) {
      const std::size_t axis = draws::below(random_, 3);
      for (std::size_t other = 0; other < 3; ++other) {
        if (other != axis) motion.at(other) = 0;
      }
    }
    return motion;
  }

  void share_a_point(ContactPlaces& contact) {
    const std::size_t of_first = draws::below(random_, second());
    const std::size_t of_second = second() + draws::below(random_, moving_points - second());
    contact.places.at(of_first) = contact.places.at(of_second);
    contact.shared = {of_first, of_second};
  }

  /// Places the first point between the last two, which lie along x.
  void place_on_a_side(Layout& places) {
    const Vector middle = places[0];
    places[2] = places[3] = middle;
    places[2][0] -= up_to(size_);
    places[3][0] += up_to(size_);
  }

  /// Places all points at one height, around the first point, or across each other.
  void place_in_a_plane(Layout& places) {
    const std::int64_t half = size_ / 2;
    const auto far = [&] { return between(half, size_); };
    const auto near = [&] { return between(-half / 2, half / 2); };
    const Vector middle = places[0];
    const auto put = [&](std::size_t point, std::int64_t x, std::int64_t y) {
      places.at(point) = middle + Vector{x, y, 0};
    };
    if (kind_ == ContactKind::vertex_face) {
      put(1, -far(), -far());
      put(2, far(), -far());
      put(3, near(), far());
    } else {
      put(0, -far(), near());
      put(1, far(), near());
      put(2, near(), -far());
      put(3, near(), far());
    }
  }

  ContactKind kind_;
  std::int64_t size_;
  Random& random_;
};

/// The notation of numbers of a unit that is a power of ten: rounded to the nearest double, or to
/// the nearest float and printed.
struct Notation {
  int places = 0;  ///< behind the point; in front of it if negative
  bool as_float = false;

  [[nodiscard]] double operator()(std::int64_t units) const {
    const auto whole = static_cast<double>(units);
    const auto power = static_cast<double>(power_of_ten(std::abs(places)));
    // Powers and units are exact, so that this is the decimal rounded once.
    const double x = places > 0 ? whole / power : whole * power;
    return as_float ? static_cast<double>(static_cast<float>(x)) : x;
  }
};

/// The query under a random symmetry without shifts, which keeps decimals decimals.
Query in_another_order(ContactKind kind, const Query& query, Random& random) {
  // A distance above 0 excludes symmetries that change distances.
  Symmetry symmetry = draw_symmetry(kind, query, {.distance = 1.0, .norm = Norm::linf}, random);
  symmetry.shifts = {};
  return image(symmetry, query).value_or(query);
}

constexpr int most_digits = 6;
constexpr int least_power = -3, greatest_power = 4;

/// What varies from scene to scene.
struct Setting {
  int digits = 0;         ///< significant decimal digits of the greatest coordinates
  int exponent = 0;       ///< the greatest coordinates are below 10 to this power
  bool as_float = false;  ///< true if each decimal is rounded to a float
  std::size_t end = 0;    ///< that at which they touch
};

Setting draw_setting(Random& random) {
  Setting setting;
  setting.digits = 1 + static_cast<int>(draws::below(random, most_digits));
  setting.exponent = static_cast<int>(random.between(least_power, greatest_power));
  setting.as_float = draws::one_in(random, 3);
  setting.end = random.coin() ? 0 : 1;
  return setting;
}

std::array<Layout, 2> draw_ends(ContactKind kind, const Setting& setting, bool is_apart,
                                Random& random) {
  // Layout are sums of up to four draws: the first, two of the shape, and a motion.
  Scene scene(kind, power_of_ten(setting.digits) / 4, random);
  const ContactPlaces contact = scene.draw_contact();
  std::array<Layout, 2> ends;
  ends.at(setting.end) = contact.places;
  ends.at(1 - setting.end) = scene.moved(contact);
  if (!is_apart) return ends;
  const std::size_t axis = draws::below(random, 3);
  const std::int64_t away = random.coin() ? 1 : -1;
  for (Layout& places : ends) {
    for (std::size_t point = 0; point < scene.second(); ++point) places.at(point).at(axis) += away;
  }
  return ends;
}

/// \param is_apart True to move the first primitive away by a unit at all times.
Query draw_query(ContactKind kind, bool is_apart, Random& random) {
  const Setting setting = draw_setting(random);
  const std::array<Layout, 2> ends = draw_ends(kind, setting, is_apart, random);
  const Notation notation{.places = setting.digits - setting.exponent,
                          .as_float = setting.as_float};
  Query query{};
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        query.at(end, point, axis) = notation(ends.at(end).at(point).at(axis));
      }
    }
  }
  return in_another_order(kind, query, random);
}

}  // namespace

Query everyday_contact(ContactKind kind, Random& random) { return draw_query(kind, false, random); }

Query everyday_near_contact(ContactKind kind, Random& random) {
  return draw_query(kind, true, random);
}

Decimal shortest_decimal(double x) {
  std::array<char, 32> text{};
  const char* const end =
      std::to_chars(text.begin(), text.end(), x, std::chars_format::scientific).ptr;
  Decimal result;
  const char* place = text.begin();
  for (; place != end && *place != 'e'; ++place) {
    if (*place == '.') continue;
    result.digits = 10 * result.digits + static_cast<std::uint64_t>(*place - '0');
    ++result.count;
  }
  // from_chars takes no plus.
  if (*++place == '+') ++place;
  std::from_chars(place, end, result.exponent);
  result.exponent -= result.count - 1;
  return result;
}

std::int64_t power_of_ten(int exponent) {
  std::int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

double from_decimal(std::uint64_t digits, int exponent) {
  std::array<char, 40> text{};
  char* end = std::to_chars(text.begin(), text.end(), digits).ptr;
  *end++ = 'e';
  end = std::to_chars(end, text.end(), exponent).ptr;
  double result = 0.0;
  std::from_chars(text.begin(), end, result);
  return result;
}

}  // namespace touchstone::verify::generate
