/// \file
/// The kernels against each other, bit for bit, and with faults planted in each of their stages,
/// which the built-in families must find.

#include "fast/certified/kernel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "fast/certified/block.hpp"
#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/kernels.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/inverting_cells.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/random_stream.hpp"
#include "verify/generate/symmetry.hpp"

namespace touchstone::fast {

extern const CertifiedKernel emulated_avx512_certified_kernel;

namespace {

using exact::Rational;
using tests::Random;

Query random_query(Random& random, ContactKind kind) {
  Query query = random.between(0, 2) == 0 ? tests::full_significand_query(random)
                                          : tests::near_contact_query(random, kind);
  switch (random.between(0, 5)) {
    case 0:
      return tests::integer_query(random, 2);
    case 1:
      for (double& x : query.coordinates) x = std::ldexp(x, random.between(-1070, 1000));
      return query;
    case 2:
      for (double& x : query.coordinates) x += 1000.0;
      return query;
    case 3:
      query.coordinates.at(static_cast<std::size_t>(random.between(0, 23))) =
          random.coin() ? std::numeric_limits<double>::infinity()
                        : std::numeric_limits<double>::quiet_NaN();
      return query;
    default:
      return query;
  }
}

/// The items of a list, sorted.
template <class Item, class Projection = std::identity>
std::vector<Item> sorted(const KernelList<Item>& list, const Projection& projection = {}) {
  std::vector<Item> result(list.items.begin(),
                           list.items.begin() + static_cast<std::ptrdiff_t>(list.count));
  std::ranges::sort(result, {}, projection);
  return result;
}

void expect_same_collisions(const KernelOutput& a, const KernelOutput& b) {
  const auto numbers_of = [](const KernelImpact& x) {
    return std::tuple(x.index, x.toi_lower, x.toi_upper, x.u, x.v);
  };
  EXPECT_TRUE(std::ranges::equal(sorted(a.impacts, &KernelImpact::index),
                                 sorted(b.impacts, &KernelImpact::index), {}, numbers_of,
                                 numbers_of));
}

void expect_same(const KernelOutput& a, const KernelOutput& b) {
  EXPECT_EQ(sorted(a.separated_in_direction), sorted(b.separated_in_direction));
  EXPECT_EQ(sorted(a.one_sided), sorted(b.one_sided));
  EXPECT_EQ(sorted(a.rejected), sorted(b.rejected));
  EXPECT_EQ(sorted(a.undecided), sorted(b.undecided));
  expect_same_collisions(a, b);
}

void expect_same(const CellOutput& a, const CellOutput& b) {
  const auto numbers_of = [](const KernelInversion& x) {
    return std::tuple(x.index, x.toi_lower, x.toi_upper);
  };
  EXPECT_EQ(sorted(a.inverted), sorted(b.inverted));
  EXPECT_EQ(sorted(a.undecided), sorted(b.undecided));
  EXPECT_TRUE(std::ranges::equal(sorted(a.inversions, &KernelInversion::index),
                                 sorted(b.inversions, &KernelInversion::index), {}, numbers_of,
                                 numbers_of));
}

std::vector<const CertifiedKernel*> all_kernels() {
  std::vector<const CertifiedKernel*> kernels(certified_kernels().begin(),
                                              certified_kernels().end());
#ifdef TOUCHSTONE_EMULATED_AVX512
  kernels.push_back(&emulated_avx512_certified_kernel);
#endif
  return kernels;
}

/// Decides with the scalar kernel and expects the same of all others.
void expect_same_bits(const KernelInput& input, KernelOutput& plain) {
  const auto other = std::make_unique<KernelOutput>();
  certified_kernels().front()->decide(input, plain);
  for (const CertifiedKernel* const kernel : all_kernels()) {
    SCOPED_TRACE(to_string(kernel->instructions));
    kernel->decide(input, *other);
    expect_same(plain, *other);
  }
}

TEST(CertifiedKernels, InvertWithTheSameBits) {
  const auto plain = std::make_unique<CellOutput>(), other = std::make_unique<CellOutput>();
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    std::vector<Query> cells(static_cast<std::size_t>(random.between(1, kernel_block)));
    for (Query& cell : cells) {
      cell = tests::cell_of_sort(random, random.between(0, tests::sorts_of_cells - 1));
    }
    const CellInput input{.count = cells.size(),
                          .queries = cells.data(),
                          .t_limit = round % 3 == 0 ? random.uniform() : 1.0};
    certified_kernels().front()->invert(input, *plain);
    for (const CertifiedKernel* const kernel : all_kernels()) {
      SCOPED_TRACE(to_string(kernel->instructions));
      kernel->invert(input, *other);
      expect_same(*plain, *other);
    }
  }
}

/// Separations: zero, and from beyond rounding to far below it, in both norms.
Separation separation_of(int round) {
  constexpr std::array<double, 6> distances{0.0, 0.05, 1e-8, 1e-15, 1e-30, 1e300};
  return {.distance = distances.at(static_cast<std::size_t>(round) % distances.size()),
          .norm = round % 4 < 2 ? Norm::linf : Norm::l2};
}

TEST(CertifiedKernels, GiveTheSameBits) {
  const auto plain = std::make_unique<KernelOutput>();
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    Random random(1);
    for (int round = 0; round < 60; ++round) {
      std::vector<Query> queries(static_cast<std::size_t>(random.between(1, kernel_block)));
      for (Query& query : queries) query = random_query(random, kind);
      expect_same_bits({.kind = kind,
                        .count = queries.size(),
                        .queries = queries.data(),
                        .separation = separation_of(round),
                        .t_limit = round % 3 == 0 ? 0.5 : 1.0},
                       *plain);
    }
  }
}

