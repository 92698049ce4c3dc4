#include "verify/fuzz/generators.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>

#include "touchstone/certified.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/mesh.hpp"
#include "verify/fuzz/contact.hpp"
#include "verify/fuzz/curved_generators.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/generate/draws.hpp"
#include "verify/generate/everyday.hpp"

namespace touchstone::verify::fuzz {
namespace {

namespace draws = generate::draws;
using draws::below;
using draws::one_in;
using generate::Random;

// ---- Small changes ------------------------------------------------------------------------------

/// Maps doubles to integers in the same order: ±0 to 0.
std::int64_t rank(double x) {
  const auto bits = std::bit_cast<std::int64_t>(std::abs(x));
  return std::signbit(x) ? -bits : bits;
}

/// The double at this number of doubles above x (below, if negative), limited to the greatest
/// finite magnitude.
double stepped(double x, std::int64_t steps) {
  static constexpr auto greatest = std::bit_cast<std::int64_t>(std::numeric_limits<double>::max());
  const std::int64_t target = std::clamp(rank(x) + steps, -greatest, greatest);
  const auto magnitude = std::bit_cast<double>(std::abs(target));
  return target < 0 ? -magnitude : magnitude;
}

double& some_number(std::span<double> numbers, Random& random) {
  return numbers[below(random, numbers.size())];
}

void nudge_numbers(std::span<double> numbers, Random& random) {
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    double& x = some_number(numbers, random);
    const std::int64_t steps =
        one_in(random, 4) ? std::int64_t{1} << below(random, 40) : random.between(1, 4);
    x = stepped(x, random.coin() ? steps : -steps);
  }
}

/// Moves one to three coordinates by some units in the last place: mostly a few, sometimes 2^k.
void nudge(Query& query, Random& random) { nudge_numbers(query.coordinates, random); }

/// Moves the points at one end by up to 2^-20 of their way, forwards or backwards: an event at that
/// end then happens slightly earlier or not at all. All points, or the first primitive's.
void overshoot(ContactKind kind, Query& query, Random& random) {
  const std::size_t end = below(random, 2);
  const std::size_t first_primitive = kind == ContactKind::vertex_face ? 1 : 2;
  const std::size_t count = random.coin() ? moving_points : first_primitive;
  const double part =
      std::ldexp(random.coin() ? 1.0 : -1.0, -static_cast<int>(random.between(20, 52)));
  Query moved = query;
  for (std::size_t point = 0; point < count; ++point) {
    point_of(moved, end, point) +=
        part * (point_of(query, end, point) - point_of(query, 1 - end, point));
  }
  if (is_finite(moved)) query = moved;
}

// ---- Structured coordinates ---------------------------------------------------------------------

/// Small integers times a power of two.
Query few_bits(ContactKind /*kind*/, const GeneratorContext& /*context*/, Random& random) {
  static constexpr std::array<std::int64_t, 5> bounds{1, 2, 3, 8, 60};
  const std::int64_t bound = bounds.at(below(random, bounds.size()));
  Query query{};
  for (double& x : query.coordinates) x = static_cast<double>(random.between(-bound, bound));
  const double scale = draws::power_of_two(static_cast<int>(random.between(-20, 20)));
  if (random.coin()) draws::multiply(query, {scale, scale, scale});
  return query;
}

/// A few numbers for each axis, with full significands, for all coordinates, so that many are
/// equal.
Query grid(ContactKind /*kind*/, const GeneratorContext& /*context*/, Random& random) {
  std::array<std::array<double, 4>, 3> palettes{};
  const std::array<double, 3> scales = draws::scales(random);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (double& x : palettes.at(axis)) x = scales.at(axis) * random.uniform(-1.0, 1.0);
    if (one_in(random, 3)) palettes.at(axis).front() = 0.0;
  }
  const std::array<std::size_t, 3> sizes{1 + below(random, 4), 2 + below(random, 3),
                                         2 + below(random, 3)};
  const std::size_t turn = below(random, 3);
  Query query{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    const std::size_t axis = i % 3;
    query.coordinates.at(i) = palettes.at(axis).at(below(random, sizes.at((axis + turn) % 3)));
  }
  return query;
}

