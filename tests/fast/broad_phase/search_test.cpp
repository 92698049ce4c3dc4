/// \file
/// The searches against each other and against all pairs one by one, and with planted faults.

#include "fast/broad_phase/search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "tests/faults/planted_faults.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "touchstone/filters/double_double.hpp"

namespace touchstone::fast {
extern const SearchKernel emulated_avx512_search_kernel;
}

namespace touchstone::fast::search_test {
namespace {

using tests::Random;
using tests::Scene;
using Pairs = std::vector<IndexPair>;

std::vector<const SearchKernel*> all_kernels() {
  std::vector<const SearchKernel*> kernels(search_kernels().begin(), search_kernels().end());
#ifdef TOUCHSTONE_EMULATED_AVX512
  kernels.push_back(&emulated_avx512_search_kernel);
#endif
  return kernels;
}

/// Triangles, edges and points of a size in a cube; their coordinates are multiples of `grain`, so
/// that boxes often touch, but for a few times `jitter`. All vertices are points.
Scene random_scene(Random& random, int count, double size, double grain, double jitter = 0.0) {
  Scene scene = tests::soup(random, count, size);
  for (tests::Places* const places : {&scene.start, &scene.end}) {
    for (double& x : places->reshaped()) {
      if (grain != 0.0) x = std::round(x / grain) * grain;
      if (jitter != 0.0) x += jitter * random.between(-2, 2);
    }
  }
  scene.points.resize(static_cast<std::size_t>(scene.start.rows()));
  std::iota(scene.points.begin(), scene.points.end(), 0);
  return scene;
}

/// The trees of a scene.
template <std::size_t instants>
struct Trees {
  explicit Trees(const Scene& scene, double distance = 0.0)
      : moving(scene.start, scene.end),
        bounds(moving, 1.0, distance),
        vertex_groups(bounds, std::span<const std::int32_t>(scene.points)),
        edge_groups(bounds, std::span<const Edge>(scene.edges)),
        face_groups(bounds, std::span<const Face>(scene.faces)),
        vertices(vertex_groups),
        edges(edge_groups),
        faces(face_groups) {
    vertices.fit(bounds);
    edges.fit(bounds);
    faces.fit(bounds);
  }

  Motion moving;
  FloatBounds bounds;
  PrimitiveGroups vertex_groups, edge_groups, face_groups;
  BoxTree<instants> vertices, edges, faces;
};

template <std::size_t instants>
Pairs found(const SearchKernel& kernel, const SearchInput<instants>& input) {
  Pairs result;
  PairSink buffer([&](std::span<const IndexPair> pairs) {
    EXPECT_LE(pairs.size(), PairBuffer::capacity);
    EXPECT_GT(pairs.size(), 0U);
    result.insert(result.end(), pairs.begin(), pairs.end());
  });
  kernel.find(input, 0, input.some->members().size(), buffer);
  buffer.flush();
  return result;
}

// ---- All pairs one by one -----------------------------------------------------------------------

/// True if x − y > d, exactly.
bool exceeds(double x, double y, double distance) {
  const auto [difference, error] = filters::exact_difference(x, y);
  return difference > distance || (difference == distance && error > 0.0);
}

/// True if two primitives are apart by more than d on some axis: at both ends in the same order
/// (two instants), or always (one). Exact.
template <std::size_t instants>
bool are_apart(const Scene& scene, const Primitive& a, const Primitive& b, double distance) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::array<bool, 2> above{true, true}, below{true, true};
    for (std::size_t at_a = 0; at_a < 2; ++at_a) {
      for (std::size_t at_b = 0; at_b < 2; ++at_b) {
        if (instants == 2 && at_a != at_b) continue;
        for (const std::int32_t i : a) {
          for (const std::int32_t k : b) {
            const double x = (at_a == 0 ? scene.start : scene.end)(i, axis);
            const double y = (at_b == 0 ? scene.start : scene.end)(k, axis);
            above[at_a] &= exceeds(x, y, distance);
            below[at_a] &= exceeds(y, x, distance);
          }
        }
      }
    }
    if ((above[0] && above[1]) || (below[0] && below[1])) return true;
  }
  return false;
}

template <std::size_t instants, class First, class Second>
Pairs all_pairs(const Scene& scene, std::span<const First> first, std::span<const Second> second,
                double distance) {
  const bool within = static_cast<const void*>(first.data()) == second.data();
  Pairs result;
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t k = within ? i + 1 : 0; k < second.size(); ++k) {
      const Primitive a = primitive_of(first[i]), b = primitive_of(second[k]);
      const bool share_vertex = std::ranges::find_first_of(a, b) != a.end();
      if (share_vertex || are_apart<instants>(scene, a, b, distance)) continue;
      result.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(k)});
    }
  }
  return result;
}

