#include "touchstone/scene_certificate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "exact/checker/checker.hpp"
#include "exact/checker/places.hpp"
#include "exact/checker/resting_mesh.hpp"
#include "exact/checker/summary.hpp"
#include "exact/contact/triangle_intersection.hpp"
#include "exact/scene/directions.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rows.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"

// Proofs of steps: the checker accepts each, its claim agrees with the oracle on all pairs one by
// one, and no proof with an omission or a later claim is accepted. And proofs of which elements of
// a mesh intersect: the checker accepts each, none from which a line is left out, and no argument
// that contradicts rational arithmetic.

namespace touchstone::exact::scene_certificate_test {
namespace {

using tests::Places;
using tests::Random;
using tests::refusal;
using tests::Scene;

/// The scene with its edges turned and in another order, those of the faces twice. Edges from a
/// vertex to itself are points, as a certificate lists them.
Scene with_edges_anyhow(Scene scene) {
  for (const auto& [a, b] : scene.edges) {
    if (a == b) scene.points.push_back(a);
  }
  std::erase_if(scene.edges, [](const fast::Edge& edge) { return edge[0] == edge[1]; });
  for (const auto& [a, b] : fast::edges_of(scene.faces)) scene.edges.push_back({b, a});
  std::ranges::reverse(scene.edges);
  return scene;
}

SceneProof prove(const Scene& scene, const fast::StepOptions& step_options,
                 SceneProofOptions options = {}) {
  if (options.label.empty()) options.label = "a step";
  return prove_step(scene.step(step_options), options);
}

/// The earliest contact of all pairs and cells, by the oracle.
std::optional<AlgebraicNumber> earliest(const Scene& scene, const fast::StepOptions& options) {
  std::optional<AlgebraicNumber> first;
  const tests::AllPairs all(scene);
  for (const tests::NumberedPair& pair : all.pairs()) {
    const Decision verdict = decide(
        decided_as(pair.first), all.query(pair),
        {options.solve.separation.distance + all.thickness(pair), options.solve.separation.norm});
    if (verdict.toi && (!first || *verdict.toi < *first)) first = verdict.toi;
  }
  tests::for_each_volume(scene, [&](CellKind, std::size_t, const Query& cell) {
    const auto time = first_inversion(CellKind::tetrahedron, cell);
    if (time && (!first || *time < *first)) first = time;
  });
  if (first && *first > Rational(options.solve.t_max)) return std::nullopt;
  return first;
}

/// The numbers of a claim.
std::vector<double> numbers_of(const std::string& claim) {
  std::istringstream words(claim.substr(claim.find(' ')));
  std::vector<double> numbers;
  for (std::string word; words >> word;) numbers.push_back(tests::read_double(word).value());
  return numbers;
}

void expect_true(const Scene& scene, const fast::StepOptions& options, const SceneProof& proof) {
  const auto first = earliest(scene, options);
  const std::vector<double> times = numbers_of(proof.claim);
  if (!first) {
    EXPECT_TRUE(proof.claim.starts_with("no_contact ")) << proof.claim;
    EXPECT_EQ(times, std::vector{options.solve.t_max});
    return;
  }
  ASSERT_TRUE(proof.claim.starts_with("earliest ")) << proof.claim;
  ASSERT_EQ(times.size(), 2U);
  EXPECT_TRUE(*first <= Rational(times[1]));
  if (times[1] == 0.0) return;
  EXPECT_TRUE(*first > Rational(times[0]));
  EXPECT_EQ(std::nextafter(times[0], 2.0), times[1]) << proof.claim;
}

/// The demand of a claim at the separation of a step.
checker::Options demand(const std::string& claim, const Separation& separation) {
  std::ostringstream distance;
  distance << std::hexfloat << separation.distance;
  return {.claim = checker::demanded_claim(claim),
          .separation = checker::demanded_separation(distance.str(),
                                                     separation.norm == Norm::l2 ? "l2" : "linf")};
}

/// A name of any length makes a label that the checker reads.
TEST(ProveStep, KeepsTheLimitsOfALabelAndAScene) {
  Random random(1);
  const Scene scene = with_edges_anyhow(tests::random_scene(random, tests::shapes().front(), 6));
  for (const std::size_t bytes : {1U, 1'019U, 1'024U, 1'025U, 5'000U}) {
    const SceneProof proof = prove(scene, {}, {.label = std::string(bytes, 'x')});
    ASSERT_EQ(proof.failure, "");
    EXPECT_EQ(refusal(proof.stream), "") << bytes;
    const std::size_t kept = std::min<std::size_t>(bytes, label_limit);
    EXPECT_NE(proof.stream.find("\nstep " + std::string(kept, 'x') + "\nvertices "),
              std::string::npos);
  }
  Scene large = scene;
  large.tetrahedra.assign(scene_item_limit, {0, 1, 2, 3});
  const SceneProof proof = prove(large, {});
  EXPECT_TRUE(proof.failure.starts_with("the scene has 41943") &&
              proof.failure.ends_with(" items, more than 4194304"))
      << proof.failure;
  EXPECT_EQ(proof.bytes, 0U);
  EXPECT_EQ(proof.stream, "");
}

/// Vertices alone collide with nothing, which has a proof, too.
TEST(ProveStep, ProvesThatNothingCollides) {
  const SceneProof proof = prove({.start = Places::Zero(2, 3), .end = Places::Zero(2, 3)}, {});
  EXPECT_EQ(proof.claim, "no_contact 1");
  EXPECT_EQ(refusal(proof.stream), "");
}

TEST(ProveStep, KnowsNoRuleOfVertices) {
  Random random(1);
  Scene scene = tests::soup(random, 4, 0.2);
  scene.can_collide = [](std::int32_t, std::int32_t) { return true; };
  EXPECT_THROW((void)prove(scene, {}), std::invalid_argument);
  EXPECT_THROW((void)prove_mesh(scene.start, scene.elements(), {.can_collide = scene.can_collide}),
               std::invalid_argument);
}

TEST(ProveStep, ProvesWhatTheOracleSaysOfAllPairs) {
  const std::uint64_t seeds = tests::is_soak() ? 400 : 25;
  int proved = 0, free = 0, failed = 0, with_distance = 0, with_thickness = 0, inverted = 0;
  int free_elements = 0;
  for (const tests::Shape& shape : tests::shapes()) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      Random random(seed);
      Scene scene = with_edges_anyhow(tests::random_scene(random, shape, random.between(4, 14)));
      if (seed % 3 == 0) {
        tests::add_thickness(scene, std::min(0.5 * shape.separation, 1e300), random);
        with_thickness += scene.radii.empty() ? 0 : 1;
      }
      fast::StepOptions options;
      if (random.coin()) options.solve.separation.distance = shape.separation;
      options.solve.separation.norm = random.coin() ? Norm::l2 : Norm::linf;
      if (random.coin()) options.solve.t_max = random.coin() ? 0.25 : 0.0;
      if (seed % 2 == 0) tests::add_volumes(scene, 3, 8, random);
      const SceneProof proof = prove(scene, options);
      const std::string& text = proof.stream;
      if (!proof.failure.empty()) {
        ++failed;
        EXPECT_EQ(shape.name, "all scales") << proof.failure;
        continue;
      }
      ++proved;
      EXPECT_EQ(refusal(text, demand(proof.claim, options.solve.separation)), "")
          << shape.name << ' ' << seed;
      expect_true(scene, options, proof);
      checker::Summary summary(checker::Time::step);
      summary.add({proof.claim == "no_contact 1", proof.contact, proof.rules}, true);
      EXPECT_EQ(summary.text(), tests::check_text(text).summary);
      inverted += text.find("\nelement ") != std::string::npos ? 1 : 0;
      free_elements += text.find("\ntetrahedron\n") != std::string::npos ? 1 : 0;
      free += proof.claim.starts_with("no") ? 1 : 0;
      with_distance += options.solve.separation.distance > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(proved, 200);
  EXPECT_GT(free, 20);
  EXPECT_LT(failed, tests::is_soak() ? 320 : 20);
  EXPECT_GT(with_distance, proved / 4);
  EXPECT_GT(with_thickness, 40);
  EXPECT_GT(inverted, 10);
  EXPECT_GT(free_elements, 5);
}

TEST(ProveStep, NeedsEachOfItsArguments) {
  Random random(5);
  std::uint64_t directions = 0, certificates = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Scene scene = with_edges_anyhow(tests::soup(random, 12, 0.2));
    if (trial % 3 == 2) tests::add_thickness(scene, 0.05, random);
    const SceneProof proof = prove(scene, {.solve = {.t_max = trial % 2 == 0 ? 1.0 : 1e-3}});
    const std::string& text = proof.stream;
    ASSERT_EQ(refusal(text), "");
    directions += proof.directions;
    certificates += proof.certificates;
    const std::vector<std::string> lines = tests::split(text, "\n");
    std::uint64_t arguments = 0;
    for (auto line = std::ranges::find(lines, "vertex_face"); line != lines.end(); ++line) {
      if (line->empty() || line->front() < '0' || line->front() > '9') continue;
      ++arguments;
      // The lines of an argument begin with its pair.
      std::vector<std::string> altered(lines.begin(), line);
      const auto is_other = [](const std::string& next) { return !next.starts_with("separate"); };
      altered.insert(altered.end(), std::find_if(line + 1, lines.end(), is_other), lines.end());
      EXPECT_TRUE(refusal(tests::joined(altered, "\n")).starts_with("no argument for "));
    }
    EXPECT_EQ(arguments, proof.directions + proof.certificates);
  }
  EXPECT_GT(directions, 50U);
  EXPECT_GT(certificates, 0U);
}

TEST(ProveStep, ClaimsNothingLater) {
  Random random(6);
  int tried = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Scene scene = with_edges_anyhow(tests::soup(random, 10, 0.3));
    const SceneProof proof = prove(scene, {});
    const std::string& text = proof.stream;
    if (!proof.claim.starts_with("earliest ") || proof.claim.starts_with("earliest 0 ")) continue;
    ++tried;
    std::ostringstream later;
    const std::vector<double> times = numbers_of(proof.claim);
    later << std::hexfloat << "earliest " << times[1] << ' ' << std::nextafter(times[1], 2.0);
    EXPECT_NE(refusal(tests::replaced(text, proof.claim, later.str())), "");
    std::ostringstream free;
    free << std::hexfloat << "no_contact " << times[1];
    EXPECT_NE(refusal(tests::replaced(text, proof.claim, free.str())), "");
    EXPECT_NE(refusal(tests::replaced(text, proof.claim, "no_contact 1")), "");
  }
  EXPECT_GT(tried, 10);
}