void force_degeneracy(Query& query, Random& random) {
  const std::size_t end = below(random, 2), axis = below(random, 3);
  const std::size_t point = below(random, moving_points), other = below(random, moving_points);
  switch (below(random, 5)) {
    case 0:  // shared all the time
      for (const std::size_t e : {0U, 1U}) {
        point_of(query, e, other) = Eigen::Vector3d(point_of(query, e, point));
      }
      break;
    case 1:  // shared at one end
      point_of(query, end, other) = Eigen::Vector3d(point_of(query, end, point));
      break;
    case 2:  // at rest
      point_of(query, 1, point) = Eigen::Vector3d(point_of(query, 0, point));
      break;
    case 3:  // equal coordinates of two points
      for (const std::size_t e : {0U, 1U}) query.at(e, other, axis) = query.at(e, point, axis);
      break;
    default:  // one coordinate for all points at an end
      for (std::size_t p = 0; p < moving_points; ++p)
        query.at(end, p, axis) = query.at(end, 0, axis);
  }
}

/// Random points, some of them shared, at rest, or with equal coordinates.
Query shared_vertices(ContactKind kind, const GeneratorContext& context, Random& random) {
  Query query{};
  if (random.coin()) {
    query = few_bits(kind, context, random);
  } else {
    for (double& x : query.coordinates) x = random.uniform(-1.0, 1.0);
    draws::multiply(query, draws::scales(random));
  }
  const std::size_t count = 1 + below(random, 4);
  for (std::size_t i = 0; i < count; ++i) force_degeneracy(query, random);
  return query;
}

// ---- Contact ------------------------------------------------------------------------------------

Query contact_on_grid(ContactKind kind, const GeneratorContext& /*context*/, Random& random) {
  Query query = grid_contact(kind, random);
  if (one_in(random, 6)) overshoot(kind, query, random);
  if (!one_in(random, 3)) nudge(query, random);
  return query;
}

Query contact_at_level(ContactKind kind, const GeneratorContext& /*context*/, Random& random) {
  Query query = level_contact(kind, random);
  if (random.coin()) nudge(query, random);
  return query;
}

Query contact_rounded(ContactKind kind, const GeneratorContext& /*context*/, Random& random) {
  Query query = rounded_contact(kind, random);
  if (random.coin()) nudge(query, random);
  return query;
}

Query everyday(ContactKind kind, const GeneratorContext& /*context*/, Random& random) {
  if (one_in(random, 8)) return generate::everyday_near_contact(kind, random);
  Query query = generate::everyday_contact(kind, random);
  if (one_in(random, 8)) nudge(query, random);
  return query;
}

Query apart(ContactKind kind, const GeneratorContext& context, Random& random) {
  Query query = contact_apart(kind, context.separation(), random);
  if (one_in(random, 4)) overshoot(kind, query, random);
  if (random.coin()) nudge(query, random);
  return query;
}

/// The query, or another one if the oracle may take long for it.
AnyQuery decided_soon(AnyQuery query, const GeneratorContext& context, Random& random) {
  if (is_decided_soon(query, context.separation())) return query;
  return of_numbers(query.shape(), context.separation(), random);
}

/// The cell with a positive volume at t=0, mostly.
Query upright(CellKind kind, Query query, Random& random) {
  Query at_rest = query;
  for (std::size_t point = 0; point < moving_points; ++point) {
    point_of(at_rest, 1, point) = point_of(query, 0, point);
  }
  const bool starts_inverted = fast::inversion(kind, at_rest).verdict == fast::Verdict::yes;
  if (!starts_inverted || one_in(random, 8)) return query;
  for (const std::size_t end : {0U, 1U}) point_of(query, end, 1).swap(point_of(query, end, 2));
  return query;
}

/// A query on straight lines as one of a shape, also on curves. Points that touch as two edges are
/// in one plane: the volume of a tetrahedron is 0.
AnyQuery posed(const AnyShape& shape, const Query& query, const GeneratorContext& context,
               Random& random) {
  if (shape.kind.is_cell()) return {shape.kind, upright(shape.kind.cell(), query, random)};
  if (shape.is_straight()) return {shape.kind, query};
  return decided_soon(on_curves(shape, query, random), context, random);
}

