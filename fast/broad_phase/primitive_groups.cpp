#include "fast/broad_phase/primitive_groups.hpp"

#include <algorithm>
#include <type_traits>

#include "fast/broad_phase/search.hpp"
#include "fast/broad_phase/seeds.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"

namespace touchstone::fast {
namespace {

/// Groups of a subtree that one task splits.
constexpr std::size_t groups_of_task = 64;

// ---- Splitting ----------------------------------------------------------------------------------

/// The number of groups in the first part, of more than one group: half of a node's children,
/// rounded up.
std::size_t groups_of_first_part(std::size_t groups) {
  std::size_t child = 1;
  while (child * group_size < groups) child *= group_size;
  const std::size_t children = (groups + child - 1) / child;
  return (children + 1) / 2 * child;
}

/// Division of seeds into groups.
template <class Take>
class Splitting {
 public:
  /// Calls take(number, seeds) for each group, with the numbers of its seeds.
  Splitting(const SearchKernel& kernel, const Take& take) : kernel_(kernel), take_(take) {}

  /// \param number The number of the first group.
  void run(const SeedPart& part, std::size_t number) const {
    const std::size_t groups = part.capacity / group_size;
    if (groups == 1) {
      take_(number, std::span<const std::int32_t>(part.seeds.numbers, part.count));
      return;
    }
    const std::size_t first_groups = groups_of_first_part(groups);
    const std::size_t rank = first_groups * group_size;
    kernel_.divide(part, rank);
    const auto run_first = [&] { run(part.first(rank), number); };
    const auto run_others = [&] { run(part.others(rank), number + first_groups); };
    if (groups <= groups_of_task) {
      run_first();
      run_others();
    } else {
      tbb::parallel_invoke([&] { strictly(run_first); }, [&] { strictly(run_others); });
    }
  }

 private:
  /// A task may run in a thread with a floating-point environment of its own.
  template <class Work>
  static void strictly(const Work& work) {
    const StrictFloatingPoint strict;
    work();
  }

  const SearchKernel& kernel_;
  const Take& take_;
};

/// Arrays for seeds, and a second buffer of the same size.
class SeedScratch {
 public:
  explicit SeedScratch(std::size_t groups)
      : groups_(groups), centres_(6 * groups), numbers_(2 * groups) {}

  [[nodiscard]] SeedPart part(std::size_t count) {
    return {array(0), array(1), count, groups_ * group_size};
  }

 private:
  template <class Number>
  struct alignas(64) Sixteen {
    std::array<Number, group_size> numbers;
  };

  [[nodiscard]] Seeds array(std::size_t i) {
    const auto centres = [&](std::size_t axis) {
      return centres_[(3 * i + axis) * groups_].numbers.data();
    };
    return {{centres(0), centres(1), centres(2)}, numbers_[i * groups_].numbers.data()};
  }

  std::size_t groups_;
  LargeArray<Sixteen<float>> centres_;
  LargeArray<Sixteen<std::int32_t>> numbers_;
};

// ---- Primitives ---------------------------------------------------------------------------------

/// The sum of the centres of the boxes around all places of a primitive's vertices, times two.
FloatRow centre_of(const FloatBounds& bounds, std::int32_t vertex) {
  const VertexBounds& places = bounds[static_cast<std::size_t>(vertex)];
  return least(places.lower[0], places.lower[1]) + greatest(places.upper[0], places.upper[1]);
}
template <std::size_t corners>
FloatRow centre_of(const FloatBounds& bounds, const std::array<std::int32_t, corners>& element) {
  FloatRow sum = centre_of(bounds, element[0]);
  for (std::size_t i = 1; i < corners; ++i) sum += centre_of(bounds, element[i]);
  return sum;
}

template <class Element>
std::int32_t number_of(const Element& element, std::size_t place) {
  if constexpr (std::is_integral_v<Element>) {
    return element;
  } else {
    return static_cast<std::int32_t>(place);
  }
}

/// Calls work(i) for i < count, in parallel, in the strict floating-point state.
template <class Work>
void for_each_strictly(std::size_t count, std::size_t of_task, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, of_task), [&](const auto& range) {
    const StrictFloatingPoint strict;
    for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
}

/// Sets seeds to the elements.
template <class Element>
void sow(const Seeds& seeds, const FloatBounds& bounds, std::span<const Element> elements) {
  for_each_strictly(elements.size(), groups_of_task * group_size, [&](std::size_t i) {
    const FloatRow centre = centre_of(bounds, elements[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) seeds.centres[axis][i] = centre[axis];
    seeds.numbers[i] = static_cast<std::int32_t>(i);
  });
}

/// Sets the members of a group to the primitives of its seeds.
template <class Element>
void set_members(GroupMembers& members, std::span<const Element> elements,
                 std::span<const std::int32_t> seeds) {
  for (std::size_t lane = 0; lane < group_size; ++lane) {
    const auto place = static_cast<std::size_t>(seeds[std::min(lane, seeds.size() - 1)]);
    const Primitive primitive = primitive_of(elements[place]);
    members.numbers[lane] = number_of(elements[place], place);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      members.vertices[corner][lane] = primitive[corner];
    }
  }
}

}  // namespace

template <class Element>
PrimitiveGroups::PrimitiveGroups(const FloatBounds& bounds, std::span<const Element> elements,
                                 const SearchKernel* kernel)
    : size_(elements.size()), groups_((size_ + group_size - 1) / group_size), members_(groups_) {
  if (size_ == 0) return;
  SeedScratch scratch(groups_);
  const SeedPart all = scratch.part(size_);
  sow(all.seeds, bounds, elements);
  const auto take = [&](std::size_t group, std::span<const std::int32_t> seeds) {
    set_members(members_[group], elements, seeds);
  };
  Splitting(kernel != nullptr ? *kernel : *search_kernels().back(), take).run(all, 0);
}

template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const std::int32_t>,
                                          const SearchKernel*);
template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Edge>,
                                          const SearchKernel*);
template PrimitiveGroups::PrimitiveGroups(const FloatBounds&, std::span<const Face>,
                                          const SearchKernel*);

}  // namespace touchstone::fast