Pairs sorted(Pairs pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

/// The confirmation of unsure pairs by the truth.
template <std::size_t instants>
class Truth final : public PairQuestions {
 public:
  Truth(const Scene& scene, double distance) : scene_(scene), distance_(distance) {}

  [[nodiscard]] bool confirms(const Primitive& a, const Primitive& b) const override {
    return !are_apart<instants>(scene_, a, b, distance_);
  }

 private:
  const Scene& scene_;
  double distance_;
};

/// The first fault of a search of a scene, or nothing.
template <std::size_t instants>
std::string fault(const SearchKernel& kernel, const Scene& scene, double distance,
                  Certainty certainty) {
  const Trees<instants> trees(scene, distance);
  const Truth<instants> truth(scene, distance);
  const auto rules = [&](bool of_edges) {
    return PairRules{.of_edges = of_edges, .certainty = certainty, .questions = &truth};
  };
  const SearchInput<instants> with_faces{&trees.vertices, &trees.faces, rules(false)};
  const SearchInput<instants> of_one_tree{&trees.edges, &trees.edges, rules(true)};
  if (sorted(found(kernel, with_faces)) !=
      all_pairs<instants, std::int32_t, Face>(scene, scene.points, scene.faces, distance)) {
    return "vertices and faces";
  }
  if (sorted(found(kernel, of_one_tree)) !=
      all_pairs<instants, Edge, Edge>(scene, scene.edges, scene.edges, distance)) {
    return "edges";
  }
  return "";
}

/// The first fault in random scenes, or nothing.
std::string first_fault(const SearchKernel& kernel) {
  Random random(21);
  std::string found;
  const auto search = [&](const Scene& scene, double grain, double distance, Certainty certainty,
                          bool at_both_ends) {
    if (found.empty()) found = fault<1>(kernel, scene, distance, certainty);
    if (found.empty() && at_both_ends) {
      found = fault<2>(kernel, scene, distance, certainty);
      if (!found.empty()) found += " at both ends";
    }
    if (found.empty()) return true;
    found += ", grain " + std::to_string(grain) + ", distance " + std::to_string(distance);
    return false;
  };
  constexpr double exact = 0.0625, jitter = 0x1p-30;
  for (int round = 0; round < 6; ++round) {
    const int count = 6 + 6 * round;
    for (const double size : {0.03, 0.2, 1.0}) {
      // Coordinates that are floats, and multiples of 0.1, which are not.
      for (const double grain : {exact, 0.1, 0.0}) {
        const Certainty certainty = grain == exact ? Certainty::all : Certainty::unless_close;
        const Scene scene = random_scene(random, count, size, grain);
        if (!search(scene, grain, 0.0, certainty, grain == exact)) return found;
      }
      // Gaps and overlaps that are too small for floats.
      const Scene near = random_scene(random, count, size, exact, jitter);
      if (!search(near, jitter, 0.0, Certainty::unless_close, false)) return found;
      for (const double distance : {exact, 0.1, 1e-10}) {
        const Scene scene = random_scene(random, count, size, exact);
        for (const Certainty certainty : {Certainty::unless_close, Certainty::none}) {
          if (!search(scene, exact, distance, certainty, true)) return found;
        }
      }
    }
  }
  return "";
}

TEST(Search, FindsExactlyThePairsThatAreNotApart) {
  for (const SearchKernel* const kernel : all_kernels()) {
    EXPECT_EQ(first_fault(*kernel), "") << to_string(kernel->instructions);
  }
}

TEST(Search, MissesNothingWithoutConfirmation) {
  // Without confirmation all pairs of the truth are found, and a few others.
  Random random(22);
  for (const double distance : {0.0, 0.1, 1e-10}) {
    for (const double grain : {0.1, 0.0}) {
      const Scene scene = random_scene(random, 30, 0.2, grain);
      const Trees<2> trees(scene, distance);
      const PairRules rules{.of_edges = true};
      const Pairs some = all_pairs<2, Edge, Edge>(scene, scene.edges, scene.edges, distance);
      for (const SearchKernel* const kernel : all_kernels()) {
        const Pairs more = sorted(found<2>(*kernel, {&trees.edges, &trees.edges, rules}));
        EXPECT_TRUE(std::ranges::includes(more, some));
        EXPECT_LT(more.size(), some.size() + some.size() / 4 + 20);
      }
    }
  }
}

template <std::size_t instants>
void expect_same_order(const Scene& scene) {
  for (const double distance : {0.0, 0.05}) {
    const Trees<instants> trees(scene, distance);
    const SearchInput<instants> with_faces{&trees.vertices, &trees.faces, {}};
    const SearchInput<instants> of_one_tree{&trees.edges, &trees.edges, {.of_edges = true}};
    const Pairs vertex_face = found(*search_kernels().front(), with_faces);
    const Pairs edge_edge = found(*search_kernels().front(), of_one_tree);
    EXPECT_GT(vertex_face.size(), PairBuffer::capacity);
    for (const SearchKernel* const kernel : all_kernels()) {
      EXPECT_EQ(found(*kernel, with_faces), vertex_face) << to_string(kernel->instructions);
      EXPECT_EQ(found(*kernel, of_one_tree), edge_edge) << to_string(kernel->instructions);
    }
  }
}

TEST(Search, GivesTheSamePairsInTheSameOrder) {
  Random random(23);
  for (const double grain : {0.0, 0.01}) {
    const Scene scene = random_scene(random, 1000, 0.08, grain);
    expect_same_order<1>(scene);
    expect_same_order<2>(scene);
  }
}

// ---- The division into groups -------------------------------------------------------------------

/// Seeds in their own arrays, with the values behind them.
class SomeSeeds {
 public:
  explicit SomeSeeds(std::size_t count)
      : capacity_((count + group_size - 1) / group_size * group_size),
        centres_(6 * capacity_ / group_size),
        numbers_(2 * capacity_ / group_size),
        part_{array(0), array(1), count, capacity_} {}

  [[nodiscard]] const SeedPart& part() const { return part_; }

 private:
  struct alignas(64) Floats {
    FloatLanes lanes{};
  };
  struct alignas(64) Numbers {
    IndexLanes lanes{};
  };

  Seeds array(std::size_t i) {
    float* const x = centres_[0].lanes.data() + 3 * i * capacity_;
    return {{x, x + capacity_, x + 2 * capacity_}, numbers_[0].lanes.data() + i * capacity_};
  }

  std::size_t capacity_;
  std::vector<Floats> centres_;
  std::vector<Numbers> numbers_;
  SeedPart part_;
};

using Centres = std::vector<std::array<float, 3>>;

/// The numbers of the least centres and of the others, in the order of the output.
std::array<std::vector<std::int32_t>, 2> divided(const SearchKernel& kernel, const Centres& centres,
                                                 std::size_t rank) {
  SomeSeeds seeds(centres.size());
  const SeedPart& part = seeds.part();
  for (std::size_t i = 0; i < centres.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) part.seeds.centres[axis][i] = centres[i][axis];
    part.seeds.numbers[i] = static_cast<std::int32_t>(i);
  }
  kernel.divide(part, rank);
  std::array<std::vector<std::int32_t>, 2> result;
  const std::array<SeedPart, 2> parts{part.first(rank), part.others(rank)};
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t i = 0; i < parts[side].count; ++i) {
      const std::int32_t number = parts[side].seeds.numbers[i];
      result[side].push_back(number);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (parts[side].seeds.centres[axis][i] != centres[static_cast<std::size_t>(number)][axis]) {
          return {};
        }
      }
    }
  }
  return result;
}

