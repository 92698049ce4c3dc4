/// \file
/// Time of decide() alone, on queries in memory: random ones by kind and class, and the first ones
/// of each dataset file below TOUCHSTONE_DATA (by default ../shared/datasets beside the project).

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/public_data.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/dataset.hpp"

namespace touchstone::exact {
namespace {

constexpr std::size_t queries_per_class = 256;
constexpr std::size_t queries_per_file = 2000;

/// The common property of a benchmark's queries.
struct QueryClass {
  std::string name;
  /// Draws a query that may belong to the class.
  std::function<Query(tests::Random&, Kind)> draw;
  /// The verdict of the class; if empty, all queries belong to it.
  std::optional<bool> collides;
};

std::vector<QueryClass> query_classes() {
  const auto generic = [](tests::Random& random, Kind) {
    return tests::full_significand_query(random);
  };
  const auto coplanar = [](tests::Random& random, Kind) {
    Query query = tests::full_significand_query(random);
    tests::flatten(query, 2);
    return query;
  };
  return {{"miss", generic, false},
          {"hit", generic, true},
          {"coplanar", coplanar, std::nullopt},
          {"near-miss", tests::near_contact_query, false}};
}

std::vector<Query> draw_queries(const QueryClass& query_class, Kind kind) {
  tests::Random random(5);
  std::vector<Query> queries;
  while (queries.size() < queries_per_class) {
    const Query query = query_class.draw(random, kind);
    if (!query_class.collides || decide(kind, query).collides() == *query_class.collides) {
      queries.push_back(query);
    }
  }
  return queries;
}

/// Measures decisions: one query in each iteration.
void decide_in_turn(benchmark::State& state, Kind kind, std::span<const Query> queries) {
  std::size_t next = 0;
  for ([[maybe_unused]] const auto& iteration : state) {
    benchmark::DoNotOptimize(decide(kind, queries[next]));
    if (++next == queries.size()) next = 0;
  }
  state.SetItemsProcessed(state.iterations());
}

void register_benchmark(const std::string& name, Kind kind, std::vector<Query> queries) {
  const std::string full_name = "decide/" + std::string(to_string(kind)) + "/" + name;
  benchmark::RegisterBenchmark(full_name.c_str(),
                               [kind, owned = std::move(queries)](benchmark::State& state) {
                                 decide_in_turn(state, kind, owned);
                               });
}

void register_file(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const auto source = verify::data::open_dataset(file, {.round = true, .keep_going = true});
  std::vector<Query> queries;
  while (queries.size() < queries_per_file) {
    const auto recorded = source->next();
    if (!recorded) break;
    queries.push_back(recorded->query.straight());
  }
  if (!queries.empty()) {
    register_benchmark(file.lexically_relative(folder), source->kind(), std::move(queries));
  }
}

void register_datasets() {
  const std::filesystem::path folder = tests::public_data_folder();
  if (folder.empty()) return;
  for (const auto& file : verify::data::find_datasets({&folder, 1})) register_file(folder, file);
}

}  // namespace
}  // namespace touchstone::exact

int main(int argc, char** argv) {
  for (const auto kind : {touchstone::Kind::vertex_face, touchstone::Kind::edge_edge}) {
    for (const auto& query_class : touchstone::exact::query_classes()) {
      touchstone::exact::register_benchmark(query_class.name, kind,
                                            touchstone::exact::draw_queries(query_class, kind));
    }
  }
  touchstone::exact::register_datasets();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
