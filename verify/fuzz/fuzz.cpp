#include "verify/fuzz/fuzz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "exact/certificate.hpp"
#include "fast/certified.hpp"
#include "verify/decision.hpp"
#include "verify/fuzz/draws.hpp"
#include "verify/fuzz/generators.hpp"
#include "verify/fuzz/referee.hpp"
#include "verify/fuzz/signature.hpp"
#include "verify/fuzz/steering.hpp"
#include "verify/fuzz/symmetry.hpp"
#include "verify/prove.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify {
namespace {

using builtin::Random;
using draws::one_in;
using fast::Answer;
using fast::CertifiedResult;
using fast::Verdict;
using Clock = std::chrono::steady_clock;

constexpr std::string_view judge_name = "certified";

/// Queries of a block before the images: little enough that slow solvers end in time and are
/// steered early.
constexpr std::size_t block_queries = 256;
/// Queries that one draw of the steering stands for.
constexpr std::size_t slice_queries = 16;
/// Queries that are judged together: enough for the kernel, and few enough to end in time.
constexpr std::size_t judged_together = 64;
/// What is answered when the time is over has so long to be judged.
constexpr double seconds_to_judge = 1.0;
/// One in so many queries is asked again as an image.
constexpr std::size_t queries_an_image = 8;
/// A block is cut off behind so many queries that ended the solver's process or took too long.
constexpr std::size_t most_failures = 4;
/// Of a class of findings so many are kept.
constexpr std::uint64_t kept_of_class = 2;

constexpr double oracle_work = 40.0;
/// About the microseconds of a step that a solver says it took, such as a box.
constexpr double check_work = 0.05;

/// What a finding is worth beside a query of a new signature.
constexpr double finding_reward = 50.0;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Far from overflow and underflow: what is made from it is not a query of zeros.
bool is_moderate(const Query& query) {
  return std::ranges::all_of(query.coordinates, [](double x) {
    return x == 0.0 || (std::abs(x) > 0x1p-300 && std::abs(x) < 0x1p300);
  });
}

// ---- A block ------------------------------------------------------------------------------------

/// A query that is an exact image of another one in the block.
struct Image {
  std::size_t origin;
  Symmetry symmetry;
};

/// Queries that are asked together: first those that generators made, then images of some of them.
struct Block {
  Kind kind = Kind::vertex_face;
  std::vector<Query> queries;
  std::vector<std::size_t> arms;  ///< by query: whose it is
  std::vector<Image> images;      ///< the last queries

  [[nodiscard]] std::size_t made() const { return queries.size() - images.size(); }

  /// The image that query i is, or null.
  [[nodiscard]] const Image* image(std::size_t i) const {
    return i < made() ? nullptr : &images[i - made()];
  }

  /// Leaves the first `count` queries.
  void cut(std::size_t count) {
    if (count >= queries.size()) return;
    images.resize(count > made() ? count - made() : 0);
    queries.resize(count);
    arms.resize(count);
  }
};

/// Makes blocks, one kind after the other.
class BlockMaker {
 public:
  BlockMaker(const FuzzOptions& options, const std::vector<Generator>& generators)
      : kinds_(options.kinds),
        generators_(generators),
        context_(options.separation),
        steering_(generators.size(), builtin::mix(options.seed) + 1),
        random_(builtin::mix(options.seed)) {
    for (const CorpusQuery& query : options.corpus) context_.pool(query.kind).keep(query.query);
  }

  [[nodiscard]] Block make() {
    Block block;
    block.kind = kinds_[count_++ % kinds_.size()];
    while (block.queries.size() < block_queries) {
      const std::size_t arm = steering_.choose();
      for (std::size_t i = 0; i < slice_queries; ++i) {
        block.queries.push_back(generators_[arm].make(block.kind, context_, random_));
        block.arms.push_back(arm);
      }
    }
    add_images(block);
    return block;
  }

  /// Notes what a query of the block brought.
  void learn(std::size_t arm, double reward, double work) {
    steering_.learn(arm, reward, generators_[arm].work + work);
  }

  /// Keeps a query as one to mutate.
  void remember(Kind kind, const Query& query) { context_.pool(kind).add(query); }