/// The area is that of (1 − 3t)² + h², which the checker sees in several subintervals only.
TEST(ProveStep, DividesTheTimeOfNearlyFlatElements) {
  constexpr double h = 0x1p-200;
  Scene scene{.start = tests::Places{{0, 0, 0}, {1, h, 0}, {-h, 1, 0}, {0, 0, 1}},
              .end = tests::Places{{0, 0, 0}, {-2, h, 0}, {-h, -2, 0}, {0, 0, 1}}};
  scene.tetrahedra = {{0, 1, 2, 3}};
  const std::vector<fast::Face> all{{0, 1, 2}, {0, 2, 1}};
  for (const std::size_t triangles : {0U, 1U, 2U}) {
    scene.plane_triangles.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(triangles));
    const SceneProof proof = prove(scene, {});
    const std::string& text = proof.stream;
    EXPECT_EQ(refusal(text), "");
    EXPECT_EQ(proof.claim, triangles == 2 ? "earliest 0 0" : "no_contact 1");
    EXPECT_EQ(proof.certificates, triangles == 2 ? 0U : 1 + triangles);
  }
}

TEST(ProveStep, IsTheSameOnAnyNumberOfThreads) {
  Random random(7);
  const Scene scene = with_edges_anyhow(tests::soup(random, 60, 0.3));
  const SceneProof one = prove(scene, {.solve = {.max_threads = 1}}, {.max_threads = 1});
  const SceneProof some = prove(scene, {.solve = {.max_threads = 3}}, {.max_threads = 3});
  EXPECT_EQ(one.stream, some.stream);
  EXPECT_GT(one.directions + one.certificates, 100U);
  std::string text;
  const SceneProof read =
      prove(scene, {}, {.on_text = [&text](std::string_view part) { text += part; }});
  EXPECT_EQ(step_certificates_header().data() + text + step_certificates_closing_line(1),
            one.stream);
  EXPECT_EQ(read.stream, "");
}