/// Queries as pairs of a mesh, each with vertices of its own.
class Pairs {
 public:
  /// \param far The place of one more vertex, by the size of the coordinates: it makes the unit of
  /// fixed point large. \pre The coordinates are finite.
  Pairs(ContactKind kind, std::span<const Query> queries, double distance, double far = 0.0)
      : kind_(kind), vertices_(places(queries, 0, far), places(queries, 1, far)) {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(queries.size()); ++i) {
      edges_.push_back({4 * i, 4 * i + 1});
      edges_.push_back({4 * i + 2, 4 * i + 3});
      faces_.push_back({4 * i + 1, 4 * i + 2, 4 * i + 3});
      pairs_.push_back(kind == ContactKind::edge_edge ? IndexPair{2 * i, 2 * i + 1}
                                                      : IndexPair{4 * i, i});
    }
    rounded_ = fixed_point_vertices(vertices_, 1.0, distance);
  }

  [[nodiscard]] KernelInput input() const {
    return {.kind = kind_,
            .count = pairs_.size(),
            .vertices = vertices_.data(),
            .edges = edges_.data(),
            .faces = faces_.data(),
            .pairs = pairs_.data(),
            .axis_is_done = true,
            .rounded = rounded_.vertices.data(),
            .rounded_distance = rounded_.distance};
  }

 private:
  using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  static Places places(std::span<const Query> queries, std::size_t end, double far) {
    Places result(4 * static_cast<Eigen::Index>(queries.size()) + 1, 3);
    double size = 0.0;
    double* to = result.data();
    for (const Query& query : queries) {
      for (const double x : std::span(query.coordinates).subspan(12 * end, 12)) {
        size = std::max(size, std::abs(x));
        *to++ = x;
      }
    }
    std::fill(to, to + 3, far * size);
    return result;
  }

  ContactKind kind_;
  Motion vertices_;
  std::vector<Edge> edges_;
  std::vector<Face> faces_;
  std::vector<IndexPair> pairs_;
  FixedPointVertices rounded_;
};

TEST(CertifiedKernels, GiveTheSameBitsOfPairsInSinglePrecision) {
  const auto plain = std::make_unique<KernelOutput>(), other = std::make_unique<KernelOutput>();
  std::size_t decided = 0;
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    Random random(2);
    for (int round = 0; round < 60; ++round) {
      std::vector<Query> queries(static_cast<std::size_t>(random.between(1, kernel_block)));
      for (Query& query : queries) {
        query = round % 2 == 0 ? tests::full_significand_query(random)
                               : tests::near_contact_query(random, kind);
      }
      const Separation separation = separation_of(round);
      const Pairs pairs(kind, queries, separation.distance);
      KernelInput input = pairs.input();
      input.separation = separation;
      expect_same_bits(input, *plain);
      // The collisions are those without single precision.
      if (input.rounded == nullptr) continue;
      decided +=
          queries.size() - plain->rejected.count - plain->impacts.count - plain->undecided.count;
      input.rounded = nullptr;
      certified_kernels().back()->decide(input, *other);
      expect_same_collisions(*plain, *other);
    }
  }
  EXPECT_GT(decided, 10000U);
}