 private:
  void add_images(Block& block) {
    const std::size_t made = block.queries.size();
    for (std::size_t i = 0; i < made; ++i) {
      if (!one_in(random_, queries_an_image)) continue;
      const Symmetry symmetry =
          draw_symmetry(block.kind, block.queries[i], context_.separation(), random_);
      block.queries.push_back(image(symmetry, block.queries[i]).value_or(block.queries[i]));
      block.arms.push_back(block.arms[i]);
      block.images.push_back({.origin = i, .symmetry = symmetry});
    }
  }

  const std::vector<Kind>& kinds_;
  const std::vector<Generator>& generators_;
  GeneratorContext context_;
  Steering steering_;
  Random random_;
  std::size_t count_ = 0;
};

// ---- Judging ------------------------------------------------------------------------------------

/// Bounds that a method gives with nearly every yes, and then not.
class BoundHabit {
 public:
  /// Is it against all habit that this yes has or lacks the bound?
  [[nodiscard]] bool is_missing(double bound) {
    if (!std::isnan(bound)) {
      ++given_;
      return false;
    }
    ++missing_;
    return given_ >= least_given && missing_ * least_given <= given_;
  }

 private:
  static constexpr std::uint64_t least_given = 200;
  std::uint64_t given_ = 0;
  std::uint64_t missing_ = 0;
};

/// Do two answers to what is the same question contradict each other?
bool contradict(const Answer& a, const Answer& b, bool same_time) {
  const bool both_decided = (a.verdict == Verdict::yes || a.verdict == Verdict::no) &&
                            (b.verdict == Verdict::yes || b.verdict == Verdict::no);
  if (!both_decided) return false;
  if (a.verdict != b.verdict) return true;
  return same_time && (a.toi_lower > b.toi_upper || b.toi_lower > a.toi_upper);
}

/// The certificate of a verdict as text, or nothing where it would be too long.
std::string prove(Kind kind, const Query& query, const Decision& decision,
                  std::string_view generator) {
  std::string text;
  ProofCounts counts;
  append_certificate(kind, query, decision, generator, {}, text, counts);
  return text;
}

/// One run.
class Run {
 public:
  Run(const fast::Method& method, const FuzzOptions& options)
      : options_(options),
        name_(method.name()),
        standard_{.promise = options.promise.value_or(method.promise()),
                  .separation = options.separation,
                  .reach = options.reach},
        oracle_share_(name_ == judge_name ? 1.0 : options.oracle_share),
        generators_(generators(options.separation)),
        maker_(options, generators_),
        solver_(method, process_options(options)),
        method_options_(method_options(options)),
        random_(builtin::mix(options.seed) + 2) {
    for (const Generator& generator : generators_) {
      result_.generators.push_back({.name = std::string(generator.name)});
    }
  }

  static SolverProcessOptions process_options(const FuzzOptions& options) {
    return {.query_limit_seconds = options.query_limit_seconds,
            .most_failures = most_failures,
            .stop = options.stop,
            .limits = options.limits};
  }

  /// What the solver is to be asked with.
  static fast::MethodOptions method_options(const FuzzOptions& options) {
    fast::MethodOptions result = options.method;
    result.min_separation = options.separation.distance;
    result.norm = options.separation.norm;
    return result;
  }

