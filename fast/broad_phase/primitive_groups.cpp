#include "fast/broad_phase/primitive_groups.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <memory>
#include <type_traits>

#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {
namespace {

namespace tbb = oneapi::tbb;

/// Subtrees of so many groups are split by one task.
constexpr std::size_t groups_of_task = 64;

/// A primitive on its way into a group.
struct alignas(16) Seed {
  std::array<float, 3> centre;
  std::int32_t number;
};

// ---- Selection ----------------------------------------------------------------------------------

/// Moves the seeds that come before the pivot on an axis to the front, and returns how many they are. Without
/// a branch on the seeds, which no processor could foresee: each moves to the front's end, and the one there
/// to the place left by the seed before. \pre there is a seed.
template <std::size_t axis, class Before>
std::size_t partition(std::span<Seed> seeds, float pivot, const Before& before) {
  const Seed first = seeds[0];
  std::size_t count = 0;
  for (std::size_t i = 1; i < seeds.size(); ++i) {
    const Seed seed = seeds[i];
    seeds[i - 1] = seeds[count];
    seeds[count] = seed;
    count += before(seed.centre[axis], pivot) ? 1U : 0U;
  }
  seeds.back() = seeds[count];
  seeds[count] = first;
  return count + (before(first.centre[axis], pivot) ? 1U : 0U);
}

template <std::size_t axis>
void sort_few(std::span<Seed> seeds) {
  for (std::size_t i = 1; i < seeds.size(); ++i) {
    const Seed seed = seeds[i];
    std::size_t place = i;
    for (; place > 0 && seed.centre[axis] < seeds[place - 1].centre[axis]; --place) {
      seeds[place] = seeds[place - 1];
    }
    seeds[place] = seed;
  }
}

/// The number that `rank` of a few others come before; of equal ones the first come first.
float ranked(std::span<const float> few, std::size_t rank) {
  float result = few.front();
  for (std::size_t i = 0; i < few.size(); ++i) {
    std::size_t before = 0;
    for (std::size_t k = 0; k < few.size(); ++k) {
      before += few[k] < few[i] || (few[k] == few[i] && k < i) ? 1U : 0U;
    }
    if (before == rank) result = few[i];
  }
  return result;
}

/// A coordinate that about `rank` of the seeds come before, from a sample. With many seeds rather on the side
/// where more of them are, so that the wanted rank is among the fewer.
template <std::size_t axis>
float pivot_of(std::span<const Seed> seeds, std::size_t rank) {
  static constexpr std::size_t few = 9, most = 257;
  const std::size_t count = seeds.size();
  const std::size_t size = count >= 32768  ? most
                           : count >= 4096 ? 129
                           : count >= 512  ? 33
                           : count >= 128  ? few
                                           : 5;
  std::array<float, most> numbers;
  const auto sample = std::span(numbers).first(size);
  for (std::size_t i = 0; i < size; ++i) {
    sample[i] = seeds[count * (2 * i + 1) / (2 * size)].centre[axis];
  }
  const std::size_t place = rank * size / count;
  if (size <= few) return ranked(sample, place);
  const std::size_t margin = size / 16;
  const std::size_t chosen =
      2 * rank <= count ? std::min(place + margin, size - 1) : place - std::min(place, margin);
  const auto pivot = sample.begin() + static_cast<std::ptrdiff_t>(chosen);
  std::nth_element(sample.begin(), pivot, sample.end());
  return *pivot;
}

/// The first `rank` of the seeds become those with the least coordinates on an axis; which of equal ones
/// depends on their order before.
template <std::size_t axis>
void select(std::span<Seed> seeds, std::size_t rank) {
  static constexpr std::size_t few = 6;
  while (rank > 0 && rank < seeds.size()) {
    if (seeds.size() <= few) {
      sort_few<axis>(seeds);
      return;
    }
    const float pivot = pivot_of<axis>(seeds, rank);
    std::size_t front = partition<axis>(seeds, pivot, std::less<>());
    // The pivot may be the least coordinate: then all that are equal to it are moved, one at least.
    if (front == 0) {
      front = partition<axis>(seeds, pivot, std::less_equal<>());
      if (rank <= front) return;
    }
    if (rank < front) {
      seeds = seeds.first(front);
    } else {
      seeds = seeds.subspan(front);
      rank -= front;
    }
  }
}

// ---- Splitting ----------------------------------------------------------------------------------

/// The axis along which the centres spread most.
std::size_t widest_axis(std::span<const Seed> seeds) {
  const auto row = [](const Seed& seed) { return std::bit_cast<FloatRow>(seed); };
  FloatRow lower = row(seeds.front()), upper = lower;
  for (const Seed& seed : seeds) {
    lower = least(lower, row(seed));
    upper = greatest(upper, row(seed));
  }
  std::size_t widest = 0;
  for (const std::size_t axis : {1U, 2U}) {
    if (upper[axis] - lower[axis] > upper[widest] - lower[widest]) widest = axis;
  }
  return widest;
}

/// How many of more than one group are for the first part: half of a node's children, rounded up.
std::size_t groups_of_first_part(std::size_t groups) {
  std::size_t child = 1;
  while (child * group_size < groups) child *= group_size;
  const std::size_t children = (groups + child - 1) / child;
  return (children + 1) / 2 * child;
}

/// Orders the seeds so that each sixteen are a group.
void split(std::span<Seed> seeds) {
  const std::size_t groups = (seeds.size() + group_size - 1) / group_size;
  if (groups <= 1) return;
  const std::size_t first_groups = groups_of_first_part(groups);
  const std::size_t rank = first_groups * group_size;
  switch (widest_axis(seeds)) {
    case 0:
      select<0>(seeds, rank);
      break;
    case 1:
      select<1>(seeds, rank);
      break;
    default:
      select<2>(seeds, rank);
  }
  const auto split_strictly = [](std::span<Seed> part) {
    // A task may run in a thread with a floating-point environment of its own.
    const StrictFloatingPoint strict;
    split(part);
  };
  if (groups <= groups_of_task) {
    split(seeds.first(rank));
    split(seeds.subspan(rank));
  } else {
    tbb::parallel_invoke([&] { split_strictly(seeds.first(rank)); },
                         [&] { split_strictly(seeds.subspan(rank)); });
  }
}

// ---- Primitives ---------------------------------------------------------------------------------

/// The centre of the primitive's box.
Seed seed_of(const FloatBounds& bounds, const Primitive& primitive, std::int32_t number) {
  const VertexBounds& first = bounds[static_cast<std::size_t>(primitive[0])];
  FloatRow lower = least(first.lower[0], first.lower[1]);
  FloatRow upper = greatest(first.upper[0], first.upper[1]);
  for (const std::size_t corner : {1U, 2U}) {
    const VertexBounds& vertex = bounds[static_cast<std::size_t>(primitive[corner])];
    lower = least(lower, least(vertex.lower[0], vertex.lower[1]));
    upper = greatest(upper, greatest(vertex.upper[0], vertex.upper[1]));
  }
  const FloatRow sum = lower + upper;
  return {.centre = {sum[0], sum[1], sum[2]}, .number = number};
}

template <class Element>
std::int32_t number_of(const Element& element, std::size_t place) {
  if constexpr (std::is_integral_v<Element>) {
    return element;
  } else {
    return static_cast<std::int32_t>(place);
  }
}

/// Calls work(i) for i < count, in parallel and strictly.
template <class Work>
void for_each_strictly(std::size_t count, std::size_t of_task, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, of_task), [&](const auto& range) {
    const StrictFloatingPoint strict;
    for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
}

}  // namespace

template <class Element>
PrimitiveGroups::PrimitiveGroups(const FloatBounds& bounds, std::span<const Element> elements)
    : size_(elements.size()), members_((elements.size() + group_size - 1) / group_size) {
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
  const auto seeds = std::make_unique_for_overwrite<Seed[]>(size_);
  for_each_strictly(size_, groups_of_task * group_size, [&](std::size_t i) {
    seeds[i] = seed_of(bounds, primitive_of(elements[i]), static_cast<std::int32_t>(i));
  });
  split({seeds.get(), size_});
  for_each_strictly(members_.size(), groups_of_task, [&](std::size_t group) {
    GroupMembers& members = members_[group];
    for (std::size_t lane = 0; lane < group_size; ++lane) {
      const std::size_t seed = std::min(group * group_size + lane, size_ - 1);
      const auto place = static_cast<std::size_t>(seeds[seed].number);
      const Primitive primitive = primitive_of(elements[place]);
      members.numbers[lane] = number_of(elements[place], place);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        members.vertices[corner][lane] = primitive[corner];
      }
    }
  });
}

template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const std::int32_t>);
template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Edge>);
template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Face>);

}  // namespace touchstone::fast