TEST(CertifiedKernels, ReadNothingBehindTheLastQuery) {
  // Inputs on the heap: the address sanitizer detects reads beyond them.
  for (std::size_t count : {0U, 1U, 3U, 4U, 5U, 8U, 9U}) {
    Random random(count);
    std::vector<Query> queries(count);
    for (Query& query : queries) query = tests::near_contact_query(random, ContactKind::edge_edge);
    const auto output = std::make_unique<KernelOutput>();
    const auto of_cells = std::make_unique<CellOutput>();
    for (const CertifiedKernel* const kernel : all_kernels()) {
      kernel->decide({.kind = ContactKind::edge_edge, .count = count, .queries = queries.data()},
                     *output);
      EXPECT_LE(output->impacts.count, count);
      for (const CellKind kind : cell_kinds) {
        kernel->invert({.kind = kind, .count = count, .queries = queries.data()}, *of_cells);
        EXPECT_LE(of_cells->inversions.count, count);
      }
    }
  }
}

// ---- Planted faults -----------------------------------------------------------------------------

bool is_wrong(const verify::generate::KnownQuery& known, const CertifiedResult& result) {
  if (result.verdict != (known.collides ? Verdict::yes : Verdict::no)) return true;
  if (!known.collides || !known.toi) return false;
  const bool is_late =
      *known.toi == 0 ? result.toi_lower != 0 : Rational(result.toi_lower) >= *known.toi;
  return is_late || Rational(result.toi_upper) < *known.toi;
}

/// The results of a query: by itself, and as a pair of a mesh, with stages in single precision,
/// whose unit is small or large.
std::vector<CertifiedResult> results(ContactKind kind, const Query& query,
                                     const CertifiedKernel& kernel,
                                     const CertifiedOptions& options = {}) {
  CertifiedOptions with_kernel = options;
  with_kernel.kernels.certified = &kernel;
  std::vector<CertifiedResult> result{fast::solve(kind, query, with_kernel)};
  for (const double far : {0.0, 0x1p22}) {
    const Pairs pair(kind, std::span(&query, 1), options.separation.distance, far);
    CertifiedResult& of_pair = result.emplace_back(CertifiedResult{.verdict = Verdict::no});
    decide_block(
        pair.input(), options.t_max, options, kernel, [&](std::size_t /*i*/) { return query; },
        [&](std::size_t /*i*/, const CertifiedResult& found) { of_pair = found; });
  }
  return result;
}

/// The families in which the kernel's answers are wrong.
std::vector<std::string> families_that_find(const CertifiedKernel& kernel) {
  constexpr std::uint64_t count = 120;
  std::vector<std::string> found;
  for (const verify::generate::Family& family : verify::generate::families()) {
    bool wrong = false;
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      if (!verify::generate::supports(family, kind)) continue;
      for (std::uint64_t i = 0; i < count && !wrong; ++i) {
        const verify::generate::KnownQuery known = verify::generate::make_query(family, kind, 5, i);
        wrong = std::ranges::any_of(
            results(kind, known.query, kernel),
            [&](const CertifiedResult& result) { return is_wrong(known, result); });
      }
    }
    if (wrong) found.emplace_back(family.name);
  }
  return found;
}

tests::Faults<const CertifiedKernel> faults_in_kernels() {
  const tests::PlantedFaults& planted = tests::planted_faults();
  tests::Faults<const CertifiedKernel> faults = planted.certified_kernel;
  faults.insert(faults.end(), planted.single_precision.begin(), planted.single_precision.end());
  return faults;
}

TEST(CertifiedKernels, FamiliesFindNoFaultInTheKernels) {
  for (const CertifiedKernel* const kernel : all_kernels()) {
    EXPECT_TRUE(families_that_find(*kernel).empty()) << to_string(kernel->instructions);
  }
}

TEST(CertifiedKernels, FamiliesFindPlantedFaults) {
  for (const auto& fault : faults_in_kernels()) {
    if (fault.separation.distance > 0.0 || !fault.is_to_be_found() || fault.is_for_fuzzer) continue;
    const std::vector<std::string> found = families_that_find(*fault.part);
    std::printf("%s: found by %zu families\n", fault.name.data(), found.size());
    EXPECT_FALSE(found.empty()) << fault.name;
  }
}

// ---- With a time limit ----

/// A vertex that crosses a face, or an edge that crosses another, in a plane across an axis, and no
/// other axis separates them; the places on that axis have all bits.
Query crossing_on_an_axis(Random& random, ContactKind kind) {
  Query query = kind == ContactKind::vertex_face ? tests::over_triangle(1, 1, 1, -1).query
                                                 : tests::over_edge(1, 1, 1, -1).query;
  const std::size_t firsts = kind == ContactKind::vertex_face ? 1 : 2;
  for (std::size_t end = 0; end < 2; ++end) {
    const double first = random.uniform(end == 0 ? 0.5 : -1.0, end == 0 ? 1.0 : -0.5);
    const double second = random.uniform(-0.25, 0.25);
    for (std::size_t i = 0; i < moving_points; ++i) {
      query.at(end, i, 2) = i < firsts ? first : second;
    }
  }
  return query;
}

