// touchstone curved: queries on Bézier curves.

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "verify/cli/certificates_file.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/help.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/solver_options.hpp"
#include "verify/data/curved_query_file.hpp"
#include "verify/data/dataset.hpp"
#include "verify/generate/curved_families.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/certify_curves.hpp"

namespace touchstone::verify::cli::curved_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> paths;
  std::string kind;
  SeparationArguments separation;
  std::uint64_t count = 1000;
  std::uint64_t seed = default_seed;
  bool judges_others = false;
  SolverArguments judged;
  unsigned threads = 0;
  std::string proof_file;
  std::string json_file;
};

/// The judgement on a plugin, and the first of its wrong answers.
std::string text_of(const jobs::CurvedPluginResult& plugin) {
  using judge::Fault;
  constexpr std::size_t most_shown = 10;
  const judge::Judgement& judged = plugin.judgement;
  const std::string name = io::printable(plugin.name);
  std::string text = fmt::format(
      "  {}: {} missed, {} false, {} late, {} with an early upper bound, {} failed, {:.3f} µs a "
      "query\n",
      name, judged.count(Fault::false_negative), judged.count(Fault::false_positive),
      judged.count(Fault::late_toi), judged.count(Fault::early_toi_upper), plugin.failed(),
      judged.nanoseconds_per_query() * 1e-3);
  if (const std::uint64_t unasked = judged.outside + judged.left_out; unasked != 0) {
    text += fmt::format("  {}: {} not asked\n", name, unasked);
  }
  std::size_t shown = 0;
  for (const judge::WrongAnswer& wrong : judged.wrong_answers) {
    if (!judge::breaks(wrong.fault, plugin.promise)) continue;
    if (shown++ == most_shown) break;
    text += fmt::format("  query {}: {}\n", wrong.index, judge::to_text(name, wrong));
  }
  return text;
}

nlohmann::json json_of(const jobs::CurvedPluginResult& plugin) {
  using judge::Fault;
  const judge::Judgement& judged = plugin.judgement;
  return {{"method", plugin.name},
          {"false_negatives", judged.count(Fault::false_negative)},
          {"false_positives", judged.count(Fault::false_positive)},
          {"late", judged.count(Fault::late_toi)},
          {"early_toi_upper", judged.count(Fault::early_toi_upper)},
          {"failed", plugin.failed()},
          {"not_asked", judged.outside + judged.left_out},
          {"seconds", judged.nanoseconds * 1e-9},
          {"keeps_promise", !plugin.is_broken()}};
}

class CurvedRun {
 public:
  explicit CurvedRun(const Arguments& arguments)
      : arguments_(arguments),
        json_(files_, arguments.json_file),
        proof_(files_, arguments.proof_file) {
    files_.add_inputs(arguments.paths);
    files_.add_inputs(arguments.judged.plugins);
    load_plugins();
  }

  Status run() {
    for (const fs::path& path : arguments_.paths) {
      if (!io::interrupted()) certify_file(path);
    }
    if (arguments_.paths.empty()) certify_families();
    proof_.close(certificates_);
    if (json_) json_.write(io::json_document({{"sets", results_}}));
    json_.close();
    io::print(files_.summary_stream(), text_);
    if (io::interrupted()) return Status::interrupted;
    if (files_.has_failed() || beyond_limits_ > 0) return Status::bad_input;
    return wrong_ > 0 ? Status::wrong_answers : Status::all_well;
  }

 private:
  /// Queries with what is known of them.
  struct Set {
    std::string name;
    Kind kind;
    CurvedQueries queries;
    std::span<const std::optional<double>> truth = {};
  };

  void load_plugins() {
    const SolverArguments& judged = arguments_.judged;
    for (const fs::path& path : judged.plugins) {
      plugins_.push_back({.plugin = solvers::load_curved_plugin(path, judged.loading()),
                          .options = judged.options,
                          .process = judged.process()});
      if (judged.exact) plugins_.back().plugin.promise = fast::Promise::exact;
    }
  }

