/// \file
/// The table of planted faults in solvers: the fuzzer hunts each, with its time and number of
/// queries. Exit status 1 if a fault that should be found is not, or if a harmless one is.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/faults/hunt.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/fuzz/finding.hpp"

namespace touchstone::tests {
namespace {

std::string outcome(const FaultySolver& solver, const Hunt& hunt) {
  if (hunt.finding) {
    return fmt::format("{} by {}{}", verify::judge::to_string(hunt.finding->what),
                       hunt.finding->generator,
                       solver.fault.harmless.empty() ? "" : " (SHOULD BE HARMLESS)");
  }
  if (!solver.fault.rare.empty()) return "not found (rare)";
  return solver.fault.harmless.empty() ? "NOT FOUND" : "harmless";
}

/// Prints the hunt. True if its result is as it should be.
bool print(const FaultySolver& solver, const Hunt& hunt) {
  fmt::print("{:<30} {:<16} {:>8.2f} {:>10}  {:<46} {}\n", solver.fault.name, solver.of,
             hunt.seconds, hunt.queries, outcome(solver, hunt), solver.fault.what);
  const std::string_view why =
      solver.fault.harmless.empty() ? solver.fault.rare : solver.fault.harmless;
  if (!hunt.finding && !why.empty()) fmt::print("    {}\n", why);
  (void)std::fflush(stdout);
  if (hunt.finding) return solver.fault.harmless.empty();
  return !why.empty();
}

/// Findings as datasets: a folder for each separation, with a file for each shape.
class Corpus {
 public:
  void add(const FaultySolver& solver, const verify::fuzz::Finding& finding) {
    const verify::base::AnyQuery query = simplest(solver, finding);
    const exact::Decision truth = exact::decide(query.queries(), 0, finding.separation);
    auto& queries = queries_[{name_of(finding.separation), name_of(query.shape())}];
    const Labelled labelled{query, truth.collides()};
    if (std::ranges::find(queries, labelled) == queries.end()) queries.push_back(labelled);
    separations_[name_of(finding.separation)] = finding.separation;
    fmt::print("{}", verify::fuzz::as_points(query));
  }

  void write(const std::filesystem::path& folder) const {
    for (const auto& [name, separation] : separations_) {
      std::filesystem::create_directories(folder / name);
      verify::data::write_separation(folder / name, separation);
    }
    for (const auto& [place, queries] : queries_) {
      verify::data::CsvWriter file(folder / place.first / (place.second + ".csv"));
      for (const Labelled& labelled : queries) file.write(labelled.query, labelled.collides);
      file.close();
    }
  }

 private:
  struct Labelled {
    verify::base::AnyQuery query;
    bool collides;

    friend bool operator==(const Labelled&, const Labelled&) = default;
  };

  static std::string name_of(const Separation& separation) {
    if (separation.distance == 0.0) return "contact";
    return std::string(to_string(separation.norm));
  }
  static std::string name_of(const QueryShape& shape) {
    const std::string kind(to_string(shape.kind));
    if (shape.is_straight()) return kind;
    return fmt::format("{}-{}-{}", shape.is_rational ? "rational" : "degree", shape.degree, kind);
  }

  std::map<std::string, Separation> separations_;
  std::map<std::pair<std::string, std::string>, std::vector<Labelled>> queries_;
};

int run(const std::vector<std::string>& names, const HuntOptions& options,
        const std::filesystem::path& folder) {
  std::vector<const FaultySolver*> chosen;
  chosen.reserve(faulty_solvers().size() + names.size());
  for (const std::string& name : names) chosen.push_back(&find_faulty_solver(name));
  if (names.empty()) {
    for (const FaultySolver& solver : faulty_solvers()) chosen.push_back(&solver);
  }
  fmt::print("{:<30} {:<16} {:>8} {:>10}  {:<46} {}\n", "fault", "of", "seconds", "queries",
             "found as", "what");
  std::size_t wrong = 0;
  Corpus corpus;
  for (const FaultySolver* const solver : chosen) {
    const Hunt found = hunt(*solver, options);
    if (!print(*solver, found)) ++wrong;
    if (found.finding && !folder.empty()) corpus.add(*solver, *found.finding);
  }
  if (!folder.empty()) corpus.write(folder);
  fmt::print("{} faults, {} not as they should be\n", chosen.size(), wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace touchstone::tests

int main(int argc, char** argv) {
  touchstone::tests::HuntOptions options;
  std::vector<std::string> names;
  std::filesystem::path folder;
  CLI::App app("Hunts the faults that are planted in solvers: tests/faults/faults.txt");
  app.footer("Example: fault_hunt --seconds 10 filter_10 axis_of_start");
  app.add_option("NAME", names, "faults; without a name all that this build plants");
  app.add_option("--seconds", options.seconds, "for each fault (60)")->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "of the fuzzer (1)");
  app.add_option("--corpus", folder, "write the findings, as simple as they get, as datasets here");
  CLI11_PARSE(app, argc, argv);
  try {
    return touchstone::tests::run(names, options, folder);
  } catch (const std::exception& error) {
    fmt::print(stderr, "fault_hunt: {}\n", error.what());
    return 2;
  }
}
