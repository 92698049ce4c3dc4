#include "fast/certified/rescaling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

namespace touchstone::fast {
namespace {

constexpr std::size_t axis_count = 3;

/// Exponents of the greatest coordinates of queries that the kernel decides as they are.
constexpr int least_usual = -64, greatest_usual = 96, usual_difference = 20;
/// The exponent that the greatest coordinates get: high, so that no small coordinate underflows.
constexpr int wanted = 90;
/// The scale of queries with a distance is a multiple of this, so that few kernel calls have them
/// all.
constexpr int scale_step = 64;
constexpr int greatest_scale = 1000;

/// Powers of two for the axes.
using Scale = std::array<int, axis_count>;

/// The exponent of the greatest coordinate of an axis; empty if all are 0.
std::optional<int> exponent_of(const Query& query, std::size_t axis) {
  double greatest = 0.0;
  for (std::size_t i = axis; i < query.coordinates.size(); i += axis_count) {
    greatest = std::max(greatest, std::abs(query.coordinates[i]));
  }
  if (greatest == 0.0 || !std::isfinite(greatest)) return std::nullopt;
  return std::ilogb(greatest);
}

/// A scale for a query of unusual size, if it has a size.
std::optional<Scale> scale_for(const Query& query, double distance) {
  int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
  Scale exponents{};
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    const std::optional<int> exponent = exponent_of(query, axis);
    exponents[axis] = exponent.value_or(wanted);
    if (!exponent) continue;
    least = std::min(least, *exponent);
    most = std::max(most, *exponent);
  }
  if (distance > 0.0) most = std::max(most, std::ilogb(distance));
  if (most < least) return std::nullopt;
  const bool is_usual = least_usual <= most && most <= greatest_usual;
  Scale result;
  if (distance > 0.0) {
    if (is_usual) return std::nullopt;
    const int exponent = (wanted - most) & ~(scale_step - 1);  // a multiple, not above that
    result.fill(std::min(exponent, greatest_scale));
    return result;
  }
  if (is_usual && most - least <= usual_difference) return std::nullopt;
  std::ranges::transform(exponents, result.begin(),
                         [](int exponent) { return std::min(wanted - exponent, greatest_scale); });
  return result;
}

/// x times 2^exponent, if that is exact.
bool scale(double& x, int exponent) {
  const double before = x;
  x *= std::ldexp(1.0, exponent);
  return x * std::ldexp(1.0, -exponent) == before;
}

bool scale(Query& query, const Scale& exponents) {
  bool is_exact = true;
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    is_exact &= scale(query.coordinates[i], exponents[i % axis_count]);
  }
  return is_exact;
}

/// Scaled queries of a block with one distance.
struct Rescaled {
  double distance;
  std::vector<Query> queries;
  std::vector<std::uint32_t> numbers;  ///< in the block
};

/// Collects queries with one distance.
class Batches {
 public:
  void add(double distance, const Query& query, std::uint32_t number) {
    auto batch = std::ranges::find(batches_, distance, &Rescaled::distance);
    if (batch == batches_.end()) batch = batches_.insert(batch, {distance, {}, {}});
    batch->queries.push_back(query);
    batch->numbers.push_back(number);
  }
  [[nodiscard]] const std::vector<Rescaled>& all() const { return batches_; }

 private:
  std::vector<Rescaled> batches_;
};

template <class T>
void append(KernelList<T>& list, const T& item) {
  list.items[list.count++] = item;
}

/// Moves the undecided queries that can be scaled into batches. \param queries the undecided ones
Batches take_scaled(double of_block, std::span<const Query> queries,
                    KernelList<std::uint32_t>& undecided) {
  Batches batches;
  undecided.count = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    // The list is written over: never more items than have been read.
    const std::uint32_t number = undecided.items[i];
    Query query = queries[i];
    double distance = of_block;
    const std::optional<Scale> exponents = scale_for(query, distance);
    if (exponents && scale(query, *exponents) && scale(distance, exponents->front())) {
      batches.add(distance, query, number);
    } else {
      append(undecided, number);
    }
  }
  return batches;
}

/// Appends items about scaled queries, as items about those of the block with these numbers.
template <class T>
void append(KernelList<T>& list, const KernelList<T>& from,
            const std::vector<std::uint32_t>& numbers) {
  for (std::size_t i = 0; i < from.count; ++i) {
    T item = from.items[i];
    if constexpr (std::is_same_v<T, std::uint32_t>) {
      item = numbers[item];
    } else {
      item.index = numbers[item.index];
    }
    append(list, item);
  }
}

void append(KernelOutput& output, const KernelOutput& from,
            const std::vector<std::uint32_t>& numbers) {
  append(output.separated_in_direction, from.separated_in_direction, numbers);
  append(output.one_sided, from.one_sided, numbers);
  append(output.rejected, from.rejected, numbers);
  append(output.impacts, from.impacts, numbers);
  append(output.undecided, from.undecided, numbers);
}
void append(CellOutput& output, const CellOutput& from, const std::vector<std::uint32_t>& numbers) {
  append(output.inverted, from.inverted, numbers);
  append(output.inversions, from.inversions, numbers);
  append(output.undecided, from.undecided, numbers);
}

/// Makes a block one of scaled queries.
void set_scaled(KernelInput& block, double distance) {
  block.axis_is_done = false;
  block.rounded = nullptr;
  block.separation.distance = distance;
}
void set_scaled(CellInput& block, double /*distance*/) { block.kind = CellKind::tetrahedron; }

/// Runs the kernel on the undecided queries that can be scaled, and appends its results.
template <class Input, class Output>
void decide(const Input& block, double distance, void (&function)(const Input&, Output&),
            std::span<const Query> queries, Output& output) {
  thread_local Output result;
  const Batches batches = take_scaled(distance, queries, output.undecided);
  for (const Rescaled& some : batches.all()) {
    Input scaled = block;
    scaled.count = some.queries.size();
    scaled.queries = some.queries.data();
    set_scaled(scaled, some.distance);
    function(scaled, result);
    append(output, result, some.numbers);
  }
}

}  // namespace

void decide_rescaled(const KernelInput& block, KernelFunction& function,
                     std::span<const Query> queries, KernelOutput& output) {
  decide(block, block.separation.distance, function, queries, output);
}

void invert_rescaled(const CellInput& block, CellFunction& function, std::span<const Query> queries,
                     CellOutput& output) {
  decide(block, 0.0, function, queries, output);
}

}  // namespace touchstone::fast
