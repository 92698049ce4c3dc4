/// \file
/// Inversions in floating point and integers beside the oracle: of all sorts of cells, a half of
/// them degenerate; alone, in batches and of meshes; by every kernel.

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

#include "fast/cells/decision.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/kernels.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/floating_point_modes.hpp"
#include "tests/support/inverting_cells.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/cell.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast::inversion_test {
namespace {

using tests::inversion_fault;
using tests::inversion_truth;
using tests::inversions_keeping;
using tests::Random;
using tests::soak_trials;
using tests::trials;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string printed(const Query& query) {
  std::ostringstream out;
  out << tests::PosedQuery{ContactKind::vertex_face, query};
  return out.str();
}

Inversion inversion(const Query& tetrahedron, const InversionOptions& options = {}) {
  return fast::inversion(CellKind::tetrahedron, tetrahedron, options);
}

std::vector<Inversion> inversions(CellKind kind, const std::vector<Query>& cells,
                                  const InversionOptions& options = {}) {
  std::vector<Inversion> results(cells.size());
  fast::inversions({kind, cells}, results, options);
  return results;
}

// ---- By hand ------------------------------------------------------------------------------------

/// The corner of the unit cube, whose last point moves from height 1 to this one.
Query falling_to(double height) {
  return tests::moving({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                       {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, height});
}

TEST(Inversion, IsDecidedInFloatingPointUnlessItIsDegenerate) {
  EXPECT_FALSE(inversion(falling_to(0.5)).is_exact);
  EXPECT_EQ(inversion(falling_to(0.5)).verdict, Verdict::no);
  const Inversion through = inversion(falling_to(-3.0));
  EXPECT_FALSE(through.is_exact);
  EXPECT_EQ(through.verdict, Verdict::yes);
  EXPECT_LT(through.toi_lower, 0.25);
  EXPECT_GE(through.toi_upper, 0.25);
  // Flat exactly at the end.
  EXPECT_TRUE(inversion(falling_to(0.0)).is_exact);
  EXPECT_EQ(inversion(falling_to(0.0)).toi_upper, 1.0);
  EXPECT_EQ(inversion(falling_to(0.0), {.t_max = 0.75}).verdict, Verdict::no);
  // Turned by 160 degrees about the z axis on straight lines: 6 V = 1 − 4 s² t (1−t) with s = sin
  // 80°.
  const double c = std::cos(160 * 0x1.921fb54442d18p+1 / 180), s = std::sqrt(1 - c * c);
  const Inversion turned = inversion(
      tests::moving({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0, c, s, 0, -s, c, 0, 0, 0, 1}));
  EXPECT_FALSE(turned.is_exact);
  EXPECT_EQ(turned.verdict, Verdict::no);
  EXPECT_EQ(turned.start, 1);
  // The other orientation, and none.
  Query mirrored = falling_to(-3.0);
  for (const std::size_t end : {0U, 1U}) mirrored.at(end, 3, 2) = -mirrored.at(end, 3, 2);
  const Inversion inverted = inversion(mirrored);
  EXPECT_EQ(std::tuple(inverted.verdict, inverted.start, inverted.is_exact),
            std::tuple(Verdict::yes, -1, false));
  EXPECT_EQ(std::pair(inverted.toi_lower, inverted.toi_upper), std::pair(0.0, 0.0));
  const Inversion flat = inversion(Query{});
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
      const auto results = inversions(CellKind::tetrahedron, several);
      for (std::size_t k = 0; k < results.size(); ++k) {
        EXPECT_EQ(results[k].verdict, k == 4 ? Verdict::error : Verdict::yes) << i;
      }
    }
  }
  for (const CellKind kind : cell_kinds) {
    const std::vector<double> curve(36);
    std::vector<Inversion> one(1);
    EXPECT_THROW(fast::inversions(Cells({.kind = kind, .degree = 2}, curve), one),
                 std::invalid_argument);
  }
}

// ---- Beside the oracle --------------------------------------------------------------------------

/// Half of them degenerate.
std::vector<Query> cells(Random& random, int count) {
  std::vector<Query> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(tests::cell_of_sort(random, i % tests::sorts_of_cells));
  }
  return result;
}