TEST(ProveStep, EndsWhenStoppedAndPassesOnExceptionsOfItsReader) {
  Random random(8);
  const Scene scene = tests::soup(random, 30, 0.3);
  const std::atomic<bool> stop = true;
  const SceneProof proof = prove(scene, {.solve = {.t_max = 1e-3}}, {.stop = &stop});
  EXPECT_TRUE(proof.interrupted);
  EXPECT_FALSE(proof.is_complete());
  EXPECT_EQ(proof.stream, "");
  const SceneProofOptions options{
      .on_text = [](std::string_view) { throw std::runtime_error("full"); }};
  EXPECT_THROW((void)prove_step(scene.step(), options), std::runtime_error);
}

// ---- Directions ---------------------------------------------------------------------------------

// A vertex near a triangle in a plane of any position mostly has a direction of small integers.
TEST(FindDirection, FindsOneBetweenWhatIsNear) {
  Random random(2);
  int found = 0;
  for (int trial = 0; trial < 1'000; ++trial) {
    std::array<Eigen::Vector3d, 4> places;
    for (Eigen::Vector3d& place : places) {
      for (double& x : place) x = random.uniform(-1, 1);
    }
    const auto& [vertex, a, b, c] = places;
    places[0] = (a + b + c) / 3 + 0.02 * (b - a).cross(c - a).normalized();
    std::vector<checker::Motion> motions;
    for (const auto& x : places) motions.push_back({{x[0], x[1], x[2]}, {x[0], x[1], x[2]}});
    const std::array<std::int32_t, 4> all{0, 1, 2, 3};
    const std::span vertices(all);
    const checker::Places integers(motions, 0.0, 1);
    found += find_direction(integers, vertices.first(1), vertices.last(3), 0.0) ? 1 : 0;
  }
  EXPECT_GT(found, 950);
}

