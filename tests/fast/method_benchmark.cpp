/// \file
/// Time per query of the oracle and of each solver, beside one pass that only reads the queries:
/// the physical limit.
///
/// Sets: random queries by kind and class, the handcrafted and the simulation part of
/// TOUCHSTONE_DATA (by default ../shared/datasets beside the project), each kind by itself, and
/// each .npy file named in TOUCHSTONE_BENCH (names separated by colons). The pass is timed before
/// each repetition, so that both are of one moment; `passes` is the time of the solver as a
/// multiple of it.
///
/// curved/…: the certified solver on curves, beside that on the lines between their ends: `lines`
/// is the ratio of both. The queries are random; the primitives' places differ by up to 2 on each
/// axis, and all points move by up to 1/2, on the way by 0.2 more (far), or the places by up to 0.7
/// (near).

#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/dataset.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify {
namespace {

struct QuerySet {
  Kind kind = Kind::vertex_face;
  std::vector<Query> queries;
};

using QuerySets = std::map<std::string, QuerySet>;

void add(QuerySets& sets, const std::string& name, const std::filesystem::path& path) {
  const auto source = data::open_dataset(path);
  QuerySet& set = sets[name + "/" + std::string(to_string(source->kind()))];
  set.kind = source->kind();
  while (const auto query = source->next()) set.queries.push_back(query->query.straight());
}

std::string variable(const char* name, const std::string& otherwise) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? otherwise : value;
}

/// The common property of random queries.
struct QueryClass {
  std::string name;
  /// Draws a query that may belong to the class.
  std::function<Query(tests::Random&, Kind)> draw;
  /// The verdict of the class; if empty, all queries belong to it.
  std::optional<bool> collides;
};

void add_random(QuerySets& sets, const QueryClass& query_class, Kind kind) {
  tests::Random random(5);
  QuerySet& set = sets[query_class.name + "/" + std::string(to_string(kind))];
  set.kind = kind;
  while (set.queries.size() < 256) {
    const Query query = query_class.draw(random, kind);
    const auto& collides = query_class.collides;
    if (collides && exact::decide(kind, query).collides() != *collides) continue;
    set.queries.push_back(query);
  }
}

QuerySets read_sets() {
  QuerySets sets;
  const auto generic = [](tests::Random& random, Kind) {
    return tests::full_significand_query(random);
  };
  const auto coplanar = [](tests::Random& random, Kind) {
    Query query = tests::full_significand_query(random);
    tests::flatten(query, 2);
    return query;
  };
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const QueryClass& one : {QueryClass{"miss", generic, false},
                                  {"hit", generic, true},
                                  {"coplanar", coplanar, std::nullopt},
                                  {"near-miss", tests::near_contact_query, false}}) {
      add_random(sets, one, kind);
    }
  }
  const std::filesystem::path folder = tests::public_data_folder();
  for (const auto& file : tests::public_datasets()) {
    add(sets, file.lexically_relative(folder).begin()->string(), file);
  }
  std::istringstream files(variable("TOUCHSTONE_BENCH", ""));
  for (std::string file; std::getline(files, file, ':');) {
    add(sets, std::filesystem::path(file).stem().string(), file);
  }
  return sets;
}

/// Reads every coordinate once, into eight sums, so that reading is the limit, not addition.
void read_all(const std::vector<Query>& queries) {
  std::array<double, 8> sums{};
  for (const Query& query : queries) {
    for (std::size_t i = 0; i < query.coordinates.size(); ++i) sums[i % 8] += query.coordinates[i];
  }
  benchmark::DoNotOptimize(sums);
}

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void time_method(benchmark::State& state, const fast::Method& method, const QuerySet& set) {
  std::vector<fast::Answer> answers(set.queries.size());
  double pass = 0.0, solve = 0.0;
  for (auto iteration : state) {
    static_cast<void>(iteration);
    pass += seconds([&] { read_all(set.queries); });
    const double time = seconds([&] { method.solve({set.kind, set.queries}, answers, {}); });
    state.SetIterationTime(time);
    solve += time;
  }
  const auto solved =
      static_cast<double>(state.iterations()) * static_cast<double>(set.queries.size());
  state.counters["us/query"] = 1e6 * solve / solved;
  state.counters["passes"] = solve / pass;
}

/// One query in each iteration.
void time_oracle(benchmark::State& state, const QuerySet& set) {
  std::size_t next = 0;
  for (auto iteration : state) {
    static_cast<void>(iteration);
    benchmark::DoNotOptimize(exact::decide(set.kind, set.queries[next]));
    next = (next + 1) % set.queries.size();
  }
}

// ---- Curves -------------------------------------------------------------------------------------

struct CurvedSet {
  Kind kind;
  std::size_t degree;
  bool is_rational;
  std::vector<double> numbers;
  std::vector<Query> lines;

  [[nodiscard]] Queries queries() const { return {{kind, degree, is_rational}, numbers}; }
};

CurvedSet random_curves(Kind kind, std::size_t degree, bool is_rational, double reach) {
  constexpr int count = 20'000;
  CurvedSet set{kind, degree, is_rational, {}, {}};
  tests::Random random(5);
  const std::size_t second = kind == Kind::vertex_face ? 1 : 2;
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
    of_lines += seconds([&] { fast::solve(set.kind, set.lines, results, options); });
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
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
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

void register_benchmarks(const QuerySets& sets) {
  for (const auto& [name, set] : sets) {
    const QuerySet& queries = set;
    benchmark::RegisterBenchmark(("oracle/" + name).c_str(),
                                 [&](benchmark::State& state) { time_oracle(state, queries); });
    for (const auto& method : solvers::methods()) {
      const fast::Method& solver = *method;
      benchmark::RegisterBenchmark(
          (std::string(solver.name()) + "/" + name).c_str(),
          [&](benchmark::State& state) { time_method(state, solver, queries); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace
}  // namespace touchstone::verify

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const auto sets = touchstone::verify::read_sets();
  touchstone::verify::register_benchmarks(sets);
  touchstone::verify::register_curves();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