  FuzzResult run() {
    while (!is_over()) run_block();
    result_.interrupted = is_stopped();
    result_.output = solver_.take_output();
    result_.seconds = seconds();
    result_.other_seconds = result_.seconds - result_.method_seconds;
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is_stopped() const {
    return options_.stop != nullptr && options_.stop->load();
  }

  /// Wall-clock time of the run so far, without what was called back.
  [[nodiscard]] double seconds() const { return seconds_since(start_) - called_back_; }

  [[nodiscard]] bool is_over() const {
    return must_end(0.0) ||
           (options_.most_queries != 0 && result_.queries >= options_.most_queries);
  }

  /// Must it end, even in the middle of a block, if it may take so many seconds more than given?
  [[nodiscard]] bool must_end(double more_seconds) const {
    return is_stopped() || has_found_enough() ||
           (options_.seconds > 0.0 && seconds() >= options_.seconds + more_seconds);
  }

  [[nodiscard]] bool has_found_enough() const {
    return options_.most_findings != 0 && result_.findings.size() >= options_.most_findings;
  }

  void run_block() {
    block_ = maker_.make();
    if (options_.most_queries != 0) {
      block_.cut(
          std::min<std::uint64_t>(block_.queries.size(), options_.most_queries - result_.queries));
    }
    answers_.assign(block_.queries.size(), Answer{});
    // A block of a slow method may take minutes.
    constexpr double least = 1e-3;
    const double left =
        options_.seconds > 0.0 ? std::max(least, options_.seconds - seconds()) : 0.0;
    const Clock::time_point asked = Clock::now();
    const SolverRun run =
        solver_.solve(block_.kind, block_.queries, answers_, method_options_, left);
    result_.method_seconds += seconds_since(asked);
    result_.unplaced_crashes += run.unplaced_crashes;
    judge(run);
    if (options_.on_progress) {
      options_.on_progress(
          {.seconds = seconds(), .queries = result_.queries, .findings = result_.all_findings});
    }
  }

  void judge(const SolverRun& run) {
    const std::span<const Query> queries = std::span(block_.queries).first(run.answered);
    judged_.assign(queries.size(), CertifiedResult{});
    failures_ = run.failures;
    // In parts: with a distance and extreme coordinates a query may take a second.
    for (std::size_t first = 0; first < queries.size() && !must_end(seconds_to_judge);
         first += judged_together) {
      const std::size_t count = std::min(judged_together, queries.size() - first);
      fast::solve(block_.kind, queries.subspan(first, count),
                  std::span(judged_).subspan(first, count),
                  {.separation = options_.separation, .max_threads = 1});
      for (std::size_t i = first; i < first + count && !has_found_enough(); ++i) {
        judge_query(i, failure_at(i));
      }
    }
  }

  /// What happened at a query, or null.
  [[nodiscard]] const Failure* failure_at(std::size_t i) const {
    const auto found = std::ranges::lower_bound(failures_, i, {}, &QueryFailure::position);
    return found != failures_.end() && found->position == i ? &found->failure : nullptr;
  }

  void judge_query(std::size_t i, const Failure* failure) {
    GeneratorStatistics& statistics = result_.generators[block_.arms[i]];
    ++result_.queries;
    ++statistics.queries;
    result_.images += block_.image(i) != nullptr ? 1U : 0U;
    if (judged_[i].verdict == Verdict::yes) {
      ++result_.collisions;
      ++statistics.collisions;
    }
    double work = 0.0;
    double reward = 0.0;
    if (failure != nullptr) {
      reward += report_failure(i, *failure);
    } else {
      reward += examine_answer(i, work);
    }
    const std::uint32_t before =
        signatures_.add(signature(block_.kind, block_.queries[i], judged_[i], answers_[i]));
    reward += 1.0 / (1.0 + before);
    if (before == 0) {
      ++statistics.signatures;
      if (is_moderate(block_.queries[i])) maker_.remember(block_.kind, block_.queries[i]);
    }
    work += check_work * static_cast<double>(answers_[i].checks);
    maker_.learn(block_.arms[i], reward, work);
  }

  /// Looks for all that can be wrong with an answer. Returns the reward, and adds the work.
  double examine_answer(std::size_t i, double& work) {
    const Query& query = block_.queries[i];
    const bool is_drawn = random_.unit() < oracle_share_;
    const bool lacks_bound =
        answers_[i].verdict == Verdict::yes && lacks_habitual_bound(answers_[i]);
    if (!is_drawn && !lacks_bound &&
        is_beyond_doubt(block_.kind, query, judged_[i], answers_[i], standard_)) {
      return 0.0;
    }
    work += oracle_work;
    ++result_.judged_by_oracle;
    const Decision decision(block_.kind, query, options_.separation);
    const Truth truth = truth_of(result_.queries, decision);
    double reward = 0.0;
    if (name_ != judge_name) {
      const auto of_judge = accuse_judge(truth, judged_[i]);
      if (of_judge) reward += report(i, *of_judge, judge_name, decision);
    }
    auto accusation = accuse(block_.kind, query, truth, answers_[i], standard_);
    if (!accusation && lacks_bound) {
      accusation = {FindingKind::not_finite, "a bound that it gives with other collisions is NaN"};
    }
    if (!accusation) return reward;
    explain_asymmetry(i, *accusation);
    return reward + report(i, *accusation, name_, decision);
  }

  /// \pre the answer is a yes
  bool lacks_habitual_bound(const Answer& answer) {
    const bool lacks_lower = lower_habit_.is_missing(answer.toi_lower);
    return upper_habit_.is_missing(answer.toi_upper) || lacks_lower;
  }

  /// If the query is an image and what it is an image of has an answer that contradicts: of what
  /// calls itself exact that is what is wrong.
  void explain_asymmetry(std::size_t i, Accusation& accusation) const {
    const Image* const image = block_.image(i);
    if (image == nullptr || standard_.promise != fast::Promise::exact) return;
    const Answer& other = answers_[image->origin];
    if (failure_at(image->origin) != nullptr ||
        !contradict(answers_[i], other, !image->symmetry.reversed))
      return;
    accusation.what = FindingKind::asymmetry;
    accusation.detail += fmt::format("; of what this is an exact image of ({}) it says: {}",
                                     to_text(image->symmetry), to_text(other));
  }

  double report_failure(std::size_t i, const Failure& failure) {
    const bool hang = failure.kind == FailureKind::hang;
    ++result_.judged_by_oracle;
    const Accusation accusation =
        hang ? Accusation{FindingKind::hang,
                          fmt::format("takes more than {} s", options_.query_limit_seconds)}
             : Accusation{FindingKind::crash, to_text(failure)};
    return report(i, accusation, name_,
                  Decision(block_.kind, block_.queries[i], options_.separation));
  }

  /// Counts a finding, keeps the first of a class. Returns the reward, less for what is not new.
  double report(std::size_t i, const Accusation& accusation, std::string_view method,
                const Decision& decision) {
    ++result_.all_findings;
    ++result_.generators[block_.arms[i]].findings;
    const Class what{std::string(method), accusation.what, block_.kind, judged_[i].stage,
                     block_.arms[i]};
    const std::uint64_t before = classes_[what]++;
    if (before < kept_of_class && !has_found_enough()) keep(i, accusation, method, decision);
    return finding_reward / (1.0 + static_cast<double>(before));
  }

  void keep(std::size_t i, const Accusation& accusation, std::string_view method,
            const Decision& decision) {
    const bool of_judge = method == judge_name && name_ != judge_name;
    const Query& query = block_.queries[i];
    const std::string& generator = result_.generators[block_.arms[i]].name;
    const CertifiedResult& judged = judged_[i];
    const Answer answer = of_judge ? Answer{.verdict = judged.verdict,
                                            .toi_lower = judged.toi_lower,
                                            .toi_upper = judged.toi_upper,
                                            .tolerance = Answer::none}
                                   : answers_[i];
    result_.findings.push_back({.what = accusation.what,
                                .kind = block_.kind,
                                .query = query,
                                .separation = options_.separation,
                                .method = std::string(method),
                                .answer = answer,
                                .collides = decision.collides(),
                                .truth = to_text(truth_of(0, decision)),
                                .detail = accusation.detail,
                                .certificate = prove(block_.kind, query, decision, generator),
                                .seconds = seconds(),
                                .queries = result_.queries,
                                .generator = generator});
    if (!options_.on_finding) return;
    const Clock::time_point called = Clock::now();
    options_.on_finding(result_.findings.back());
    called_back_ += seconds_since(called);
  }

  /// What makes two findings alike: who, what, and found in which way.
  using Class = std::tuple<std::string, FindingKind, Kind, fast::Stage, std::size_t>;

  const FuzzOptions& options_;
  std::string name_;
  Standard standard_;
  double oracle_share_;
  std::vector<Generator> generators_;
  BlockMaker maker_;
  SolverProcess solver_;
  fast::MethodOptions method_options_;
  Random random_;
  Clock::time_point start_ = Clock::now();
  double called_back_ = 0.0;
  SignatureTable signatures_;
  BoundHabit lower_habit_;
  BoundHabit upper_habit_;
  std::map<Class, std::uint64_t> classes_;
  FuzzResult result_;
  // Of the block at hand.
  Block block_;
  std::vector<Answer> answers_;
  std::vector<CertifiedResult> judged_;
  std::vector<QueryFailure> failures_;
};

void check(const FuzzOptions& options) {
  // Written so that NaN fails too.
  if (!(options.seconds >= 0.0) || !(options.query_limit_seconds >= 0.0) ||
      !std::isfinite(options.query_limit_seconds)) {
    throw std::invalid_argument("fuzz: times must not be negative");
  }
  if (!(options.oracle_share >= 0.0 && options.oracle_share <= 1.0)) {
    throw std::invalid_argument("fuzz: oracle_share must be in [0,1]");
  }
  if (options.method.t_max != 1.0) throw std::invalid_argument("fuzz: t_max must be 1");
  if (options.kinds.empty()) throw std::invalid_argument("fuzz: no kind of queries");
  if (!is_valid(options.separation)) {
    throw std::invalid_argument("fuzz: the separation must be finite and not negative");
  }
  if (options.seconds == 0.0 && options.most_queries == 0 && options.most_findings == 0 &&
      options.stop == nullptr) {
    throw std::invalid_argument("fuzz: nothing ends the run");
  }
}

/// Asks again, for shrinking.
class Retrial {
 public:
  Retrial(const fast::Method& method, Finding finding, const FuzzOptions& options)
      : finding_(std::move(finding)),
        standard_{.promise = options.promise.value_or(method.promise()),
                  .separation = options.separation,
                  .reach = options.reach},
        of_judge_(finding_.method == judge_name && method.name() != judge_name),
        solver_(method, Run::process_options(options)),
        method_options_(Run::method_options(options)) {}