// ---- Meshes at rest -----------------------------------------------------------------------------

/// The number of intersections that a proof claims.
std::size_t intersections_of(const SceneProof& proof) {
  return std::stoul(proof.claim.substr(proof.claim.find(' ')));
}

checker::Options demanding(std::size_t intersections, bool is_welded = false) {
  const std::string claim = is_welded ? "welded_intersections " : "intersections ";
  return {.claim = claim + std::to_string(intersections)};
}

// Any line left out, of the arguments or of the intersections; the claim follows.
TEST(ProveMesh, WithoutALineIsRefused) {
  Random random(1);
  const Scene scene = tests::soup(random, 24, 0.4);
  const SceneProof proof = prove_mesh(scene.start, scene.elements());
  const std::string& text = proof.stream;
  const std::size_t found = intersections_of(proof);
  ASSERT_GT(found, 4U);
  ASSERT_GT(proof.directions, 50U);
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

// Elements of all kinds in any position, most with repeated vertices, vertices at one place or on a
// line; with groups, welded or not.
TEST(ProveMesh, OfRandomMeshesIsAccepted) {
  const std::uint64_t seeds = tests::is_soak() ? 2'000 : 40;
  std::size_t pairs = 0, intersections = 0, free = 0;
  for (const tests::Shape& shape : tests::shapes()) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      Random random(seed);
      const tests::Scene scene = tests::random_scene(random, shape, random.between(4, 16));
      const fast::IntersectionOptions search{
          .groups = {.of_vertices = scene.groups, .apart = scene.apart}, .weld = random.coin()};
      const SceneProof proof = prove_mesh(scene.start, scene.elements(), search);
      const std::string& text = proof.stream;
      const std::size_t found = intersections_of(proof);
      EXPECT_EQ(proof.failure, "") << shape.name << ' ' << seed;
      EXPECT_EQ(refusal(text, demanding(found, search.weld)), "") << shape.name << ' ' << seed;
      EXPECT_EQ(
          tests::check_text(text).meshes.at(0).find("rules " + proof.rules) != std::string::npos,
          !proof.rules.empty());
      pairs += proof.directions;
      intersections += found;
      free += found == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(pairs, 500U);
  EXPECT_GT(intersections, 100U);
  EXPECT_GT(free, 30U);
}

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
  const auto points = intersection_of(hull_of(as_list(a)), hull_of(as_list(b)));
  return std::ranges::any_of(points, [&](const RationalPoint& x) {
    return common.empty() || intersection_of({x, x, x}, hull_of(common)).empty();
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
    tests::Places places(vertices, 3);
    for (Eigen::Index i = 0; i < vertices; ++i) {
      places.row(i) = Eigen::RowVector3d(scene.vertices[static_cast<std::size_t>(i)].start.data());
    }
    EXPECT_EQ(refusal(prove_mesh(places, {.faces = scene.faces}).stream, demanding(truth ? 1 : 0)),
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

TEST(ProveMesh, KeepsTheLimitsOfAMeshAndStopsWhenItIsInterrupted) {
  Random random(2);
  const Scene scene = tests::soup(random, 20, 0.3);
  const std::atomic<bool> stop = true;
  const SceneProof stopped = prove_mesh(scene.start, scene.elements(), {}, {.stop = &stop});
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_EQ(stopped.stream, "");
  fast::IntersectionOptions search;
  search.groups.apart.assign(scene_item_limit, {0, 0});
  const SceneProof large = prove_mesh(scene.start, scene.elements(), search);
  EXPECT_TRUE(large.failure.ends_with(" items, more than 4194304")) << large.failure;
  EXPECT_EQ(large.bytes, 0U);
  // One face many times, which need no argument, but that the checker compares with each other.
  const fast::Mesh many{.faces = std::vector<fast::Face>(4'000, {0, 1, 2})};
  const SceneProof slow =
      prove_mesh(Places::Identity(3, 3).eval(), many, {.groups = {.apart = {{0, 0}}}});
  EXPECT_TRUE(slow.failure.starts_with("the checker compares at most 256 boxes for each byte"))
      << slow.failure;
}

}  // namespace
}  // namespace touchstone::exact::scene_certificate_test