template <Query (*make)(ContactKind, const GeneratorContext&, Random&)>
AnyQuery lines(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  const ContactKind kind = shape.kind.is_cell() ? ContactKind::edge_edge : shape.kind.contact();
  return posed(shape, make(kind, context, random), context, random);
}

// ---- From other queries -------------------------------------------------------------------------

AnyQuery family(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  const std::vector<generate::Family>& families = context.families(shape.kind);
  const generate::Family& chosen = families.at(below(random, families.size()));
  const std::uint64_t seed = random.bits();
  const auto known =
      generate::make_query(chosen, shape.kind, seed, below(random, 1000), context.separation());
  return posed(shape, known.query, context, random);
}

AnyQuery from_pool(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  const QueryPool& pool = context.pool(shape);
  if (pool.empty() || one_in(random, 16)) return lines<contact_on_grid>(shape, context, random);
  return pool.draw(random);
}

AnyQuery mutate(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  const bool changes_weights = may_weights_differ(shape, context.separation());
  AnyQuery query = mutated(from_pool(shape, context, random), changes_weights, random);
  if (shape.kind.is_cell())
    return {shape.kind, upright(shape.kind.cell(), query.straight(), random)};
  return decided_soon(std::move(query), context, random);
}

/// Exponents of the greatest coordinate. Mostly close to that of the distance, if there is one,
/// which is irrelevant among coordinates of a very different size.
std::pair<int, int> draw_exponents(const Separation& separation, Random& random) {
  constexpr int most = 1000, near = 30;
  if (is_zero(separation) || one_in(random, 8)) return {-most, most};
  const int middle = std::clamp(std::ilogb(separation.distance), near - most, most - near);
  return {middle - near, middle + near};
}

/// A query of another generator far from 1, with a greatest coordinate from 2^-1000 to 2^1000,
/// sometimes for each axis separately.
AnyQuery scaled(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  AnyQuery result = from_pool(shape, context, random);
  std::array<double, point_axes> greatest{};
  for (std::size_t axis = 0; axis < point_axes; ++axis) {
    double& most = greatest.at(axis);
    for_each_coordinate(result, axis, [&](double x) { most = std::max(most, std::abs(x)); });
  }
  const bool alike = !one_in(random, 3);
  const double most = std::ranges::max(greatest);
  const auto [least_exponent, greatest_exponent] = draw_exponents(context.separation(), random);
  const auto draw = [&, low = least_exponent, high = greatest_exponent] {
    return static_cast<int>(random.between(low, high));
  };
  const int common = draw();
  for (std::size_t axis = 0; axis < point_axes; ++axis) {
    const double size = alike ? most : greatest.at(axis);
    if (size == 0.0) continue;
    const int exponent = (alike ? common : draw()) - std::ilogb(size);
    for_each_coordinate(result, axis, [&](double& x) { x = std::ldexp(x, exponent); });
  }
  return decided_soon(std::move(result), context, random);
}

// ---- Curves -------------------------------------------------------------------------------------

AnyQuery curved_family(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  if (auto query = of_curved_family(shape, random)) return *std::move(query);
  return family(shape, context, random);
}

AnyQuery control_points(const AnyShape& shape, const GeneratorContext& context, Random& random) {
  return of_numbers(shape, context.separation(), random);
}

constexpr std::array<Generator, 13> all_generators{{
    {"family", family},
    {"few_bits", lines<few_bits>},
    {"grid", lines<grid>},
    {"shared_vertices", lines<shared_vertices>},
    {"contact_on_grid", lines<contact_on_grid>},
    {"contact_at_level", lines<contact_at_level>},
    {"contact_rounded", lines<contact_rounded>},
    {"everyday", lines<everyday>},
    {"mutated", mutate},
    {"scaled", scaled},
    {"apart", lines<apart>, true},
    {"curved_family", curved_family, false, true},
    {"control_points", control_points, false, true},
}};

}  // namespace

void QueryPool::add(AnyQuery query) {
  if (latest_.size() < most_latest) {
    latest_.push_back(std::move(query));
    return;
  }
  latest_[oldest_] = std::move(query);
  oldest_ = (oldest_ + 1) % most_latest;
}

