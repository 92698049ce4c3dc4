/// \file
/// Inversions in floating point and integers beside the oracle: of all sorts of elements, a half of
/// them degenerate; alone, in batches and of meshes; by every kernel.

#include "touchstone/inversion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/certified_against_oracle.hpp"
#include "tests/support/floating_point_modes.hpp"
#include "tests/support/inverting_elements.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/inversion_oracle.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::fast::inversion_test {
namespace {

using tests::inversion_fault;
using tests::Random;
using tests::soak_trials;
using tests::trials;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string printed(const Query& query) {
  std::ostringstream out;
  out << tests::PosedQuery{Kind::vertex_face, query};
  return out.str();
}

// ---- As queries ---------------------------------------------------------------------------------

TEST(Inversion, AnswersQueriesAboutElements) {
  Random random(7);
  std::vector<Query> queries;
  std::vector<PlaneTriangle> triangles;
  for (int i = 0; i < 1200; ++i) {
    queries.push_back(tests::element_of_sort(random, i % tests::sorts_of_elements));
    triangles.push_back(to_plane_triangle(queries.back()));
  }
  queries[5].at(0, 1, 0) = triangles[5].at(0, 1, 0) = not_a_number;
  std::vector<InversionResult> expected(queries.size());
  for (const Kind kind : {Kind::tetrahedron, Kind::plane_triangle}) {
    if (kind == Kind::tetrahedron) {
      inversions(queries, expected);
    } else {
      inversions(triangles, expected);
    }
    std::vector<CertifiedResult> results(queries.size());
    solve(kind, queries, results);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      for (const CertifiedResult& result : {results[i], solve(kind, queries[i])}) {
        EXPECT_EQ(result.verdict, expected[i].verdict);
        EXPECT_EQ(result.stage, expected[i].stage);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(result.toi_lower),
                  std::bit_cast<std::uint64_t>(expected[i].toi_lower));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(result.toi_upper),
                  std::bit_cast<std::uint64_t>(expected[i].toi_upper));
      }
    }
    EXPECT_THROW(static_cast<void>(solve(kind, queries[0], {.separation = {.distance = 1.0}})),
                 std::invalid_argument);
    EXPECT_THROW(static_cast<void>(distance(kind, queries[0], 0.0)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(tight_inclusion(kind, queries[0])), std::invalid_argument);
    const std::vector<double> curve(36);
    EXPECT_THROW(solve(Queries({.kind = kind, .degree = 2}, curve), std::span(results).first(1)),
                 std::invalid_argument);
  }
}

// ---- By hand ------------------------------------------------------------------------------------

/// The corner of the unit cube, whose last point moves from height 1 to this one.
Query falling_to(double height) {
  return tests::moving({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, height});
}

TEST(Inversion, EndsEachSortOfElementInItsStage) {
  EXPECT_EQ(inversion(falling_to(0.5)).stage, Stage::determinant);
  EXPECT_EQ(inversion(falling_to(0.5)).verdict, Verdict::no);
  const InversionResult through = inversion(falling_to(-3.0));
  EXPECT_EQ(through.stage, Stage::bisection);
  EXPECT_EQ(through.verdict, Verdict::yes);
  EXPECT_LT(through.toi_lower, 0.25);
  EXPECT_GE(through.toi_upper, 0.25);
  // Flat exactly at the end.
  EXPECT_EQ(inversion(falling_to(0.0)).stage, Stage::exact);
  EXPECT_EQ(inversion(falling_to(0.0)).toi_upper, 1.0);
  EXPECT_EQ(inversion(falling_to(0.0), {.t_max = 0.75}).verdict, Verdict::no);
  // Turned by 160 degrees about the z axis on straight lines: 6 V = 1 − 4 s² t (1−t) with s = sin
  // 80°.
  const double c = std::cos(160 * 0x1.921fb54442d18p+1 / 180), s = std::sqrt(1 - c * c);
  const InversionResult turned = inversion(
      tests::moving({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0, c, s, 0, -s, c, 0, 0, 0, 1}));
  EXPECT_EQ(turned.stage, Stage::bisection);
  EXPECT_EQ(turned.verdict, Verdict::no);
  EXPECT_EQ(turned.start, 1);
  // The other orientation, and none.
  Query mirrored = falling_to(-3.0);
  for (const std::size_t end : {0U, 1U}) mirrored.at(end, 3, 2) = -mirrored.at(end, 3, 2);
  const InversionResult inverted = inversion(mirrored);
  EXPECT_EQ(std::tuple(inverted.verdict, inverted.start, inverted.stage),
            std::tuple(Verdict::yes, -1, Stage::determinant));
  EXPECT_EQ(std::pair(inverted.toi_lower, inverted.toi_upper), std::pair(0.0, 0.0));
  const InversionResult flat = inversion(Query{});
  EXPECT_EQ(std::tuple(flat.verdict, flat.start, flat.toi_upper), std::tuple(Verdict::yes, 0, 0.0));
}