  bool operator()(const Query& query) {
    if (!draws::is_finite(query)) return false;
    const auto truth = [&] {
      return truth_of(0, Decision(finding_.kind, query, standard_.separation));
    };
    if (of_judge_) {
      const CertifiedResult judged =
          fast::certified(finding_.kind, query, {.separation = standard_.separation});
      const auto accusation = accuse_judge(truth(), judged);
      return accusation && accusation->what == finding_.what;
    }
    Answer answer;
    const SolverRun run = solver_.solve(finding_.kind, {&query, 1}, {&answer, 1}, method_options_);
    if (!run.failures.empty()) {
      const bool hang = run.failures.front().failure.kind == FailureKind::hang;
      return finding_.what == (hang ? FindingKind::hang : FindingKind::crash);
    }
    if (run.answered == 0) return false;
    if (lacks_same_bound(answer)) return true;
    const auto accusation = accuse(finding_.kind, query, truth(), answer, standard_);
    if (!accusation) return false;
    return accusation->what == finding_.what || finding_.what == FindingKind::asymmetry;
  }

 private:
  /// Was the finding a missing bound, and are the same ones missing here?
  [[nodiscard]] bool lacks_same_bound(const Answer& answer) const {
    const Answer& found = finding_.answer;
    if (finding_.what != FindingKind::not_finite || answer.verdict != Verdict::yes) return false;
    const bool had_bad_number =
        std::isinf(found.toi_lower) || std::isinf(found.toi_upper) || found.tolerance < 0.0;
    return !had_bad_number && std::isnan(found.toi_lower) == std::isnan(answer.toi_lower) &&
           std::isnan(found.toi_upper) == std::isnan(answer.toi_upper);
  }

  Finding finding_;
  Standard standard_;
  bool of_judge_;
  SolverProcess solver_;
  fast::MethodOptions method_options_;
};

}  // namespace

double FuzzResult::queries_per_second() const {
  return seconds > 0.0 ? static_cast<double>(queries) / seconds : 0.0;
}

double FuzzResult::judged_per_second() const {
  return other_seconds > 0.0 ? static_cast<double>(queries) / other_seconds : 0.0;
}

FuzzResult fuzz(const fast::Method& method, const FuzzOptions& options) {
  check(options);
  return Run(method, options).run();
}

std::function<bool(const Query&)> still_fails(const fast::Method& method, const Finding& finding,
                                              const FuzzOptions& options) {
  const auto retrial = std::make_shared<Retrial>(method, finding, options);
  return [retrial](const Query& query) { return (*retrial)(query); };
}

}  // namespace touchstone::verify