  void certify_file(const fs::path& path) {
    const data::CurvedQueryFile file = data::read_curved_queries(path);
    const Kind kind =
        arguments_.kind.empty() ? data::kind_from_path(path) : kind_from_string(arguments_.kind);
    certify({io::printable(path.string()), kind, file.queries()});
  }

  void certify_families() {
    const bool is_known = is_zero(arguments_.separation.given());
    for (const std::size_t degree : {std::size_t{2}, std::size_t{3}}) {
      for (const generate::CurvedFamily& family :
           generate::curved_families(degree, arguments_.count, arguments_.seed)) {
        if (io::interrupted()) return;
        if (!arguments_.kind.empty() && kind_from_string(arguments_.kind) != family.kind) continue;
        Set set{std::string(family.name), family.kind, family.queries()};
        if (is_known) set.truth = family.toi;
        certify(set);
      }
    }
  }

  void certify(const Set& set) {
    io::ProgressBar bar("curved");
    jobs::CurvedOptions options{.separation = arguments_.separation.given(),
                                .threads = arguments_.threads,
                                .truth = set.truth,
                                .judge_others = arguments_.judges_others,
                                .plugins = plugins_,
                                .prove = static_cast<bool>(proof_),
                                .label = set.name + ' '};
    options.on_progress = [&](double done) { bar.update(done); };
    options.on_certificates = [&](const std::string& text) { proof_.write(text); };
    options.stop = &io::interrupted();
    const jobs::CurvedResult result = jobs::certify_curves(set.kind, set.queries, options);
    bar.clear();
    certificates_ += result.certificates;
    beyond_limits_ += result.beyond_limits;
    wrong_ += result.wrong.size() + result.against_truth.size();
    for (const jobs::CurvedPluginResult& plugin : result.plugins) {
      if (plugin.is_broken()) ++wrong_;
      report_output(plugin.name, plugin.output, arguments_.judged.show_output);
    }
    add_text(set, result);
    add_json(set, result);
  }

  void add_text(const Set& set, const jobs::CurvedResult& result) {
    text_ +=
        fmt::format("{}: {}, {} of degree {}: {} queries, {} collide\n", set.name,
                    to_string(set.kind), set.queries.is_rational ? "rational curves" : "curves",
                    set.queries.degree, result.queries, result.collide);
    const auto queries = static_cast<double>(result.queries == 0 ? 1 : result.queries);
    text_ += fmt::format("  certified: {} wrong, {:.3f} µs a query (oracle {:.1f}); decided by",
                         result.wrong.size(), result.certified_seconds / queries * 1e6,
                         result.oracle_seconds / queries * 1e6);
    for (std::size_t i = 0; i < result.decided_by.size(); ++i) {
      text_ += fmt::format("{} {} {}", i == 0 ? "" : ",", to_string(static_cast<fast::Stage>(i)),
                           result.decided_by[i]);
    }
    text_ += '\n';
    for (const std::size_t i : result.wrong) text_ += fmt::format("  wrong: query {}\n", i);
    for (const std::size_t i : result.against_truth) {
      text_ += fmt::format("  the oracle contradicts the known truth: query {}\n", i);
    }
    for (const jobs::CurvedJudgement& other : result.others) {
      text_ += fmt::format("  {}: {} missed, {} false, {} late, {:.3f} µs a query\n", other.name,
                           other.false_negatives, other.false_positives, other.late,
                           other.seconds / queries * 1e6);
    }
    for (const jobs::CurvedPluginResult& plugin : result.plugins) text_ += text_of(plugin);
    if (result.beyond_limits > 0) {
      text_ += fmt::format("  {} proofs exceed the limits of the format\n", result.beyond_limits);
    }
  }