const AnyQuery& QueryPool::draw(Random& random) const {
  const bool from_kept = latest_.empty() || (!kept_.empty() && random.coin());
  const std::vector<AnyQuery>& from = from_kept ? kept_ : latest_;
  return from[below(random, from.size())];
}

GeneratorContext::GeneratorContext(const Separation& separation) : separation_(separation) {
  const std::vector<std::string> straight{"1"};
  for (const generate::Family& family : generate::families(separation, straight)) {
    for (const AnyKind kind : all_kinds) {
      if (generate::supports(family, kind)) families_.at(kind.index()).push_back(family);
    }
  }
}

std::span<const Generator> generators() { return all_generators; }

std::vector<Generator> generators(const Separation& separation, bool on_curves) {
  std::vector<Generator> result;
  std::ranges::copy_if(all_generators, std::back_inserter(result), [&](const Generator& generator) {
    return (!generator.needs_distance || !is_zero(separation)) &&
           (!generator.is_of_curves || on_curves);
  });
  return result;
}

namespace {

/// Another coordinate of the same axis, for equal coordinates, or another weight.
double some_like(const AnyQuery& query, const double& number, Random& random) {
  const std::span<const double> all = query.numbers();
  const std::size_t size = query.shape().numbers_of_point();
  const auto index = static_cast<std::size_t>(&number - all.data());
  return all[size * below(random, all.size() / size) + index % size];
}

void flip_bit(double& x, Random& random) {
  const std::uint64_t bit = std::uint64_t{1} << below(random, 64);
  const auto flipped = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ bit);
  if (std::isfinite(flipped)) x = flipped;
}

/// Keeps the leading bits only.
void shorten(double& x, Random& random) {
  const std::uint64_t dropped = (std::uint64_t{1} << (28 + below(random, 25))) - 1;
  x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~dropped);
}

void rescale(double& x, Random& random) {
  const double scaled = std::ldexp(x, static_cast<int>(random.between(-8, 8)));
  if (std::isfinite(scaled)) x = scaled;
}

void change_number(AnyQuery& query, Random& random) {
  double& x = some_number(query.numbers(), random);
  switch (below(random, 7)) {
    case 0:
      flip_bit(x, random);
      break;
    case 1:
      x = some_like(query, x, random);
      break;
    case 2:
      x = -x;
      break;
    case 3:
      x = 0.0;
      break;
    case 4:
      shorten(x, random);
      break;
    case 5:
      rescale(x, random);
      break;
    default:
      nudge_numbers(query.numbers(), random);
  }
}

void change_points(AnyQuery& query, Random& random) {
  const std::size_t point = below(random, moving_points), other = below(random, moving_points);
  const std::size_t degree = query.shape().degree, control = below(random, degree + 1);
  const auto at = [&](std::size_t j, std::size_t index) {
    const std::size_t size = query.shape().numbers_of_point();
    return query.numbers().subspan((moving_points * j + index) * size, size);
  };
  switch (below(random, 4)) {
    case 0:
      std::ranges::swap_ranges(at(0, point), at(degree, point));
      break;
    case 1:
      std::ranges::transform(at(control, other), at(control, point).begin(), std::identity{});
      break;
    case 2:
      std::ranges::transform(at(control, point), at(degree - control, point).begin(),
                             std::identity{});
      break;
    default:
      std::ranges::swap_ranges(at(control, point), at(control, other));
  }
}

/// Restores weights that may not change, and those that are invalid or far from 1.
void restore_weights(AnyQuery& query, const AnyQuery& before, bool changes_weights) {
  constexpr double greatest = 0x1p40;
  if (!query.shape().is_rational) return;
  for (std::size_t i = 3; i < query.numbers().size(); i += 4) {
    double& weight = query.numbers()[i];
    const bool is_moderate = weight <= greatest && weight >= 1.0 / greatest;
    if (!changes_weights || !is_moderate) weight = before.numbers()[i];
  }
}

}  // namespace

AnyQuery mutated(const AnyQuery& query, bool changes_weights, Random& random) {
  AnyQuery result = query;
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    if (one_in(random, 4)) {
      change_points(result, random);
    } else {
      change_number(result, random);
    }
  }
  restore_weights(result, query, changes_weights);
  return result;
}

}  // namespace touchstone::verify::fuzz
