#include "verify/jobs/prove_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "exact/certificate/step_certificate_text.hpp"
#include "exact/checker/checker.hpp"
#include "tests/support/certificates.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"

// Proofs of steps: the checker accepts each, its claim agrees with the oracle on all pairs one by
// one, and no proof with an omission or a later claim is accepted.

namespace touchstone::verify::jobs::prove_step_test {
namespace {

using tests::Random;
using tests::Scene;

/// The scene with the edges of a mesh: those of the faces too, in order, each once.
Scene with_ordered_edges(Scene scene) {
  std::vector<fast::Face> all = scene.faces;
  for (const auto& [a, b] : scene.edges) all.push_back({a, b, b});
  scene.edges = fast::edges_of(all);
  return scene;
}

struct Proved {
  StepProof proof;
  std::string text;
};

Proved prove(const Scene& scene, const fast::StepOptions& step_options,
             StepProofOptions options = {}) {
  const fast::Step step = scene.step(step_options);
  Proved result;
  result.text = exact::step_certificates_header();
  options.on_text = [&](std::string_view text) { result.text += text; };
  if (options.label.empty()) options.label = "a step";
  result.proof = prove_step(step,
                            {.faces = scene.faces,
                             .points = scene.points,
                             .groups = {.of_vertices = scene.groups,
                                        .apart = scene.apart,
                                        .radii = scene.radii,
                                        .separations = scene.separations},
                             .tetrahedra = scene.tetrahedra,
                             .plane_triangles = scene.plane_triangles},
                            options);
  result.text += exact::step_certificates_closing_line(1);
  return result;
}

/// The checker's reason to refuse; empty if it accepts.
std::string refusal(const std::string& text, const checker::Options& options = {}) {
  std::istringstream in(text);
  const checker::Report report = checker::check(in, options);
  return report.all_accepted() ? "" : report.rejections.at(0).reason;
}

/// The earliest contact of all pairs and elements, by the oracle.
std::optional<exact::AlgebraicNumber> earliest(const Scene& scene,
                                               const fast::StepOptions& options) {
  std::optional<exact::AlgebraicNumber> first;
  const tests::AllPairs all(scene);
  for (const tests::NumberedPair& pair : all.pairs()) {
    const exact::Decision verdict =
        exact::decide(fast::Step::kind_of(pair.first), all.query(pair),
                      {options.separation.distance + all.thickness(pair), options.separation.norm});
    if (verdict.toi && (!first || *verdict.toi < *first)) first = verdict.toi;
  }
  tests::for_each_volume(scene, [&](Kind, std::size_t, const Query& element) {
    const auto time = exact::decide(Kind::tetrahedron, element).toi;
    if (time && (!first || *time < *first)) first = time;
  });
  if (first && *first > exact::Rational(options.t_max)) return std::nullopt;
  return first;
}

/// The numbers of a claim.
std::vector<double> numbers_of(const std::string& claim) {
  std::istringstream words(claim.substr(claim.find(' ')));
  std::vector<double> numbers;
  for (std::string word; words >> word;) numbers.push_back(tests::read_double(word).value());
  return numbers;
}

void expect_true(const Scene& scene, const fast::StepOptions& options, const StepProof& proof) {
  const auto first = earliest(scene, options);
  const std::vector<double> times = numbers_of(proof.claim);
  if (!first) {
    EXPECT_TRUE(proof.claim.starts_with("no_contact ")) << proof.claim;
    EXPECT_EQ(times, std::vector{options.t_max});
    return;
  }
  ASSERT_TRUE(proof.claim.starts_with("earliest ")) << proof.claim;
  ASSERT_EQ(times.size(), 2U);
  EXPECT_TRUE(*first <= exact::Rational(times[1]));
  if (times[1] == 0.0) return;
  EXPECT_TRUE(*first > exact::Rational(times[0]));
  EXPECT_EQ(std::nextafter(times[0], 2.0), times[1]) << proof.claim;
}

/// Expects that the checker accepts the proof with this claim and separation demanded, and not with
/// others.
void expect_demand_kept(const std::string& text, const fast::StepOptions& options,
                        const StepProof& proof) {
  std::ostringstream distance;
  distance << std::hexfloat << options.separation.distance;
  const bool is_l2 = options.separation.norm == Norm::l2;
  const auto demand = [&](const std::string& norm) {
    return checker::Options{.claim = checker::demanded_claim(proof.claim),
                            .separation = checker::demanded_separation(distance.str(), norm)};
  };
  EXPECT_EQ(refusal(text, demand(is_l2 ? "l2" : "linf")), "");
  if (options.separation.distance > 0.0) {
    EXPECT_NE(refusal(text, demand(is_l2 ? "linf" : "l2")), "");
  }
  checker::Options other = demand(is_l2 ? "l2" : "linf");
  other.separation = checker::demanded_separation("0x1p-1030", "l2");
  EXPECT_NE(refusal(text, other), "");
}

// A name of any length makes a label that the checker reads.
TEST(ProveStep, KeepsTheLimitOfALabel) {
  Random random(1);
  const Scene scene = with_ordered_edges(tests::random_scene(random, tests::shapes().front(), 6));
  for (const std::size_t bytes : {1U, 1'019U, 1'024U, 1'025U, 5'000U}) {
    const auto [proof, text] = prove(scene, {}, {.label = std::string(bytes, 'x')});
    ASSERT_EQ(proof.failure, "");
    EXPECT_EQ(refusal(text), "") << bytes;
    const std::size_t kept = std::min<std::size_t>(bytes, exact::label_limit);
    EXPECT_NE(text.find("\nstep " + std::string(kept, 'x') + "\nvertices "), std::string::npos);
  }
}

TEST(ProveStep, KeepsTheLimitOfAScene) {
  Random random(1);
  const Scene scene = with_ordered_edges(tests::random_scene(random, tests::shapes().front(), 6));
  const std::vector<std::int32_t> points(exact::step_item_limit);
  const StepProof proof =
      prove_step(scene.step({}), {.faces = scene.faces, .points = points}, StepProofOptions{});
  EXPECT_EQ(proof.failure, "the scene has more than 4194304 items");
  EXPECT_EQ(proof.bytes, 0U);
}

TEST(ProveStep, ProvesWhatTheOracleSaysOfAllPairs) {
  const std::uint64_t seeds = tests::is_soak() ? 400 : 25;
  int proved = 0, free = 0, failed = 0, with_distance = 0, with_thickness = 0, inverted = 0;
  int free_elements = 0;
  for (const tests::Shape& shape : tests::shapes()) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      Random random(seed);
      Scene scene = with_ordered_edges(tests::random_scene(random, shape, random.between(4, 14)));
      if (seed % 3 == 0) {
        tests::add_thickness(scene, std::min(0.5 * shape.separation, 1e300), random);
        with_thickness += scene.radii.empty() ? 0 : 1;
      }
      fast::StepOptions options;
      if (random.coin()) options.separation.distance = shape.separation;
      options.separation.norm = random.coin() ? Norm::l2 : Norm::linf;
      if (random.coin()) options.t_max = random.coin() ? 0.25 : 0.0;
      if (seed % 2 == 0) tests::add_volumes(scene, 3, 8, random);
      const auto [proof, text] = prove(scene, options);
      if (!proof.failure.empty()) {
        ++failed;
        EXPECT_EQ(shape.name, "all scales") << proof.failure;
        continue;
      }
      ++proved;
      EXPECT_EQ(refusal(text), "") << shape.name << ' ' << seed;
      expect_true(scene, options, proof);
      inverted += text.find("\nelement ") != std::string::npos ? 1 : 0;
      free_elements += text.find("\ntetrahedron\n") != std::string::npos ? 1 : 0;
      expect_demand_kept(text, options, proof);
      free += proof.claim.starts_with("no") ? 1 : 0;
      with_distance += options.separation.distance > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(proved, 200);
  EXPECT_GT(free, 20);
  EXPECT_LT(failed, tests::is_soak() ? 320 : 20);
  EXPECT_GT(with_distance, proved / 4);
  EXPECT_GT(with_thickness, 40);
  EXPECT_GT(inverted, 10);
  EXPECT_GT(free_elements, 5);
  RecordProperty("with_distance", with_distance);
}

/// The lines of a text, and those that begin an argument.
struct Lines {
  explicit Lines(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) all.push_back(line);
    bool is_argument = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      is_argument = is_argument || all[i] == "vertex_face";
      if (is_argument && all[i].front() >= '0' && all[i].front() <= '9') arguments.push_back(i);
    }
  }