/// The number of wrong answers with limits at and beside the time of impact.
int limits_that_find(const CertifiedKernel& kernel) {
  int found = 0;
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    Random random(43);
    for (int i = 0; i < 200; ++i) {
      const Query query = crossing_on_an_axis(random, kind);
      CertifiedOptions options{
          .toi_tolerance = 0.0,
          .separation = {.distance = i % 2 == 0 ? 0.0 : random.uniform(0.01, 0.1),
                         .norm = i % 4 < 2 ? Norm::linf : Norm::l2},
          .kernels = {.certified = &kernel}};
      const auto truth = exact::decide(kind, query, options.separation);
      const CertifiedResult whole = fast::solve(kind, query, options);
      for (const double limit : {whole.toi_lower, whole.toi_upper, 0.5 * whole.toi_upper, 0.999}) {
        options.t_max = limit;
        const CertifiedResult result = fast::solve(kind, query, options);
        found += tests::fault(kind, truth, result, options).has_value() ? 1 : 0;
      }
    }
  }
  return found;
}

TEST(CertifiedKernels, LimitsFindNoFaultInTheKernels) {
  for (const CertifiedKernel* const kernel : all_kernels()) {
    EXPECT_EQ(limits_that_find(*kernel), 0) << to_string(kernel->instructions);
  }
}

TEST(CertifiedKernels, LimitsFindPlantedFaults) {
  for (const auto& fault : tests::planted_faults().time_limit) {
    EXPECT_GT(limits_that_find(*fault.part), 0) << fault.name;
  }
}

TEST(CertifiedKernels, AxesEndWhatIsApartUpToTheLimit) {
  // The height falls from 1 to −1.
  for (const tests::PosedQuery& posed :
       {tests::over_triangle(1, 1, 1, -1), tests::over_edge(1, 1, 1, -1)}) {
    const auto output = std::make_unique<KernelOutput>();
    const auto passes_an_axis = [&](double t_max, double distance) {
      certified_kernels().back()->decide({.kind = posed.kind,
                                          .count = 1,
                                          .queries = &posed.query,
                                          .separation = {.distance = distance, .norm = Norm::linf},
                                          .t_limit = t_max},
                                         *output);
      return output->separated_in_direction.count + output->one_sided.count +
                 output->rejected.count + output->impacts.count + output->undecided.count ==
             0;
    };
    EXPECT_TRUE(passes_an_axis(0.499, 0.0));
    EXPECT_TRUE(passes_an_axis(0.374, 0.25));
    EXPECT_FALSE(passes_an_axis(0.376, 0.25));
    EXPECT_FALSE(passes_an_axis(1.0, 0.0));
  }
}

// ---- One query ----------------------------------------------------------------------------------

using Bits = std::array<std::uint64_t, 4>;
std::tuple<Verdict, bool, Bits> bits_of(const CertifiedResult& x) {
  return {x.verdict, x.is_exact,
          std::bit_cast<Bits>(std::array{x.toi_lower, x.toi_upper, x.u, x.v})};
}

/// The single queries take another kernel, and other ways through it, than those of a batch.
TEST(Certified, OneQueryHasTheBitsOfABatch) {
  constexpr std::size_t size = kernel_block + 26;
  std::vector<Query> queries(size);
  std::vector<CertifiedResult> batch(size);
  const int rounds = tests::soak_trials(60, 100);
  std::array<std::size_t, 2> exact{}, separated{};
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    Random random(44);
    for (int round = 0; round < rounds; ++round) {
      // Few queries of those that the exact stage decides, which takes most of the time.
      for (std::size_t i = 0; i < size; ++i) {
        queries[i] =
            i % 20 == 0 ? random_query(random, kind) : tests::full_significand_query(random);
      }
      constexpr std::array<double, 5> limits{1.0, 0.5, 0.01, 0.0, 0.999};
      const CertifiedOptions options{
          .toi_tolerance = round % 7 == 0 ? 1e-6 : 1e-12,
          .t_max = limits.at(static_cast<std::size_t>(round) % limits.size()),
          .separation = separation_of(round),
          .max_threads = round % 2};
      fast::solve({kind, queries}, batch, options);
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_EQ(bits_of(fast::solve(kind, queries[i], options)), bits_of(batch[i]))
            << tests::PosedQuery{kind, queries[i]} << ' ' << round;
        ++(is_zero(options.separation) ? exact : separated).at(batch[i].is_exact ? 1 : 0);
      }
    }
  }
  EXPECT_GT(std::ranges::min(exact), 0U);
  EXPECT_GT(std::ranges::min(separated), 0U);
}