/// The expected output: a stable sort on the widest axis determines which come first.
std::array<std::vector<std::int32_t>, 2> expected_of(const Centres& centres, std::size_t rank) {
  std::array<float, 3> widths{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::ranges::minmax(
        centres, {}, [axis](const std::array<float, 3>& centre) { return centre[axis]; });
    widths[axis] = most[axis] - least[axis];
  }
  const auto axis = static_cast<std::size_t>(std::ranges::max_element(widths) - widths.begin());
  std::vector<std::int32_t> order(centres.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(
      order, {}, [&](std::int32_t i) { return centres[static_cast<std::size_t>(i)][axis]; });
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(rank);
  std::array<std::vector<std::int32_t>, 2> result{std::vector(order.begin(), middle),
                                                  std::vector(middle, order.end())};
  for (auto& numbers : result) std::ranges::sort(numbers);
  return result;
}

/// The first centres that a kernel divides wrongly, or nothing.
std::string first_wrong_division(const SearchKernel& kernel) {
  Random random(26);
  // Any, many equal ones, all sizes, both zeros, and one alone.
  constexpr std::array<float (*)(Random&), 5> kinds{
      [](Random& r) { return static_cast<float>(r.uniform(-1, 1)); },
      [](Random& r) { return static_cast<float>(r.between(-2, 2)); },
      [](Random& r) {
        return static_cast<float>(std::ldexp(r.coin() ? 1 : -1, r.between(-140, 60)));
      },
      [](Random& r) { return r.coin() ? 0.0F : -0.0F; }, [](Random& /*r*/) { return 1.0F; }};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (const std::size_t count : {17U, 31U, 32U, 33U, 100U, 256U, 1000U}) {
      Centres centres(count);
      for (auto& centre : centres) {
        for (float& x : centre) x = kinds.at(kind)(random);
      }
      for (std::size_t rank = group_size; rank < count; rank += group_size) {
        if (divided(kernel, centres, rank) != expected_of(centres, rank)) {
          return "kind " + std::to_string(kind) + ", " + std::to_string(count) + " at " +
                 std::to_string(rank);
        }
      }
    }
  }
  return "";
}

TEST(Division, IsThatOfASort) {
  for (const SearchKernel* const kernel : all_kernels()) {
    EXPECT_EQ(first_wrong_division(*kernel), "") << to_string(kernel->instructions);
  }
}

TEST(Division, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().division) {
    EXPECT_NE(first_wrong_division(*fault.part), "") << fault.name;
  }
}

TEST(Search, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().search) {
    EXPECT_NE(first_fault(*fault.part), "") << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::search_test