TEST(Inversion, AgreesWithTheOracleOnTetrahedra) {
  const int count = soak_trials(100'000, 10);
  Random random(1);
  const std::vector<Query> all = cells(random, count);
  const auto results = inversions(CellKind::tetrahedron, all);
  std::array<int, 3> starts{};
  int exact = 0, first_times = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const tests::InversionTruth truth = inversion_truth(all[i]);
    ASSERT_EQ(inversion_fault(truth, results[i]), std::nullopt) << i << ' ' << printed(all[i]);
    ++starts.at(static_cast<std::size_t>(truth.start + 1));
    exact += results[i].is_exact ? 1 : 0;
    first_times += truth.start > 0 && truth.inverts() ? 1 : 0;
  }
  for (const int some : starts) EXPECT_GT(some, count / 20);
  EXPECT_GT(first_times, count / 5);
  // The exact stage is for degenerate cells.
  EXPECT_GT(exact, count / 20);
  EXPECT_LT(exact, count / 3);
}

TEST(Inversion, AgreesWithTheOracleOnTriangles) {
  const int count = soak_trials(100'000, 10);
  Random random(2);
  std::vector<Query> all;
  for (int i = 0; i < count; ++i) {
    Query triangle = tests::triangle_of_factors(random).tetrahedron;
    const std::size_t end = random.coin() ? 0 : 1, point = random.coin() ? 1 : 2;
    if (i % 4 == 1) {
      double& x = triangle.at(end, point, random.coin() ? 0 : 1);
      x = std::nextafter(x, -x);
    } else if (i % 4 > 1) {
      const double size = std::ldexp(1.0, i % 4 == 2 ? 0 : random.between(-1000, 1000));
      for (std::size_t k = 0; k < 24; ++k) {
        const double corner = k % 12 == 3 || k % 12 == 7 ? 1.0 : 0.0;
        triangle.coordinates.at(k) = size * (corner + random.uniform(-0.7, 0.7));
      }
    }
    triangle.at(end, 3, random.coin() ? 0 : 2) = not_a_number;  // has no effect
    all.push_back(triangle);
  }
  const auto results = inversions(CellKind::plane_triangle, all);
  int first_times = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Query tetrahedron = to_tetrahedron(CellKind::plane_triangle, all[i]);
    const tests::InversionTruth truth = inversion_truth(tetrahedron);
    ASSERT_EQ(inversion_fault(truth, results[i]), std::nullopt) << i << ' ' << printed(tetrahedron);
    first_times += truth.start > 0 && truth.inverts() ? 1 : 0;
  }
  EXPECT_GT(first_times, count / 5);
}

