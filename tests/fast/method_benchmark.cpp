/// \file
/// Time per query of the oracle by kind and class of random queries. (`touchstone bench` times the
/// solvers, beside a pass that only reads the queries.)
///
/// curved/…: the certified solver on curves, beside that on the lines between their ends: `lines`
/// is the ratio of both. The queries are random; the primitives' places differ by up to 2 on each
/// axis, and all points move by up to 1/2, on the way by 0.2 more (far), or the places by up to 0.7
/// (near).

#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone {
namespace {

/// Draws a query that may belong to a class.
using Draw = Query (*)(tests::Random&, ContactKind);

Query generic(tests::Random& random, ContactKind /*kind*/) {
  return tests::full_significand_query(random);
}

Query coplanar(tests::Random& random, ContactKind kind) {
  Query query = generic(random, kind);
  tests::flatten(query, 2);
  return query;
}

/// Random queries, of this verdict if there is one.
std::vector<Query> random_queries(ContactKind kind, Draw draw, std::optional<bool> collides) {
  tests::Random random(5);
  std::vector<Query> queries;
  while (queries.size() < 256) {
    const Query query = draw(random, kind);
    if (collides && exact::decide(kind, query).collides() != *collides) continue;
    queries.push_back(query);
  }
  return queries;
}

/// One query in each iteration.
void register_oracle(const std::string& name, Draw draw, std::optional<bool> collides) {
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    benchmark::RegisterBenchmark(
        ("oracle/" + name + "/" + std::string(to_string(kind))).c_str(),
        [kind, queries = random_queries(kind, draw, collides)](benchmark::State& state) {
          std::size_t next = 0;
          for (auto iteration : state) {
            static_cast<void>(iteration);
            benchmark::DoNotOptimize(exact::decide(kind, queries[next]));
            next = (next + 1) % queries.size();
          }
        });
  }
}

// ---- Curves -------------------------------------------------------------------------------------

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct CurvedSet {
  ContactKind kind;
  std::size_t degree;
  bool is_rational;
  std::vector<double> numbers;
  std::vector<Query> lines;

  [[nodiscard]] Queries queries() const { return {{kind, degree, is_rational}, numbers}; }
};

CurvedSet random_curves(ContactKind kind, std::size_t degree, bool is_rational, double reach) {
  constexpr int count = 20'000;
  CurvedSet set{kind, degree, is_rational, {}, {}};
  tests::Random random(5);
  const std::size_t second = kind == ContactKind::vertex_face ? 1 : 2;
  for (int i = 0; i < count; ++i) {
    Query& line = set.lines.emplace_back();
    std::array<double, 3> place{};
    for (double& x : place) x = random.uniform(-reach, reach);
    for (std::size_t point = 0; point < moving_points; ++point) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = random.uniform(-1, 1) + (point >= second ? place.at(axis) : 0.0);
        line.at(0, point, axis) = x;
        line.at(1, point, axis) = x + random.uniform(-0.5, 0.5);
      }
    }
    for (std::size_t k = 0; k <= degree; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(degree);
      const bool is_end = k == 0 || k == degree;
      const std::array weights{is_end ? 1.0 : random.uniform(0.9, 1.1),
                               is_end ? 1.0 : random.uniform(0.9, 1.1)};
      for (std::size_t point = 0; point < moving_points; ++point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          set.numbers.push_back(line.at(0, point, axis) * (1 - t) + line.at(1, point, axis) * t +
                                (is_end ? 0.0 : random.uniform(-0.2, 0.2)));
        }
        if (is_rational) set.numbers.push_back(weights.at(std::size_t{point >= second}));
      }
    }
  }
  return set;
}

void time_curves(benchmark::State& state, const CurvedSet& set) {
  std::vector<fast::CertifiedResult> results(set.lines.size());
  const fast::CertifiedOptions options{.max_threads = 1};
  double of_lines = 0.0, of_curves = 0.0;
  for (auto iteration : state) {
    static_cast<void>(iteration);
    of_lines += seconds([&] { fast::solve({set.kind, set.lines}, results, options); });
    const double time = seconds([&] { fast::solve(set.queries(), results, options); });
    state.SetIterationTime(time);
    of_curves += time;
  }
  const auto solved =
      static_cast<double>(state.iterations()) * static_cast<double>(set.lines.size());
  state.counters["ns/query"] = 1e9 * of_curves / solved;
  state.counters["lines"] = of_curves / of_lines;
}

void register_curves() {
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    for (const auto& [form, degree] :
         {std::pair("degree 2", 2U), {"degree 3", 3U}, {"rational", 2U}}) {
      for (const auto& [where, reach] : {std::pair("far", 2.0), {"near", 0.7}}) {
        const bool is_rational = std::string_view(form) == "rational";
        benchmark::RegisterBenchmark(
            ("curved/" + std::string(form) + "/" + where + "/" + std::string(to_string(kind)))
                .c_str(),
            [set = random_curves(kind, degree, is_rational, reach)](benchmark::State& state) {
              time_curves(state, set);
            })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
}

}  // namespace
}  // namespace touchstone

int main(int argc, char** argv) {
  using namespace touchstone;
  benchmark::Initialize(&argc, argv);
  register_oracle("miss", generic, false);
  register_oracle("hit", generic, true);
  register_oracle("coplanar", coplanar, std::nullopt);
  register_oracle("near-miss", tests::near_contact_query, false);
  register_curves();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
