#include "verify/solvers/plugin_method.hpp"
#include "tests/support/built_files.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/trials.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "tests/verify/solvers/plugins/misbehaviour.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify::solvers::plugin_method_test {
namespace {

using data::test::error_of;
using data::test::TemporaryFolder;
using fast::Answer;
using fast::Verdict;
using tests::Misbehaviour;
using tests::PosedQuery;

const std::filesystem::path box_overlap = tests::plugin_library("box_overlap");
const std::filesystem::path misbehaving = tests::plugin_library("misbehaving");

Query query_for(Misbehaviour what) {
  Query query{};
  query.coordinates[0] = static_cast<double>(what);
  return query;
}

Answer ask(const fast::Method& method, const AnyQueries& one,
           const fast::MethodOptions& options = {}) {
  Answer answer{.verdict = Verdict::no, .toi_lower = 7.0, .toi_upper = 7.0, .tolerance = 7.0};
  method.solve(one, {&answer, 1}, options);
  return answer;
}

Answer ask(const fast::Method& method, AnyKind kind, const Query& query,
           const fast::MethodOptions& options = {}) {
  return ask(method, AnyQueries(kind, {&query, 1}), options);
}

Answer ask(const fast::Method& method, const PosedQuery& posed,
           const fast::MethodOptions& options = {}) {
  return ask(method, posed.kind, posed.query, options);
}

std::string load_error(const std::filesystem::path& path) {
  return error_of(path.parent_path(), [&] { static_cast<void>(load_plugin(path)); });
}

/// A change of the working directory until the end of this object.
class WorkingDirectory {
 public:
  explicit WorkingDirectory(const std::filesystem::path& path)
      : before_(std::filesystem::current_path()) {
    std::filesystem::current_path(path);
  }
  WorkingDirectory(const WorkingDirectory&) = delete;
  WorkingDirectory& operator=(const WorkingDirectory&) = delete;
  WorkingDirectory(WorkingDirectory&&) = delete;
  WorkingDirectory& operator=(WorkingDirectory&&) = delete;
  ~WorkingDirectory() { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_;
};

// ---- Promises -----------------------------------------------------------------------------------

TEST(PluginPromise, IncludesCurvesIfItHasAFunctionForThemAndTakesDoubles) {
  const PluginOptions takes_float{.terms = {.float_coordinates = true}};
  for (const auto& [name, options, answers_curves] :
       {std::tuple("misbehaving", PluginOptions{}, true),
        std::tuple("curved_sampling", PluginOptions{}, true),
        std::tuple("always_no", PluginOptions{}, false),
        std::tuple("misbehaving", takes_float, false)}) {
    const auto method = load_plugin(tests::plugin_library(name), options);
    const fast::Terms& terms = method->info().terms;
    for (std::size_t degree = 0; degree <= greatest_degree; ++degree) {
      for (const bool is_rational : {false, true}) {
        const AnyShape shape{ContactKind::edge_edge, degree, is_rational};
        EXPECT_EQ(terms.answers(shape), shape.is_straight() || (answers_curves && degree > 0))
            << name << ' ' << degree << ' ' << is_rational;
      }
    }
  }
}

// ---- Loading ------------------------------------------------------------------------------------

TEST(LoadPlugin, TakesABareNameAsAFileInTheWorkingDirectory) {
  const WorkingDirectory there(box_overlap.parent_path());
  EXPECT_EQ(load_plugin(box_overlap.filename())->name(), "box_overlap");
}

TEST(LoadPlugin, NamesFileAndReason) {
  const TemporaryFolder folder;
  const auto library = [](const char* name) { return tests::plugin_library(name); };
  const std::string no_file =
      "cannot load: cannot open shared object file: No such file or directory";
  const std::vector<std::pair<std::filesystem::path, std::string>> reasons{
      {folder.path() / "missing.so", no_file},
      {folder.file("text.so", std::string(4096, 'x')), "cannot load: invalid ELF header"},
      {library("other_library"), "defines no touchstone_plugin_version"},
      {library("wrong_version"),
       "made for version 43 of the plugin interface, this program has version 2"},
      {library("without_solve"), "defines no touchstone_plugin_solve"},
      {library("without_name"), "name is not one line of text: \"two?lines\""},
      {library("states_nonsense"),
       "touchstone_plugin_promise() sets kinds or elements out of range; "
       "touchstone/plugin.h names the values"}};
  for (const auto& [path, reason] : reasons) {
    EXPECT_EQ(load_error(path), path.filename().string() + ": " + reason);
  }
  // It is not searched for.
  const WorkingDirectory there(folder.path());
  EXPECT_EQ(load_error("libc.so.6"), "libc.so.6: " + no_file);
}

TEST(LoadPlugin, IsOfTheFileThatWasThere) {
  const data::test::TemporaryFolder folder;
  const std::filesystem::path library = folder.path() / "mine.so";
  std::filesystem::copy_file(tests::plugin_library("always_no"), library);
  const auto method = load_plugin(library);
  std::filesystem::copy_file(tests::plugin_library("always_yes"), folder.path() / "new.so");
  std::filesystem::rename(folder.path() / "new.so", library);
  EXPECT_EQ(
      data::test::error_of(folder.path(),
                           [&] { static_cast<void>(ask(*method, ContactKind::edge_edge, {})); }),
      "mine.so: has changed since it was loaded first");
}

/// Each would end this process, or never return.
TEST(LoadPlugin, SurvivesWhatALibraryDoesOnTheWay) {
  const std::filesystem::path path = tests::plugin_library("bad_loading");
  const std::string hang = "hang for 0.5 s; a greater --query-limit allows more";
  const std::vector<std::array<std::string, 3>> table{
      {"constructor exits", "its constructors", "exit: status 0"},
      {"constructor crashes", "its constructors", "crash: SIGSEGV"},
      {"constructor hangs", "its constructors", hang},
      // A child that may not fork reports an error.
      {"constructor forks", "its constructors", "exit: status 11"},
      {"version exits", "touchstone_plugin_version()", "exit: status 0"},
      {"version throws", "touchstone_plugin_version()", "exception: no version"},
      {"name exits", "touchstone_plugin_name()", "exit: status 0"},
      {"name crashes", "touchstone_plugin_name()", "crash: SIGSEGV"},
      {"name hangs", "touchstone_plugin_name()", hang},
      {"promise throws", "touchstone_plugin_promise()", "exception: no promise"},
      {"promise hangs", "touchstone_plugin_promise()", hang}};
  for (const auto& [event, function, end] : table) {
    ::setenv("TOUCHSTONE_TEST_LOADING", event.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    const double limit = event.ends_with("hangs") ? 0.5 : 600.0;
    EXPECT_EQ(error_of(path.parent_path(),
                       [&] { static_cast<void>(load_plugin(path, {.load_seconds = limit})); }),
              "bad_loading.so: cannot load: " + function + ": " + end);
    ::unsetenv("TOUCHSTONE_TEST_LOADING");  // NOLINT(concurrency-mt-unsafe)
  }
  EXPECT_EQ(load_plugin(path)->name(), "bad_loading");
}

/// No code of the library runs in this process before a call solves here.
TEST(LoadPlugin, LoadsNothingIntoThisProcess) {
  const auto is_loaded = [] {
    void* const handle =
        ::dlopen(tests::plugin_library("box_overlap").c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (handle != nullptr) ::dlclose(handle);
    return handle != nullptr;
  };
  const auto method = load_plugin(box_overlap);
  EXPECT_FALSE(is_loaded());
  EXPECT_EQ(ask(*method, tests::over_triangle(1, 1, 1, -2)).verdict, Verdict::yes);
  EXPECT_TRUE(is_loaded());
}

TEST(LoadPlugin, RefusesNamesThatMislead) {
  const std::filesystem::path path = tests::plugin_library("latin_name");
  const auto set_name = [](const std::string& name) {
    ::setenv("TOUCHSTONE_PLUGIN_NAME", name.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  };
  const std::string unprintable = "is not one line of text: ",
                    ours = "is that of a built-in solver: ";
  const std::vector<std::array<std::string, 2>> refused{
      {"two\u2028lines", unprintable},
      {"caf\xe9", unprintable},
      {"\x1b[31m", unprintable},
      {"", unprintable},
      {"certified", ours},
      {"tight_inclusion", ours},
      {std::string(101, 'x'), "has more than 100 bytes"},
      {std::string(100'000, 'x'), "has more than 100 bytes"}};
  for (const auto& [name, reason] : refused) {
    set_name(name);
    EXPECT_TRUE(load_error(path).starts_with("latin_name.so: name " + reason)) << load_error(path);
  }
  for (const std::string& name : {std::string("café"), std::string("δ-solver (v2)"),
                                  std::string("法"), std::string(100, 'x')}) {
    set_name(name);
    EXPECT_EQ(load_plugin(path)->name(), name);
  }
  ::unsetenv("TOUCHSTONE_PLUGIN_NAME");  // NOLINT(concurrency-mt-unsafe)
}

// ---- Answers ------------------------------------------------------------------------------------

TEST(Plugin, GetsTheQueryAndItsKind) {
  const auto method = load_plugin(misbehaving);
  Query query = query_for(Misbehaviour::repeats_query);
  query.coordinates[1] = 0.125;
  query.coordinates[23] = 0.75;
  for (const AnyKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    const Answer answer = ask(*method, kind, query);
    EXPECT_EQ(answer.verdict, Verdict::yes);
    EXPECT_EQ(answer.toi_lower, 0.125);
    EXPECT_EQ(answer.toi_upper, 0.75);
    EXPECT_EQ(answer.tolerance, kind == ContactKind::vertex_face ? 0.0 : 1.0);
  }
}

/// The plugin tells of curves by their shape and kind.
TEST(Plugin, GetsCurvesByTheirOwnFunction) {
  const auto method = load_plugin(misbehaving);
  for (const AnyShape& shape : {AnyShape{ContactKind::vertex_face, 1, true},
                                {ContactKind::edge_edge, 2},
                                {ContactKind::edge_edge, 8, true}}) {
    std::vector<double> numbers(shape.numbers_of_query());
    numbers.front() = static_cast<double>(Misbehaviour::repeats_query);
    numbers.back() = 0.75;
    const Answer answer = ask(*method, AnyQueries(shape, numbers));
    EXPECT_EQ(answer.verdict, Verdict::yes);
    EXPECT_EQ(answer.toi_lower, static_cast<double>(shape.kind.number()) +
                                    10.0 * static_cast<double>(shape.degree) +
                                    (shape.is_rational ? 100.0 : 0.0));
    EXPECT_EQ(answer.toi_upper, 0.75);
  }
}

/// Contact at 1/2 is seen at one of the times that it looks at, 1/8 apart.
TEST(Plugin, GetsLinesAsCurvesOfDegreeOneIfItHasNoOtherFunction) {
  const auto method = load_plugin(tests::plugin_library("curved_sampling"));
  const Answer answer = ask(*method, tests::over_triangle(1, 1, 1, -1));
  EXPECT_EQ(answer.verdict, Verdict::yes);
  EXPECT_EQ(answer.toi_lower, 0.375);
  EXPECT_EQ(ask(*method, tests::over_triangle(1, 1, 2, 1)).verdict, Verdict::no);
}

TEST(Plugin, GetsTheOptions) {
  const auto method = load_plugin(misbehaving);
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    const Separation separation{.distance = 0.25, .norm = norm};
    EXPECT_EQ(ask(*method, ContactKind::vertex_face, query_for(Misbehaviour::repeats_norm),
                  {.separation = separation})
                  .toi_lower,
              norm == Norm::l2 ? 1.0 : 0.0);
  }
  const Answer answer =
      ask(*method, ContactKind::vertex_face, query_for(Misbehaviour::repeats_options),
          {.tolerance = 0.0625,
           .max_checks = 77,
           .separation = {.distance = 0.25, .norm = Norm::linf},
           .t_max = 0.5});
  EXPECT_EQ(answer.verdict, Verdict::yes);
  EXPECT_EQ(answer.toi_lower, 0.0625);
  EXPECT_EQ(answer.toi_upper, 0.25);
  EXPECT_EQ(answer.tolerance, 0.5);
}

TEST(Plugin, MayBeOfTheVersionBeforeTheNorm) {
  const auto method = load_plugin(tests::plugin_library("old_version"));
  EXPECT_EQ(method->name(), "old_version");
  const Answer answer = ask(*method, ContactKind::vertex_face, {},
                            {.separation = {.distance = 0.25, .norm = Norm::l2}, .t_max = 0.5});
  EXPECT_EQ(answer.toi_lower, 0.25);
  EXPECT_EQ(answer.toi_upper, 0.5);
}

// ---- Events -------------------------------------------------------------------------------------

/// What a plugin does at a query, and what becomes of it.
struct Event {
  Misbehaviour what;
  Answer answer = {};
  std::string failure = {};
  bool may_fork = false;
};

constexpr double none = Answer::none, infinity = std::numeric_limits<double>::infinity();

const std::vector<Event>& events() {
  using enum tests::Misbehaviour;
  static const Answer no{.verdict = Verdict::no}, error{.verdict = Verdict::error},
      undecided{.verdict = Verdict::undecided};
  const auto yes = [](double toi_lower, double toi_upper, double tolerance) -> Answer {
    return {.verdict = Verdict::yes,
            .toi_lower = toi_lower,
            .toi_upper = toi_upper,
            .tolerance = tolerance};
  };
  static const std::vector<Event> all{
      {says_no, no},
      {says_no_with_toi, {.verdict = Verdict::no, .tolerance = 1e-9}},
      {is_undecided, undecided, "undecided"},
      {verdict_too_large, error, "no_verdict"},
      {verdict_negative, error, "no_verdict"},
      {leaves_answer_alone, error, "no_verdict"},
      {infinite_toi_lower, yes(-infinity, 0.5, 1e-9), "not_finite: toi_lower -inf"},
      {infinite_toi_upper, yes(0.25, infinity, 1e-9), "not_finite: toi_upper inf"},
      {yes_without_toi, {.verdict = Verdict::yes}},
      {negative_tolerance, yes(0.25, 0.5, none)},
      {nan_tolerance, yes(0.25, 0.5, none)},
      {infinite_tolerance, yes(0.25, 0.5, infinity)},
      {throws, error, "exception: thrown by a plugin"},
      {throws_a_number, error, "exception: not a std::exception"},
      {exits_with_3, error, "exit: status 3"},
      {exits_at_once, error, "exit: status 0"},
      {kills_itself, error, "crash: SIGKILL"},
      {aborts, error, "crash: SIGABRT"},
      {writes_to_null, error, "crash: SIGSEGV"},
      {writes_without_end, error, "crash: SIGXFSZ"},
      {hangs, undecided, "hang"},
      {sleeps, undecided, "hang"},
      {closes_all, undecided, "hang"},
      {prints, no},
      {writes_a_file, no},
      {allocates, no},
      {forks, error, "exception: fork is refused"},
      {signals_parent, no},
      {forks, no, "", true},
      {copies_itself, no, "", true},
      {signals_parent, no, "", true},
  };
  return all;
}

/// How it is asked.
struct Way {
  const char* library;
  std::size_t degree;
};

class PluginEvents : public ::testing::TestWithParam<Way> {
 protected:
  const bool in_batches = std::string_view(GetParam().library) == "misbehaving_batch";
  const AnyShape shape{.degree = GetParam().degree};

  /// Queries whose first number selects what it does.
  [[nodiscard]] std::vector<double> numbers_of(const std::vector<Misbehaviour>& actions) const {
    std::vector<double> numbers(actions.size() * shape.numbers_of_query());
    for (std::size_t i = 0; i < actions.size(); ++i) {
      numbers[i * shape.numbers_of_query()] = static_cast<double>(actions[i]);
    }
    return numbers;
  }

  /// A batch says how many it was with the tolerance of a no; those of curves are not judged.
  [[nodiscard]] std::string text_of(Answer answer, const std::string& failure) const {
    const bool is_count = in_batches && answer.verdict == Verdict::no;
    if (is_count || !shape.is_straight()) answer.tolerance = none;
    return fmt::format("{} [{}, {}] {} {}", judge::to_string(answer.verdict), answer.toi_lower,
                       answer.toi_upper, answer.tolerance, failure);
  }
};

TEST_P(PluginEvents, CostOneQueryEachAndHaveTheirNames) {
  for (const bool may_fork : {false, true}) {
    // A batch, and one that is solved one by one.
    std::vector<Misbehaviour> actions(512, Misbehaviour::says_no);
    std::vector<std::string> expected(actions.size(), text_of({.verdict = Verdict::no}, ""));
    for (const Event& event : events()) {
      if (event.may_fork != may_fork) continue;
      actions.insert(actions.end(), {event.what, Misbehaviour::says_no});
      expected.push_back(text_of(event.answer, event.failure));
      expected.push_back(expected.front());
    }
    const auto method = load_plugin(tests::plugin_library(GetParam().library));
    const std::vector<double> numbers = numbers_of(actions);
    const AnyQueries queries(shape, numbers);
    std::vector<Answer> answers(queries.size());
    // 2 GiB take longest under the sanitizers.
    constexpr double limit = tests::sanitizer_divisor > 1 ? 2.0 : 0.5;
    SolverProcess process(*method, {.query_limit_seconds = limit,
                                    .limits = {.file_bytes = 1U << 20U, .may_fork = may_fork}});
    const SolverRun run = process.solve(queries, answers, {});
    EXPECT_EQ(run.answered, queries.size());
    EXPECT_EQ(run.unplaced_crashes, 0U);
    double most_at_once = 1.0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const judge::Failure* known = judge::failure_at(run.failures, i);
      const auto shown = judge::failure_of(answers[i]);
      if (known == nullptr && shown) known = &*shown;
      EXPECT_EQ(text_of(answers[i], known == nullptr ? "" : to_text(*known)), expected[i])
          << "action " << static_cast<int>(actions[i]) << ", may fork: " << may_fork;
      if (answers[i].verdict == Verdict::no) {
        most_at_once = std::fmax(most_at_once, answers[i].tolerance);
      }
    }
    EXPECT_EQ(most_at_once > 1.0, in_batches);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PluginEvents,
                         ::testing::Values(Way{"misbehaving", 1}, Way{"misbehaving_batch", 1},
                                           Way{"misbehaving", 2}));

}  // namespace
}  // namespace touchstone::verify::solvers::plugin_method_test
