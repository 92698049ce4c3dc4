/// \file
/// Answers have the same bits in every floating-point state of the caller as in the usual one, and
/// the caller's state stays. The answers in that state are the first of a process, which also
/// check how the kernels were compiled.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/support/floating_point_modes.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast::floating_point_environment_test {
namespace {

using tests::default_modes;
using tests::floating_point_modes;
using tests::flush_to_zero;
using tests::Random;
using tests::round_up;
using tests::set_floating_point_modes;
using tests::subnormals_are_zero;

// ---- States -------------------------------------------------------------------------------------

struct State {
  std::string name;
  std::function<void()> set;

  friend std::ostream& operator<<(std::ostream& out, const State& one) { return out << one.name; }
};

std::vector<State> states() {
  std::vector<State> result{{"upward", [] { std::fesetround(FE_UPWARD); }},
                            {"downward", [] { std::fesetround(FE_DOWNWARD); }},
                            {"towards_zero", [] { std::fesetround(FE_TOWARDZERO); }}};
  const auto add = [&](const char* name, std::uint64_t bits) {
    result.push_back({name, [bits] { set_floating_point_modes(default_modes | bits); }});
  };
  add("flush_to_zero", flush_to_zero);
  add("subnormals_are_zero", subnormals_are_zero);
  add("both", flush_to_zero | subnormals_are_zero);
  add("both_upward", flush_to_zero | subnormals_are_zero | round_up);
#ifdef __SSE2__
  // On AArch64 the flags are in another register.
  add("both_with_a_flag_raised", flush_to_zero | subnormals_are_zero | 1U);
#endif
  return result;
}

// ---- Answers ------------------------------------------------------------------------------------

using Bits = std::vector<std::uint64_t>;

template <class Number>
void put(Bits& bits, Number x) {
  if constexpr (std::is_same_v<Number, double>) {
    bits.push_back(std::bit_cast<std::uint64_t>(x));
  } else {
    bits.push_back(static_cast<std::uint64_t>(x));
  }
}
void put(Bits& bits, const Distance& x) {
  put(bits, x.lower);
  put(bits, x.upper);
}
template <class... Numbers>
requires(sizeof...(Numbers) > 1) void put(Bits& bits, Numbers... several) {
  (put(bits, several), ...);
}
void put(Bits& bits, const CertifiedResult& x) {
  put(bits, x.verdict, x.is_exact, x.toi_lower, x.toi_upper, x.u, x.v);
}
void put(Bits& bits, const StepCollision& x) {
  put(bits, x.kind, x.pair[0], x.pair[1], x.toi_lower, x.toi_upper, x.u, x.v);
}
void put(Bits& bits, const std::vector<IndexPair>& pairs) {
  for (const IndexPair& pair : pairs) put(bits, pair[0], pair[1]);
}

/// Queries near the border of contact, degenerate ones, and subnormals, which a caller that flushes
/// them would lose.
std::vector<Query> queries(ContactKind kind, std::size_t count = 300) {
  Random random(29);
  std::vector<Query> result(count);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] =
        i % 3 == 0 ? tests::integer_query(random, 2) : tests::near_contact_query(random, kind);
    if (i % 5 != 0) continue;
    for (double& x : result[i].coordinates) x = std::ldexp(x, -1060);
  }
  return result;
}

/// Calls ask(kind, query, separation) for these queries at contact and at separations in both
/// norms.
template <class Ask>
std::function<Bits()> of_queries(const Ask& ask, std::size_t count) {
  return [ask, faces = queries(ContactKind::vertex_face, count),
          edges = queries(ContactKind::edge_edge, count)] {
    Bits bits;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (const Separation& separation :
           {Separation{}, Separation{.distance = 1e-3, .norm = Norm::linf},
            Separation{.distance = i % 2 == 0 ? 1e-3 : 0x1p-1070, .norm = Norm::l2}}) {
        ask(bits, ContactKind::vertex_face, faces[i], separation);
        ask(bits, ContactKind::edge_edge, edges[i], separation);
      }
    }
    return bits;
  };
}

void ask_oracle(Bits& bits, ContactKind kind, const Query& query, const Separation& separation) {
  // A distance below 0, though a caller that flushes it sees 0, is refused.
  const auto refused = [&] { (void)exact::decide(kind, query, {-0x1p-1074, Norm::l2}); };
  put(bits, std::size_t{tests::message_of<std::invalid_argument>(refused).empty()});
  const exact::Decision verdict = exact::decide(kind, query, separation);
  put(bits, std::size_t{verdict.collides()});
  if (!verdict.collides()) return;
  const exact::DoubleInterval toi = verdict.toi->enclosure();
  put(bits, toi.lower, toi.upper);
}

void ask_prover(Bits& bits, ContactKind kind, const Query& query, const Separation& separation) {
  const auto verdict = exact::decide(kind, query, separation);
  const std::string text = exact::certificate_stream(exact::prove(kind, query, verdict));
  put(bits, std::hash<std::string>()(text));
}

std::function<Bits()> of_batches() {
  return [faces = queries(ContactKind::vertex_face), edges = queries(ContactKind::edge_edge)] {
    Bits bits;
    for (const int threads : {1, 3}) {
      std::vector<CertifiedResult> results(faces.size());
      for (const double distance : {0.0, 1e-3}) {
        const CertifiedOptions options{.separation = {.distance = distance, .norm = Norm::l2},
                                       .max_threads = threads};
        for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
          solve({kind, kind == ContactKind::vertex_face ? faces : edges}, results, options);
          for (const CertifiedResult& result : results) put(bits, result);
        }
      }
      std::vector<Distance> apart(faces.size());
      for (const Norm norm : {Norm::l2, Norm::linf}) {
        distances(ContactKind::vertex_face, faces, 0.5, norm, apart, threads);
        for (const Distance& one : apart) put(bits, one);
      }
    }
    return bits;
  };
}