TEST(Inversion, RefusesWhatIsNoInput) {
  Query bad = falling_to(1.0);
  bad.at(1, 3, 2) = not_a_number;
  EXPECT_EQ(inversion(bad).verdict, Verdict::error);
  // The others of an array are answered.
  for (std::size_t i = 0; i < bad.coordinates.size(); ++i) {
    for (const double number : {not_a_number, std::numeric_limits<double>::infinity()}) {
      std::vector<Query> several(9, falling_to(-3.0));
      several[4].coordinates.at(i) = number;
      std::vector<InversionResult> results(several.size());
      inversions(several, results);
      for (std::size_t k = 0; k < results.size(); ++k) {
        EXPECT_EQ(results[k].verdict, k == 4 ? Verdict::error : Verdict::yes) << i;
      }
    }
  }
  std::vector<InversionResult> one(1);
  EXPECT_THROW(inversions(std::vector<Query>(2), one), std::invalid_argument);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(4, 3);
  const std::vector<Tetrahedron> beyond{{0, 1, 2, 3}, {0, 1, 2, 4}};
  EXPECT_EQ(tests::message_of<std::out_of_range>(
                [&] { static_cast<void>(inversions(MovingVertices(x, x), beyond)); }),
            "tetrahedron 1: vertex 4, but there are 4");
  x(2, 1) = not_a_number;
  EXPECT_THROW(static_cast<void>(inversions(MovingVertices(x, x), std::vector<Tetrahedron>())),
               std::domain_error);
}

// ---- Beside the oracle --------------------------------------------------------------------------

/// Half of them degenerate.
std::vector<Query> elements(Random& random, int count) {
  std::vector<Query> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(tests::element_of_sort(random, i % tests::sorts_of_elements));
  }
  return result;
}

TEST(Inversion, AgreesWithTheOracleOnTetrahedra) {
  const int count = soak_trials(100'000, 10);
  Random random(1);
  const std::vector<Query> all = elements(random, count);
  std::vector<InversionResult> results(all.size());
  inversions(all, results);
  std::array<int, 3> starts{};
  std::array<int, stage_count> stages{};
  int first_times = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const exact::InversionDecision truth = exact::decide_inversion(all[i]);
    ASSERT_EQ(inversion_fault(truth, results[i]), std::nullopt) << i << ' ' << printed(all[i]);
    ++starts.at(static_cast<std::size_t>(truth.start + 1));
    ++stages.at(static_cast<std::size_t>(results[i].stage));
    first_times += truth.start > 0 && truth.inverts() ? 1 : 0;
  }
  for (const int some : starts) EXPECT_GT(some, count / 20);
  for (const Stage stage : {Stage::determinant, Stage::bisection, Stage::exact}) {
    EXPECT_GT(stages.at(static_cast<std::size_t>(stage)), count / 20) << to_string(stage);
  }
  EXPECT_GT(first_times, count / 5);
  // The exact stage is for degenerate elements.
  EXPECT_LT(stages.at(static_cast<std::size_t>(Stage::exact)), count / 3);
}

