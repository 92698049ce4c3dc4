#include "verify/cli/curved_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "verify/cli/certificates_file.hpp"
#include "verify/cli/files.hpp"
#include "verify/data/curved_query_file.hpp"
#include "verify/data/dataset.hpp"
#include "verify/generate/curved_families.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/certify_curves.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/report/certify_report.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/curved_answers.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

Kind kind_of(const fs::path& path, const std::string& named) {
  return named.empty() ? data::kind_from_path(path) : kind_from_string(named);
}

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
  explicit CurvedRun(const CurvedArguments& arguments)
      : arguments_(arguments),
        json_(files_, arguments.json_file),
        truth_(files_, arguments.truth_file),
        proof_(files_, arguments.proof_file) {
    files_.add_inputs(arguments.paths);
    files_.add_inputs(arguments.judged.plugins);
    load_plugins();
    if (truth_) truth_.write(report::truth_header());
  }

  Status run() {
    for (const fs::path& path : arguments_.paths) {
      if (!io::interrupted()) certify_file(path);
    }
    if (arguments_.paths.empty()) certify_families();
    truth_.close();
    proof_.close(certificates_);
    if (json_) json_.write(io::json_document({{"sets", results_}}));
    json_.close();
    io::print(files_.summary_stream(), text_);
    if (io::interrupted()) return Status::interrupted;
    if (files_.has_failed() || beyond_limits_ > 0) return Status::bad_input;
    Status status = wrong_ > 0 ? Status::wrong_answers : Status::all_well;
    for (const auto& [name, responses] : responses_) {
      status = worse(status, status_of(name, responses));
    }
    return status;
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
    certify({io::printable(path.string()), kind_of(path, arguments_.kind), file.queries()});
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
    if (truth_) {
      options.on_truth = [&](std::size_t i, const exact::Decision& decision) {
        truth_.write(report::truth_row(set.name, set.kind, judge::truth_of(i, decision)));
      };
    }
    options.on_certificates = [&](const std::string& text) { proof_.write(text); };
    options.stop = &io::interrupted();
    const jobs::CurvedResult result = jobs::certify_curves(set.kind, set.queries, options);
    bar.clear();
    certificates_ += result.certificates;
    beyond_limits_ += result.beyond_limits;
    wrong_ += result.wrong.size() + result.against_truth.size();
    for (const jobs::CurvedPluginResult& plugin : result.plugins) {
      if (plugin.is_broken()) ++wrong_;
      responses_[plugin.name] += Responses::of(plugin.judgement);
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

  const CurvedArguments& arguments_;
  std::vector<jobs::JudgedPlugin> plugins_;
  Files files_;
  Output json_;
  Output truth_;
  CertificatesFile proof_;
  nlohmann::json results_ = nlohmann::json::array();
  std::string text_;
  std::size_t certificates_ = 0;
  std::size_t beyond_limits_ = 0;
  std::size_t wrong_ = 0;
  std::map<std::string, Responses> responses_;  ///< of the plugins
};

}  // namespace

Status run_curves(const CurvedArguments& arguments) { return CurvedRun(arguments).run(); }

Status solve_curves(const CurvedArguments& arguments, std::string_view method,
                    const fast::MethodOptions& options, const std::string& out_file) {
  fast::MethodOptions with_separation = options;
  with_separation.separation = arguments.separation.given();
  Files files;
  Output out(files, out_file), json(files, arguments.json_file);
  files.add_inputs(arguments.paths);
  out.write(solvers::answers_header());
  std::uint64_t queries = 0, yes = 0, no = 0;
  for (const fs::path& path : arguments.paths) {
    if (io::interrupted()) break;
    const data::CurvedQueryFile file = data::read_curved_queries(path);
    const Kind kind = kind_of(path, arguments.kind);
    const auto answers =
        solvers::curved_answers(method, kind, file.queries(), with_separation, arguments.threads);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      out.write(solvers::answer_row(path.string(), i, kind, answers[i]));
      yes += answers[i].verdict == fast::Verdict::yes ? 1U : 0U;
      no += answers[i].verdict == fast::Verdict::no ? 1U : 0U;
    }
    queries += answers.size();
  }
  out.close();
  if (json) {
    json.write(
        io::json_document({{"method", method}, {"queries", queries}, {"yes", yes}, {"no", no}}));
  }
  json.close();
  io::print(files.summary_stream(),
            fmt::format("{}: {} queries on curves, {} yes, {} no\n", method, queries, yes, no));
  if (io::interrupted()) return Status::interrupted;
  return files.has_failed() ? Status::bad_input : Status::all_well;
}

bool have_curves(const SourceArguments& sources) {
  const auto curved = std::ranges::find_if(sources.paths, data::is_curved_query_file);
  if (curved == sources.paths.end()) return false;
  if (!std::ranges::all_of(sources.paths, data::is_curved_query_file)) {
    throw std::invalid_argument(curved->string() +
                                " has queries on curves; name the other files in another run");
  }
  return true;
}

void refuse_for_curves(const CLI::App& command, const std::vector<std::string>& options) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::ranges::count(options, name) != 0) continue;
    std::string message =
        fmt::format("{} does not take {} with queries on curves", command.get_name(), name);
    const CLI::App* const curved = command.get_parent()->get_subcommand("curved");
    if (const CLI::Option* const same = curved->get_option_no_throw(name)) {
      const std::string value = same->get_type_name();
      message += fmt::format("; touchstone curved FILE {}{}{} does", name, value.empty() ? "" : " ",
                             value);
    }
    throw std::invalid_argument(message);
  }
}

CurvedArguments curved_arguments(const CLI::App& command, const SourceArguments& sources,
                                 std::vector<std::string> options) {
  for (const char* name : {"PATH", "--kind", "--threads", "--min-separation", "--norm"}) {
    options.emplace_back(name);
  }
  refuse_for_curves(command, options);
  CurvedArguments result;
  result.paths = sources.paths;
  result.kind = sources.kind;
  result.separation = sources.separation;
  result.threads = sources.threads;
  return result;
}

}  // namespace touchstone::verify::cli