  /// All lines but the argument that begins at this line.
  [[nodiscard]] std::string without(std::size_t argument) const {
    std::string text;
    bool is_left_out = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      is_left_out = i == argument || (is_left_out && all[i].starts_with("separate"));
      if (!is_left_out) text += all[i] + '\n';
    }
    return text;
  }

  std::vector<std::string> all;
  std::vector<std::size_t> arguments;
};

TEST(ProveStep, NeedsEachOfItsArguments) {
  Random random(5);
  std::uint64_t directions = 0, certificates = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Scene scene = with_ordered_edges(tests::soup(random, 12, 0.2));
    if (trial % 3 == 2) tests::add_thickness(scene, 0.05, random);
    const auto [proof, text] = prove(scene, {.t_max = trial % 2 == 0 ? 1.0 : 1e-3});
    ASSERT_EQ(refusal(text), "");
    directions += proof.directions;
    certificates += proof.certificates;
    const Lines lines(text);
    EXPECT_EQ(lines.arguments.size(), proof.directions + proof.certificates);
    for (const std::size_t argument : lines.arguments) {
      EXPECT_TRUE(refusal(lines.without(argument)).starts_with("no argument for "));
    }
  }
  EXPECT_GT(directions, 50U);
  EXPECT_GT(certificates, 0U);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what;
  return text.replace(place, what.size(), by);
}