/// Limits at the ends of the enclosure and far from it, and other tolerances.
TEST(Inversion, KeepsLimitAndTolerance) {
  Random random(3);
  for (const Query& query : cells(random, soak_trials(4000, 10))) {
    const tests::InversionTruth truth = inversion_truth(query);
    const Inversion result = inversion(query);
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
    const std::vector<Query> all = cells(random, soak_trials(2000, 10));
    for (const double t_max : {1.0, 0.5}) {
      const InversionOptions options{.t_max = t_max};
      const auto results = inversions_keeping(all, kept, options);
      for (std::size_t i = 0; i < all.size(); ++i) {
        const tests::InversionTruth truth = inversion_truth(all[i], kept);
        ASSERT_EQ(inversion_fault(truth, results[i], options), std::nullopt)
            << kept << ' ' << printed(all[i]);
        limited += results[i].toi_upper > 0.0 && !inversion_truth(all[i]).inverts() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(limited, 500);
}

// ---- Ways to ask --------------------------------------------------------------------------------

using Bits = std::array<std::uint64_t, 2>;
std::tuple<Verdict, bool, int, Bits> bits_of(const Inversion& x) {
  return {x.verdict, x.is_exact, x.start,
          std::bit_cast<Bits>(std::array{x.toi_lower, x.toi_upper})};
}

/// Alone, in an array and of a mesh, by every kernel and in every mode of the caller.
TEST(Inversion, HasTheSameBitsAnyWay) {
  Random random(4);
  const std::vector<Query> all = cells(random, trials(4000));
  const auto rows = static_cast<Eigen::Index>(4 * all.size());
  Eigen::MatrixXd start(rows, 3), end(rows, 3);
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Face> faces;
  for (const Query& query : all) {
    const auto first = static_cast<std::int32_t>(4 * tetrahedra.size());
    for (int point = 0; point < 4; ++point) {
      start.row(first + point) = point_of(query, 0, static_cast<std::size_t>(point)).transpose();
      end.row(first + point) = point_of(query, 1, static_cast<std::size_t>(point)).transpose();
    }
    tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    faces.push_back({first, first + 1, first + 2});
  }
  const auto of_tetrahedra = inversions(CellKind::tetrahedron, all);
  const auto of_triangles = inversions(CellKind::plane_triangle, all);
  const auto of_kept = inversions_keeping(all, 0.25, {.t_max = 0.75});
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(bits_of(inversion(all[i])), bits_of(of_tetrahedra[i])) << printed(all[i]);
    ASSERT_EQ(bits_of(fast::inversion(CellKind::plane_triangle, all[i])), bits_of(of_triangles[i]));
    const Query raised = to_tetrahedron(CellKind::plane_triangle, all[i]);
    ASSERT_EQ(bits_of(inversion(raised)), bits_of(of_triangles[i])) << printed(all[i]);
  }
  for (const CertifiedKernel* const kernel : certified_kernels()) {
    SCOPED_TRACE(to_string(kernel->instructions));
    const tests::ChangedModes changed(tests::flush_to_zero | tests::subnormals_are_zero |
                                      tests::round_up);
    const auto again = inversions(CellKind::tetrahedron, all,
                                  {.max_threads = 1, .kernels = {.certified = kernel}});
    const auto triangles_again =
        inversions(CellKind::plane_triangle, all, {.kernels = {.certified = kernel}});
    const auto kept_again =
        inversions_keeping(all, 0.25, {.t_max = 0.75, .kernels = {.certified = kernel}});
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(bits_of(again[i]), bits_of(of_tetrahedra[i])) << printed(all[i]);
      ASSERT_EQ(bits_of(triangles_again[i]), bits_of(of_triangles[i])) << printed(all[i]);
      ASSERT_EQ(bits_of(kept_again[i]), bits_of(of_kept[i])) << printed(all[i]);
    }
    const Step step(start, end, {.tetrahedra = tetrahedra, .plane_triangles = faces},
                    {.solve = {.kernels = {.certified = kernel}}});
    std::vector<StepInversion> expected;
    for (const auto& [kind, results] : {std::pair(CellKind::tetrahedron, &of_tetrahedra),
                                        std::pair(CellKind::plane_triangle, &of_triangles)}) {
      for (std::size_t i = 0; i < results->size(); ++i) {
        const Inversion& one = results->at(i);
        if (one.verdict != Verdict::yes) continue;
        expected.push_back(
            {kind, static_cast<std::int32_t>(i), one.start, one.toi_lower, one.toi_upper});
      }
    }
    EXPECT_EQ(step.inversions(), expected);
  }
}

// ---- Planted faults -----------------------------------------------------------------------------

/// The number of cells with a wrong answer.
template <class Decide>
int cells_that_find(Decide& decide, const Kernels& kernels) {
  Random random(5);
  int found = 0;
  const std::vector<Query> all = cells(random, 4000);
  for (const double kept : {0.0, 0.25}) {
    for (const double t_max : {1.0, 0.5}) {
      const InversionOptions options{.t_max = t_max, .kernels = kernels};
      const auto results = inversions_keeping(all, kept, options, decide);
      for (std::size_t i = 0; i < all.size(); ++i) {
        found += inversion_fault(inversion_truth(all[i], kept), results[i], options) ? 1 : 0;
      }
    }
  }
  for (std::size_t i = 0; i < 24; ++i) {
    Query query = falling_to(0.5);
    query.coordinates.at(i) = not_a_number;
    const auto results = inversions_keeping({&query, 1}, 0.0, {.kernels = kernels}, decide);
    found += results[0].verdict == Verdict::error ? 0 : 1;
  }
  return found;
}

TEST(Inversion, CellsFindPlantedFaults) {
  const auto expect_found = [](std::string_view name, auto& decide, const Kernels& kernels = {}) {
    const int found = cells_that_find(decide, kernels);
    std::printf("%s: found by %d cells\n", name.data(), found);
    EXPECT_GT(found, 0) << name;
  };
  for (const auto& planted : tests::planted_faults().inversion) {
    if (planted.is_to_be_found()) expect_found(planted.name, *planted.part);
  }
  for (const auto& planted : tests::planted_faults().inversion_kernel) {
    if (!planted.is_to_be_found()) continue;
    expect_found(planted.name, decide_cells, {.certified = planted.part});
  }
}

}  // namespace
}  // namespace touchstone::fast::inversion_test