TEST(Inversion, AgreesWithTheOracleOnTriangles) {
  const int count = soak_trials(100'000, 10);
  Random random(2);
  std::vector<PlaneTriangle> all;
  for (int i = 0; i < count; ++i) {
    PlaneTriangle triangle = tests::triangle_of_factors(random).first;
    if (i % 4 == 1) {
      double& x = triangle.coordinates.at(static_cast<std::size_t>(random.between(0, 11)));
      x = std::nextafter(x, -x);
    } else if (i % 4 > 1) {
      const double size = std::ldexp(1.0, i % 4 == 2 ? 0 : random.between(-1000, 1000));
      for (std::size_t k = 0; k < 12; ++k) {
        const double corner = k % 6 == 2 || k % 6 == 5 ? 1.0 : 0.0;
        triangle.coordinates.at(k) = size * (corner + random.uniform(-0.7, 0.7));
      }
    }
    all.push_back(triangle);
  }
  std::vector<InversionResult> results(all.size());
  inversions(all, results);
  int first_times = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const exact::InversionDecision truth = exact::decide_inversion(all[i]);
    ASSERT_EQ(inversion_fault(truth, results[i]), std::nullopt)
        << i << ' ' << printed(to_tetrahedron(all[i]));
    first_times += truth.start > 0 && truth.inverts() ? 1 : 0;
  }
  EXPECT_GT(first_times, count / 5);
}

/// Limits at the ends of the enclosure and far from it, and other tolerances.
TEST(Inversion, KeepsLimitAndTolerance) {
  Random random(3);
  for (const Query& query : elements(random, soak_trials(4000, 10))) {
    const exact::InversionDecision truth = exact::decide_inversion(query);
    const InversionResult result = inversion(query);
    std::vector<double> limits{0.0, 0.5};
    if (result.verdict == Verdict::yes) {
      limits.insert(limits.end(), {result.toi_lower, result.toi_upper,
                                   0.5 * (result.toi_lower + result.toi_upper)});
    }
    for (const double t_max : limits) {
      for (const double tolerance : {0.0, 1e-12, 1e-3}) {
        const InversionOptions options{.toi_tolerance = tolerance, .t_max = t_max};
        ASSERT_EQ(inversion_fault(truth, inversion(query, options), options), std::nullopt)
            << t_max << ' ' << tolerance << ' ' << printed(query);
      }
    }
  }
}