  void add_json(const Set& set, const jobs::CurvedResult& result) {
    nlohmann::json stages;
    for (std::size_t i = 0; i < result.decided_by.size(); ++i) {
      stages[std::string(to_string(static_cast<fast::Stage>(i)))] = result.decided_by[i];
    }
    nlohmann::json times = nlohmann::json::array();
    for (const double toi : result.toi) {
      times.push_back(std::isnan(toi) ? nlohmann::json() : nlohmann::json(toi));
    }
    nlohmann::json others = nlohmann::json::array();
    for (const jobs::CurvedJudgement& other : result.others) {
      others.push_back({{"method", other.name},
                        {"false_negatives", other.false_negatives},
                        {"false_positives", other.false_positives},
                        {"late", other.late},
                        {"seconds", other.seconds}});
    }
    for (const jobs::CurvedPluginResult& plugin : result.plugins) others.push_back(json_of(plugin));
    results_.push_back({{"name", set.name},
                        {"kind", to_string(set.kind)},
                        {"degree", set.queries.degree},
                        {"rational", set.queries.is_rational},
                        {"others", others},
                        {"against_truth", result.against_truth},
                        {"queries", result.queries},
                        {"collide", result.collide},
                        {"wrong", result.wrong},
                        {"decided_by", stages},
                        {"certificates", result.certificates},
                        {"beyond_limits", result.beyond_limits},
                        {"oracle_seconds", result.oracle_seconds},
                        {"certified_seconds", result.certified_seconds},
                        {"toi", times}});
  }

  const Arguments& arguments_;
  std::vector<jobs::JudgedPlugin> plugins_;
  Files files_;
  Output json_;
  CertificatesFile proof_;
  nlohmann::json results_ = nlohmann::json::array();
  std::string text_;
  std::size_t certificates_ = 0;
  std::size_t beyond_limits_ = 0;
  std::size_t wrong_ = 0;
};

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "curved", "Decide queries on Bézier curves exactly, and judge the certified solver");
  command->option_defaults()->group("Input");
  command
      ->add_option(
          "FILES", arguments->paths,
          "Files .npy of shape (N, K+1, 4, 3 or 4), or .csv; default: families of known truth")
      ->type_name("");
  command->add_option("--count", arguments->count, "Queries of each family and kind")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(1, 1'000'000));
  add_seed_option(*command, arguments->seed, "Seed of the families");
  command->add_flag("--others", arguments->judges_others,
                    "Judge also tight_inclusion, subdivision, sampling and advancement");
  add_kind_option(*command, arguments->kind, "vertex-face or edge-edge, if the path does not tell");
  add_separation_options(*command, arguments->separation);
  command->add_option("--threads", arguments->threads, "Cores to use (0: all)")
      ->type_name("N")
      ->capture_default_str();
  command->option_defaults()->group("Solver");
  add_plugin_option(*command, arguments->judged);
  add_solver_limits(*command, arguments->judged);
  add_exact_flag(*command, arguments->judged);
  command->option_defaults()->group("Output");
  command
      ->add_option("--proof", arguments->proof_file,
                   "Write certificates for touchstone-check; compressed if it ends in .zst")
      ->type_name("FILE");
  add_json_option(*command, arguments->json_file);
  set_help(*command,
           "touchstone curved --others --plugin mine.so\n"
           "touchstone curved curves.csv --kind edge-edge --proof curves.cert",
           "A row of an array has the control points of a query from t=0 to t=1, each of the four "
           "points, with weights last if the curves are rational. A file of CSV begins with "
           "degree,K or rational,K.\n"
           "Exit status: 0 success, 1 an answer of ours is wrong or a plugin breaks its promise, "
           "2 bad input or usage, 130 interrupted.");
  command->callback([arguments, command, &status] {
    settle_solver_options(*command, false, arguments->judged);
    status = CurvedRun(*arguments).run();
  });
}

}  // namespace touchstone::verify::cli::curved_command
