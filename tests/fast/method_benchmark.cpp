/// \file
/// Time per query of each solver, beside one pass that only reads the queries: the physical limit.
///
/// Sets: the handcrafted and the simulation part of TOUCHSTONE_DATA (by default ../shared/datasets
/// beside the project), each kind by itself, and each .npy file named in TOUCHSTONE_BENCH (names
/// separated by colons). The pass is timed before each repetition, so that both are of one moment;
/// `passes` is the time of the solver as a multiple of it.

#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/public_data.hpp"
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
  while (const auto query = source->next()) set.queries.push_back(query->query);
}

std::string variable(const char* name, const std::string& otherwise) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? otherwise : value;
}

QuerySets read_sets() {
  QuerySets sets;
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
    const double time = seconds([&] { method.solve(set.kind, set.queries, answers, {}); });
    state.SetIterationTime(time);
    solve += time;
  }
  const auto solved =
      static_cast<double>(state.iterations()) * static_cast<double>(set.queries.size());
  state.counters["us/query"] = 1e6 * solve / solved;
  state.counters["passes"] = solve / pass;
}

void register_benchmarks(const QuerySets& sets) {
  for (const auto& [name, set] : sets) {
    for (const auto& method : solvers::methods()) {
      const QuerySet& queries = set;
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
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