TEST(ProveStep, ClaimsNothingLater) {
  Random random(6);
  int tried = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Scene scene = with_ordered_edges(tests::soup(random, 10, 0.3));
    const auto [proof, text] = prove(scene, {});
    if (!proof.claim.starts_with("earliest ") || proof.claim.starts_with("earliest 0 ")) continue;
    ++tried;
    std::ostringstream later;
    const std::vector<double> times = numbers_of(proof.claim);
    later << std::hexfloat << "earliest " << times[1] << ' ' << std::nextafter(times[1], 2.0);
    EXPECT_NE(refusal(replaced(text, proof.claim, later.str())), "");
    std::ostringstream free;
    free << std::hexfloat << "no_contact " << times[1];
    EXPECT_NE(refusal(replaced(text, proof.claim, free.str())), "");
    EXPECT_NE(refusal(replaced(text, proof.claim, "no_contact 1")), "");
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
    const auto [proof, text] = prove(scene, {});
    EXPECT_EQ(refusal(text), "");
    EXPECT_EQ(proof.claim, triangles == 2 ? "earliest 0 0" : "no_contact 1");
    EXPECT_EQ(proof.certificates, triangles == 2 ? 0U : 1 + triangles);
  }
}

TEST(ProveStep, IsTheSameOnAnyNumberOfThreads) {
  Random random(7);
  const Scene scene = with_ordered_edges(tests::soup(random, 60, 0.3));
  const Proved one = prove(scene, {.max_threads = 1}, {.threads = 1});
  const Proved some = prove(scene, {.max_threads = 3}, {.threads = 3});
  EXPECT_EQ(one.text, some.text);
  EXPECT_GT(one.proof.directions + one.proof.certificates, 100U);
}

TEST(ProveStep, EndsWhenStopped) {
  Random random(8);
  const Scene scene = with_ordered_edges(tests::soup(random, 30, 0.3));
  const std::atomic<bool> stop = true;
  const auto [proof, text] = prove(scene, {.t_max = 1e-3}, {.stop = &stop});
  EXPECT_TRUE(proof.interrupted);
  EXPECT_FALSE(proof.is_complete());
  EXPECT_NE(refusal(text), "");
}

TEST(ProveStep, PassesOnExceptionsOfItsReader) {
  Random random(9);
  const Scene scene = with_ordered_edges(tests::soup(random, 3, 0.3));
  const fast::Step step = scene.step();
  StepProofOptions options;
  options.on_text = [](std::string_view) { throw std::runtime_error("full"); };
  EXPECT_THROW((void)prove_step(step, {.faces = scene.faces, .points = scene.points}, options),
               std::runtime_error);
}

}  // namespace
}  // namespace touchstone::verify::jobs::prove_step_test