/// The part of the volume at the start that is to be kept, with the truth from roots of V − f V(0).
TEST(Inversion, KeepsAPartOfTheVolume) {
  Random random(6);
  int limited = 0;
  for (const double kept : {0.5, 0.1, 1 - 0x1p-53, 0x1p-1074, random.uniform(0.0, 1.0)}) {
    const std::vector<Query> all = elements(random, soak_trials(2000, 10));
    for (const double t_max : {1.0, 0.5}) {
      const InversionOptions options{.t_max = t_max, .kept_volume = kept};
      std::vector<InversionResult> results(all.size());
      inversions(all, results, options);
      for (std::size_t i = 0; i < all.size(); ++i) {
        const exact::InversionDecision truth = tests::inversion_keeping(all[i], kept);
        ASSERT_EQ(inversion_fault(truth, results[i], options), std::nullopt)
            << kept << ' ' << printed(all[i]);
        limited += results[i].toi_upper > 0.0 && !exact::decide_inversion(all[i]).inverts() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(limited, 500);
}

// ---- Ways to ask --------------------------------------------------------------------------------

using Bits = std::array<std::uint64_t, 2>;
std::tuple<Verdict, Stage, int, Bits> bits_of(const InversionResult& x) {
  return {x.verdict, x.stage, x.start, std::bit_cast<Bits>(std::array{x.toi_lower, x.toi_upper})};
}

/// Alone, in an array and of a mesh, by every kernel and in every mode of the caller.
TEST(Inversion, HasTheSameBitsAnyWay) {
  Random random(4);
  const std::vector<Query> all = elements(random, trials(4000));
  const auto rows = static_cast<Eigen::Index>(4 * all.size());
  Eigen::MatrixXd start(rows, 3), end(rows, 3);
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Face> faces;
  std::vector<PlaneTriangle> triangles(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t point = 0; point < 4; ++point) {
      const auto row = static_cast<Eigen::Index>(4 * i + point);
      start.row(row) = all[i].point(0, point).transpose();
      end.row(row) = all[i].point(1, point).transpose();
    }
    const auto first = static_cast<std::int32_t>(4 * i);
    tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    faces.push_back({first, first + 2, first + 3});
    for (const std::size_t at : {0U, 1U}) {
      for (std::size_t point = 0; point < 3; ++point) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
          triangles[i].at(at, point, axis) = all[i].at(at, point == 0 ? 0 : point + 1, axis);
        }
      }
    }
  }
  const MovingVertices vertices(start, end);
  const auto expect_mesh = [](const std::vector<Inversion>& found,
                              const std::vector<InversionResult>& results) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (results[i].verdict != Verdict::yes) continue;
      ASSERT_LT(count, found.size());
      ASSERT_EQ(found[count].element, i);
      ASSERT_EQ(bits_of(found[count].result), bits_of(results[i]));
      ++count;
    }
    EXPECT_EQ(count, found.size());
  };
  std::vector<InversionResult> of_tetrahedra(all.size()), of_triangles(all.size()),
      of_kept(all.size());
  const InversionOptions keeping{.t_max = 0.75, .kept_volume = 0.25};
  inversions(all, of_kept, keeping);
  inversions(all, of_tetrahedra);
  inversions(triangles, of_triangles);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(bits_of(inversion(all[i])), bits_of(of_tetrahedra[i])) << printed(all[i]);
    ASSERT_EQ(bits_of(inversion(triangles[i])), bits_of(of_triangles[i]));
  }
  for (const CertifiedKernel* const kernel : certified_kernels()) {
    SCOPED_TRACE(to_string(kernel->instructions));
    const UseKernels use({.certified = kernel});
    const tests::ChangedModes changed(tests::flush_to_zero | tests::subnormals_are_zero |
                                      tests::round_up);
    std::vector<InversionResult> results(all.size());
    inversions(all, results, {.max_threads = 1});
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(bits_of(results[i]), bits_of(of_tetrahedra[i])) << printed(all[i]);
    }
    inversions(all, results, keeping);
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(bits_of(results[i]), bits_of(of_kept[i])) << printed(all[i]);
    }
    inversions(triangles, results);
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(bits_of(results[i]), bits_of(of_triangles[i]));
    }
    expect_mesh(inversions(vertices, tetrahedra), of_tetrahedra);
    expect_mesh(inversions(vertices, faces, {.max_threads = 2}), of_triangles);
  }
}

// ---- Planted faults -----------------------------------------------------------------------------

/// The number of elements with a wrong answer.
template <class Decide>
int elements_that_find(const Decide& decide) {
  Random random(5);
  int found = 0;
  for (const Query& query : elements(random, 4000)) {
    for (const double kept : {0.0, 0.25}) {
      const exact::InversionDecision truth = tests::inversion_keeping(query, kept);
      for (const double t_max : {1.0, 0.5}) {
        const InversionOptions options{.t_max = t_max, .kept_volume = kept};
        found += inversion_fault(truth, decide(query, options), options) ? 1 : 0;
      }
    }
  }
  for (std::size_t i = 0; i < 24; ++i) {
    Query query = falling_to(0.5);
    query.coordinates.at(i) = not_a_number;
    found += decide(query, {}).verdict == Verdict::error ? 0 : 1;
  }
  return found;
}

TEST(Inversion, ElementsFindPlantedFaults) {
  for (const auto& planted : tests::planted_faults().inversion) {
    if (!planted.is_to_be_found()) continue;
    const int found = elements_that_find([&](const Query& query, const InversionOptions& options) {
      return planted.part(query, options);
    });
    std::printf("%s: found by %d elements\n", planted.name.data(), found);
    EXPECT_GT(found, 0) << planted.name;
  }
  for (const auto& planted : tests::planted_faults().inversion_kernel) {
    if (!planted.is_to_be_found()) continue;
    const UseKernels use({.certified = planted.part});
    const int found = elements_that_find([](const Query& query, const InversionOptions& options) {
      return inversion(query, options);
    });
    std::printf("%s: found by %d elements\n", planted.name.data(), found);
    EXPECT_GT(found, 0) << planted.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::inversion_test
