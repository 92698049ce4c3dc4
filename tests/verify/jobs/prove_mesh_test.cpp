#include "verify/jobs/prove_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/certificate/step_certificate_text.hpp"
#include "exact/checker/checker.hpp"
#include "exact/checker/resting_mesh.hpp"
#include "exact/contact/triangle_intersection.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rows.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certificate_text.hpp"

// Proofs of which elements intersect: the checker accepts each, none from which a line is left out,
// and no argument that contradicts rational arithmetic.

namespace touchstone::verify::jobs::prove_mesh_test {
namespace {

using tests::Random;

struct Proved {
  MeshProof proof;
  std::size_t intersections = 0;
  std::string text;
};

Proved prove(const mesh::Mesh& mesh, const fast::IntersectionOptions& search = {},
             StepProofOptions options = {}) {
  const auto found = fast::intersections(
      mesh.vertices, {.edges = mesh.edges, .faces = mesh.faces, .points = mesh.points}, search);
  Proved result{
      .proof = {}, .intersections = found.size(), .text = std::string(mesh_certificates_header)};
  options.on_text = [&](std::string_view text) { result.text += text; };
  result.proof = prove_mesh(mesh, search, found, options);
  result.text += mesh_certificates_closing_line;
  return result;
}

/// The checker's reason to refuse; empty if it accepts.
std::string refusal(const std::string& text, const checker::Options& options = {}) {
  std::istringstream in(text);
  const checker::Report report = checker::check(in, options);
  return report.all_accepted() ? "" : report.rejections.at(0).reason;
}

checker::Options demanding(std::size_t intersections, bool is_welded = false) {
  const std::string claim = is_welded ? "welded_intersections " : "intersections ";
  return {.claim = claim + std::to_string(intersections)};
}

// ---- Meshes of known truth ----------------------------------------------------------------------

using Coordinates = std::vector<std::array<double, 3>>;

std::int32_t count_of(const Coordinates& coordinates) {
  return static_cast<std::int32_t>(coordinates.size());
}

/// A grid of n×n squares, each of two faces, over the unit square.
template <class Place>
mesh::Mesh grid(std::int32_t n, const Place& place) {
  Coordinates coordinates;
  std::vector<fast::Face> faces;
  for (std::int32_t i = 0; i <= n; ++i) {
    for (std::int32_t k = 0; k <= n; ++k) {
      coordinates.push_back(place(static_cast<double>(i) / n, static_cast<double>(k) / n));
      if (i == n || k == n) continue;
      const std::int32_t a = i * (n + 1) + k, b = a + n + 1;
      faces.push_back({a, b, a + 1});
      faces.push_back({a + 1, b, b + 1});
    }
  }
  return mesh::make_mesh(coordinates, std::move(faces), {});
}

/// A sphere of rings of quadrangles between two poles.
void add_sphere(Coordinates& coordinates, std::vector<fast::Face>& faces, double x, int rings) {
  const std::int32_t first = count_of(coordinates), around = 2 * rings;
  for (int ring = 1; ring < rings; ++ring) {
    for (int k = 0; k < around; ++k) {
      const double latitude = std::numbers::pi * ring / rings,
                   longitude = 2 * std::numbers::pi * k / around;
      coordinates.push_back({x + std::sin(latitude) * std::cos(longitude),
                             std::sin(latitude) * std::sin(longitude), std::cos(latitude)});
    }
  }
  const std::int32_t north = count_of(coordinates), south = north + 1;
  coordinates.push_back({x, 0, 1});
  coordinates.push_back({x, 0, -1});
  const auto at = [&](int ring, int k) { return first + (ring - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) {
    faces.push_back({north, at(1, k), at(1, k + 1)});
    faces.push_back({south, at(rings - 1, k + 1), at(rings - 1, k)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      faces.push_back({at(ring, k), at(ring + 1, k), at(ring, k + 1)});
      faces.push_back({at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)});
    }
  }
}

mesh::Mesh spheres(const std::vector<double>& centers, int rings) {
  Coordinates coordinates;
  std::vector<fast::Face> faces;
  for (const double x : centers) add_sphere(coordinates, faces, x, rings);
  return mesh::make_mesh(coordinates, std::move(faces), {});
}

mesh::Mesh scaled(mesh::Mesh mesh, double factor) {
  mesh.vertices *= factor;
  return mesh;
}

struct Known {
  std::string name;
  mesh::Mesh mesh;
  bool is_free;
};

std::vector<Known> known_meshes() {
  const auto in_plane = [](double u, double v) { return std::array{u, v, 0.0}; };
  const auto slanting = [](double u, double v) { return std::array{u, v, u * 3 + v * 5}; };
  const auto wavy = [](double u, double v) {
    return std::array{u, v, 0.1 * std::sin(9 * u + 1) * std::cos(7 * v)};
  };
  // Turned back at u = 1/2, a hair above itself, or onto itself.
  const auto folded = [](double u, double v) {
    return std::array{std::abs(u - 0.5), v, u <= 0.5 ? 0.0 : 0x1p-40 * (u - 0.5)};
  };
  const auto flat = [](double u, double v) { return std::array{std::abs(u - 0.5), v, 0.0}; };
  // The vertices of one side at one place.
  const auto pinched = [](double u, double v) { return std::array{u * v, v, v * v}; };
  std::vector<Known> result{{"a grid in a plane", grid(12, in_plane), true},
                            {"a slanting grid", grid(12, slanting), true},
                            {"a wavy grid", grid(12, wavy), true},
                            {"a strip folded to a hair", grid(8, folded), true},
                            {"a strip folded flat", grid(2, flat), false},
                            {"a pinched grid", grid(6, pinched), false},
                            {"a sphere", spheres({0.0}, 10), true},
                            {"two spheres apart", spheres({0.0, 2.5}, 8), true},
                            {"two spheres that cross", spheres({0.0, 1.3}, 8), false},
                            {"a sphere twice", spheres({0.0, 0.0}, 5), false}};
  for (const double scale : {0x1p-1000, 0x1p+1000}) {
    result.push_back({"a small or large wavy grid", scaled(grid(6, wavy), scale), true});
    result.push_back({"small or large spheres", scaled(spheres({0.0, 1.3}, 5), scale), false});
  }
  return result;
}

TEST(ProveMesh, OfKnownMeshesIsAccepted) {
  for (const auto& [name, mesh, is_free] : known_meshes()) {
    const auto [proof, found, text] = prove(mesh);
    EXPECT_EQ(proof.failure, "") << name;
    EXPECT_EQ(found == 0, is_free) << name;
    EXPECT_EQ(refusal(text, demanding(found)), "") << name;
    EXPECT_EQ(proof.bytes, text.size() - mesh_certificates_header.size() -
                               mesh_certificates_closing_line.size());
  }
}

// Any line left out, of the arguments or of the intersections; the claim follows.
TEST(ProveMesh, WithoutALineIsRefused) {
  const auto [proof, found, text] = prove(spheres({0.0, 1.3}, 3));
  ASSERT_GT(found, 4U);
  ASSERT_GT(proof.arguments, 50U);
  std::vector<std::string> lines = tests::split(text, "\n");
  const auto claim = std::ranges::find(lines, "claim intersections " + std::to_string(found));
  ASSERT_NE(claim, lines.end());
  for (auto line = claim + 1; *line != "end"; ++line) {
    if (*line == "separations") continue;
    std::vector<std::string> altered = lines;
    const auto place = altered.begin() + (line - lines.begin());
    const bool is_intersection = line - claim <= static_cast<std::ptrdiff_t>(found);
    const std::size_t said = is_intersection ? found - 1 : found;
    altered[static_cast<std::size_t>(claim - lines.begin())] =
        "claim intersections " + std::to_string(said);
    altered.erase(place);
    EXPECT_TRUE(refusal(tests::joined(altered, "\n")).starts_with("no argument for ")) << *line;
  }
}

// ---- Random meshes ------------------------------------------------------------------------------

mesh::Mesh random_mesh(const tests::Scene& scene) {
  Coordinates coordinates;
  for (Eigen::Index i = 0; i < scene.start.rows(); ++i) {
    coordinates.push_back({scene.start(i, 0), scene.start(i, 1), scene.start(i, 2)});
  }
  mesh::Mesh result = mesh::make_mesh(coordinates, scene.faces, scene.edges);
  result.points = scene.points;
  std::ranges::sort(result.points);
  return result;
}

// Elements of all kinds in any position, most with repeated vertices, vertices at one place or on a
// line; with groups, welded or not.
TEST(ProveMesh, OfRandomMeshesIsAccepted) {
  const std::uint64_t seeds = tests::is_soak() ? 2'000 : 40;
  std::size_t pairs = 0, intersections = 0, free = 0;
  for (const tests::Shape& shape : tests::shapes()) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      Random random(seed);
      const tests::Scene scene = tests::random_scene(random, shape, random.between(4, 16));
      const mesh::Mesh mesh = random_mesh(scene);
      fast::IntersectionOptions search{
          .groups = {.of_vertices = scene.groups, .apart = scene.apart}, .weld = random.coin()};
      const auto [proof, found, text] = prove(mesh, search);
      EXPECT_EQ(proof.failure, "") << shape.name << ' ' << seed;
      EXPECT_EQ(refusal(text, demanding(found, search.weld)), "") << shape.name << ' ' << seed;
      pairs += proof.arguments;
      intersections += found;
      free += found == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(pairs, 500U);
  EXPECT_GT(intersections, 100U);
  EXPECT_GT(free, 30U);
}

// ---- Arguments against rational arithmetic ------------------------------------------------------

using exact::RationalPoint;
using exact::RationalTriangle;

/// True if two elements intersect, by their definition.
bool intersect(const checker::Scene& scene, const checker::Primitive& a,
               const checker::Primitive& b) {
  const auto hull_of = [&](const std::vector<std::int32_t>& vertices) {
    RationalTriangle result;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = static_cast<std::size_t>(vertices[std::min(i, vertices.size() - 1)]);
      for (std::size_t k = 0; k < 3; ++k) result[i][k] = scene.vertices[v].start[k];
    }
    return result;
  };
  const auto as_set = [](const checker::Primitive& element) {
    return std::set<std::int32_t>(element.vertices.begin(), element.vertices.end());
  };
  const auto as_list = [](const checker::Primitive& element) {
    return std::vector<std::int32_t>(element.vertices.begin(), element.vertices.end());
  };
  if (as_set(a) == as_set(b)) return true;
  const auto of_a = as_set(a), of_b = as_set(b);
  std::vector<std::int32_t> common;
  std::ranges::set_intersection(of_a, of_b, std::back_inserter(common));
  const auto points = exact::intersection_of(hull_of(as_list(a)), hull_of(as_list(b)));
  return std::ranges::any_of(points, [&](const RationalPoint& x) {
    return common.empty() || exact::intersection_of({x, x, x}, hull_of(common)).empty();
  });
}

// Two faces of few vertices on a small grid, most of them without an area or with common vertices:
// the truth has a proof, and no argument of small numbers that the checker accepts is false.
TEST(ProveMesh, OfTwoFacesIsTheTruthOfRationalArithmetic) {
  int separated = 0, on_lines = 0, common = 0;
  for (std::uint64_t seed = 0; seed < tests::trials(4'000U); ++seed) {
    Random random(seed);
    checker::Scene scene;
    const int vertices = random.between(3, 6), size = random.between(1, 3);
    for (int i = 0; i < vertices; ++i) {
      const auto x = [&] { return static_cast<double>(random.between(0, size)); };
      const std::array<double, 3> place{x(), x(), random.coin() ? 0.0 : x()};
      scene.vertices.push_back({place, place});
    }
    const auto vertex = [&] { return random.between(0, vertices - 1); };
    for (int i = 0; i < 2; ++i) scene.faces.push_back({vertex(), vertex(), vertex()});
    const checker::RestingMesh mesh(scene, false);
    const bool truth = intersect(scene, mesh[0], mesh[1]);
    Coordinates coordinates;
    for (const checker::Motion& one : scene.vertices) coordinates.push_back(one.start);
    EXPECT_EQ(refusal(prove(mesh::make_mesh(coordinates, scene.faces, {})).text,
                      demanding(truth ? 1 : 0)),
              "")
        << seed;
    const checker::RestingPair pair = mesh.pair(0, 1);
    const auto expect = [&](bool is_accepted, bool claim, int& count) {
      if (!is_accepted) return;
      ++count;
      EXPECT_EQ(claim, truth) << seed;
    };
    expect(pair.is_separated_by_first_plane(), false, separated);
    expect(pair.are_separated_on_lines(), false, on_lines);
    for (int n = 0; n < 20; ++n) {
      checker::Vector d;
      for (auto& x : d) x = random.between(-2, 2);
      expect(mesh.is_separated_by(0, 1, d), false, separated);
      expect(pair.is_separated_by(d), false, separated);
      std::vector<mpz_class> of_a(3), of_b(3);
      for (auto* weights : {&of_a, &of_b}) {
        for (auto& weight : *weights) weight = random.between(-1, 2);
      }
      expect(pair.is_common_point(of_a, of_b), true, common);
    }
  }
  EXPECT_GT(separated, tests::trials(2'000));
  EXPECT_GT(on_lines, tests::trials(5));
  EXPECT_GT(common, tests::trials(50));
}

// ---- Limits and interruption --------------------------------------------------------------------

TEST(ProveMesh, KeepsTheLimitOfAMesh) {
  mesh::Mesh mesh = spheres({0.0}, 3);
  mesh.points.resize(exact::step_item_limit);
  const MeshProof proof = prove_mesh(mesh, {}, {}, {});
  EXPECT_EQ(proof.failure, "the mesh has more than 4194304 items");
  EXPECT_EQ(proof.bytes, 0U);
}

TEST(ProveMesh, StopsWhenItIsInterrupted) {
  const std::atomic<bool> stop = true;
  const auto [proof, found, text] = prove(spheres({0.0}, 6), {}, {.stop = &stop});
  EXPECT_TRUE(proof.interrupted);
  EXPECT_NE(refusal(text), "");
}

}  // namespace
}  // namespace touchstone::verify::jobs::prove_mesh_test