/// Asks a step for all its results, of vertices in double or of the same in float.
void ask_step(Bits& bits, const Step& step) {
  for (const StepCollision& one : step.collisions()) put(bits, one);
  if (const auto impact = step.earliest()) put(bits, impact->toi_lower, impact->toi_upper);
  put(bits, std::size_t{step.is_free()}, step.free_step_size().value_or(-1.0));
  if (const auto least = least_distance(step)) put(bits, least->distance);
  for (const StartDistance start : {StartDistance::of_scene, StartDistance::of_pair}) {
    const auto limit = line_search_limit(step, 0.5, {.start_distance = start});
    put(bits, limit.status, limit.step_size, limit.distance);
  }
  for (const ActiveContact& one : active_set(step, {.distance = 0x1p-130, .norm = Norm::l2})) {
    put(bits, static_cast<const StepCollision&>(one));
    for (const Eigen::Vector3d& x : {one.first, one.second, one.normal}) {
      put(bits, x[0], x[1], x[2]);
    }
    put(bits, one.point_error, one.normal_error, std::size_t{one.has_side});
  }
}

/// So many scenes of each shape.
std::vector<tests::Scene> scenes(int count, int vertices) {
  Random random(30);
  std::vector<tests::Scene> result;
  for (const tests::Shape& shape : tests::shapes()) {
    for (int i = 0; i < count; ++i) result.push_back(tests::random_scene(random, shape, vertices));
  }
  return result;
}

std::function<Bits()> of_steps() {
  return [scenes = scenes(4, 9)] {
    Bits bits;
    for (const tests::Scene& scene : scenes) ask_step(bits, scene.step());
    return bits;
  };
}

/// Asks about subnormal floats, which are normal in double.
std::function<Bits()> of_floats() {
  Random random(31);
  std::vector<std::pair<tests::Scene, std::array<Eigen::MatrixX3f, 2>>> scenes;
  for (int i = 0; i < 30; ++i) {
    tests::Scene scene = tests::random_scene(random, tests::shapes()[2], 9);
    scenes.push_back({scene,
                      {Eigen::MatrixX3f((scene.start * 0x1p-135).cast<float>()),
                       Eigen::MatrixX3f((scene.end * 0x1p-135).cast<float>())}});
  }
  return [scenes] {
    Bits bits;
    for (const auto& [scene, places] : scenes) {
      const auto& [start, end] = places;
      ask_step(bits, Step(start, end, scene.elements()));
      put(bits, solve_edge_edge(start.row(0), start.row(1), start.row(2), start.row(3), end.row(0),
                                end.row(1), end.row(2), end.row(3)));
    }
    return bits;
  };
}

std::function<Bits()> of_broad_phase() {
  return [scenes = scenes(1, 60)] {
    Bits bits;
    for (const tests::Scene& scene : scenes) {
      const Motion vertices(scene.start, scene.end);
      for (const double separation : {0.0, 0.1, 0x1.8p-1073}) {
        const BroadPhaseOptions options{.separation = {.distance = separation}};
        put(bits, vertex_face_candidates(vertices, scene.faces, options));
        put(bits, edge_edge_candidates(vertices, scene.edges, options));
      }
    }
    return bits;
  };
}

struct Answers {
  std::string name;
  std::function<Bits()> ask;

  friend std::ostream& operator<<(std::ostream& out, const Answers& one) { return out << one.name; }
};

std::vector<Answers> all_answers() {
  return {{"oracle", of_queries(ask_oracle, 40)},
          {"prover", of_queries(ask_prover, 15)},
          {"batches", of_batches()},
          {"steps", of_steps()},
          {"floats", of_floats()},
          {"broad_phase", of_broad_phase()}};
}

class FloatingPointEnvironment : public testing::TestWithParam<std::tuple<Answers, State>> {};

/// Asks in the state, then in the usual one; ends the process with 0 if that made no difference.
[[noreturn]] void ask_twice(const Answers& answers, const State& state) {
  std::fenv_t callers;
  std::fegetenv(&callers);
  state.set();
  const std::uint64_t before = floating_point_modes();
  const Bits other = answers.ask();
  const std::uint64_t after = floating_point_modes();
  std::fesetenv(&callers);
  const Bits usual = answers.ask();
  constexpr std::uint64_t flags = 0x3F;  // flags that the caller's own arithmetic may raise
  const bool stays = (after & ~flags) == (before & ~flags);
  if (!stays) std::fputs("the caller's state has changed\n", stderr);
  if (other != usual) std::fputs("the answers differ\n", stderr);
  std::exit(stays && other == usual && !usual.empty() ? 0 : 1);
}

TEST_P(FloatingPointEnvironment, DoesNotMatterAndStays) {
  const auto& [answers, state] = GetParam();
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the program anew, not a copy of this process
  EXPECT_EXIT(ask_twice(answers, state), testing::ExitedWithCode(0), "");
}

INSTANTIATE_TEST_SUITE_P(Of, FloatingPointEnvironment,
                         testing::Combine(testing::ValuesIn(all_answers()),
                                          testing::ValuesIn(states())),
                         [](const auto& tested) {
                           return std::get<0>(tested.param).name + "_with_" +
                                  std::get<1>(tested.param).name;
                         });

}  // namespace
}  // namespace touchstone::fast::floating_point_environment_test