// ---- With a separation --------------------------------------------------------------------------

/// A polygon r − u p − v q that tilts: it begins and ends some distances d from the origin and is
/// closest at mid-step, at an interior point (optionally a near miss). Its normal is about as long
/// as its sides allow. The bounds of the change by a shift of d, from the sides' coordinates, are
/// therefore sharp, and the determinant's middle Bernstein coefficients are far below its values.
Query tilting(ContactKind kind, double separation, verify::generate::Random& random) {
  // Sides of about 1 first, and a distance beside them.
  const int ratio = static_cast<int>(random.between(2, 40));
  const double distance = std::ldexp(1.0, -ratio);
  const Eigen::Vector3d p(1, 1, 1), q(1, -1, 0), normal = p.cross(q).normalized();
  const double ends = random.uniform(5.0, 13.0) * distance,
               middle = random.uniform(0.2, 1.0) * ends;
  // det = r·(p × q), and p × q = (1, 1, −2) is 4 times as long as a shift along (1, 1, −1) uses of
  // it.
  const Eigen::Vector3d r =
      random.uniform(0.1, 0.45) * (p + q) + middle / 4.0 * Eigen::Vector3d(1, 1, -1);
  // det grows by r·(a × b) from the middle to the ends, and not with the time itself.
  const Eigen::Vector3d along = 0.5 * r.cross(normal);
  const double sign = r.dot((normal + along).cross(along - normal)) > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector3d a = normal + sign * along, b = sign * along - normal;
  const double turn = std::sqrt((ends - middle) / r.dot(a.cross(b)));
  Query query{};
  for (const std::size_t end : {0U, 1U}) {
    const double angle = end == 0 ? turn : -turn;
    const Eigen::Vector3d side_p = p + angle * a, side_q = q + angle * b;
    point_of(query, end, 0) = r;
    if (kind == ContactKind::vertex_face) {
      point_of(query, end, 2) = side_p;
    } else {
      point_of(query, end, 1) = r - side_p;
    }
    point_of(query, end, 3) = side_q;
  }
  for (double& x : query.coordinates) x *= std::ldexp(separation, ratio);
  verify::generate::Symmetry symmetry = verify::generate::draw_symmetry(
      kind, query, {.distance = separation, .norm = Norm::linf}, random);
  symmetry.reversed = false;
  return image(symmetry, query).value_or(query);
}

/// A query whose motions are at most about the distance of its points, or tiny.
Query query_near(Random& random, ContactKind kind, double distance, int i) {
  if (i % 5 == 0) {
    verify::generate::Random drawn(random.bits());
    return tilting(kind, distance, drawn);
  }
  return i % 3 == 0 ? tests::full_significand_query(random)
                    : tests::near_contact_query(random, kind);
}

/// The number of distances with a wrong answer.
int distances_that_find(const CertifiedKernel& kernel) {
  int found = 0;
  for (const double distance : {0.25, 1e-2, 1e-8, 1e-15, 1e-16}) {
    bool is_found = false;
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      Random random(41);
      for (int i = 0; i < 400 && !is_found; ++i) {
        const Norm norm = i % 2 == 0 ? Norm::linf : Norm::l2;
        const CertifiedOptions options{.separation = {.distance = distance, .norm = norm}};
        const Query query = query_near(random, kind, distance, i);
        is_found = std::ranges::any_of(
            results(kind, query, kernel, options), [&](const CertifiedResult& result) {
              return tests::fault(kind, query, result, options).has_value();
            });
      }
    }
    found += is_found ? 1 : 0;
  }
  return found;
}

TEST(CertifiedKernels, DistancesFindNoFaultInTheKernels) {
  EXPECT_EQ(distances_that_find(*certified_kernels().front()), 0);
  EXPECT_EQ(distances_that_find(*certified_kernels().back()), 0);
}

TEST(CertifiedKernels, DistancesFindPlantedFaults) {
  for (const auto& fault : faults_in_kernels()) {
    if (fault.separation.distance == 0.0) continue;
    const int found = distances_that_find(*fault.part);
    std::printf("%s: found at %d distances\n", fault.name.data(), found);
    EXPECT_GT(found, 0) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast
