#include "verify/fuzz/fuzz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "touchstone/certified.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/fuzz/curved_generators.hpp"
#include "verify/fuzz/generators.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/fuzz/recheck.hpp"
#include "verify/generate/draws.hpp"
#include "verify/generate/symmetry.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/terms.hpp"
#include "verify/solvers/hang_limits.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify::fuzz {
namespace {

namespace draws = generate::draws;
using base::AnyQuery;
using draws::one_in;
using fast::Answer;
using fast::CertifiedResult;
using fast::Verdict;
using generate::Random;

/// Queries of a block before the images: few enough that slow solvers end in time.
constexpr std::size_t block_queries = 256;
/// Queries that one draw of a generator stands for.
constexpr std::size_t slice_queries = 16;
/// The number of slices after which a block is asked though it is not full, because most of its
/// queries are outside the terms.
constexpr std::size_t most_slices = 16 * block_queries / slice_queries;
/// Queries that are judged together: enough for the kernel, and few enough to end in time.
constexpr std::size_t judged_together = 64;
/// The time left to judge answers that were given before the time was over.
constexpr double seconds_to_judge = 1.0;
/// The share of the time left that may go into making one finding simpler.
constexpr double shrink_share = 0.1;
/// One query in this number is asked again as an image.
constexpr std::size_t queries_an_image = 8;
/// One made query in this number is kept, to be mutated.
constexpr std::size_t queries_a_kept_one = 16;

/// Keeps mutated coordinates away from overflow and underflow.
bool is_moderate(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double x) {
    return x == 0.0 || (std::abs(x) > 0x1p-300 && std::abs(x) < 0x1p300);
  });
}

// ---- A block ------------------------------------------------------------------------------------

/// A query that is an exact image of another one in the block.
struct Image {
  std::size_t origin;
  generate::Symmetry symmetry;
};

/// Queries that are asked together: first those that generators made, then images of some of them.
struct FuzzBlock {
  AnyShape shape;
  std::vector<double> numbers;
  std::vector<std::size_t> makers;  ///< by query: its generator
  std::vector<Image> images;        ///< the last queries

  [[nodiscard]] std::size_t size() const { return makers.size(); }
  [[nodiscard]] std::size_t made() const { return size() - images.size(); }
  [[nodiscard]] AnyQueries queries() const { return {shape, numbers}; }
  /// Query i as the only one.
  [[nodiscard]] AnyQueries query(std::size_t i) const { return queries().part(i, 1); }

  /// The image that query i is, or null.
  [[nodiscard]] const Image* image(std::size_t i) const {
    return i < made() ? nullptr : &images[i - made()];
  }

  void add(const AnyQuery& query, std::size_t maker) {
    numbers.insert(numbers.end(), query.numbers().begin(), query.numbers().end());
    makers.push_back(maker);
  }

  /// Leaves the first `count` queries.
  void cut(std::size_t count) {
    if (count >= size()) return;
    images.resize(count > made() ? count - made() : 0);
    numbers.resize(count * shape.numbers_of_query());
    makers.resize(count);
  }
};

/// Makes blocks, one shape after the other.
class FuzzBlockMaker {
 public:
  FuzzBlockMaker(const fast::Terms& terms, const FuzzOptions& options,
                 const std::vector<Generator>& generators)
      : shapes_(answered(options.shapes, terms)),
        terms_(terms),
        hangs_(options.query_limit_seconds),
        generators_(generators),
        context_(options.separation),
        random_(generate::mix(options.seed)) {
    for (const AnyQuery& query : options.corpus) keep(query);
  }

  [[nodiscard]] FuzzBlock make() {
    FuzzBlock block;
    block.shape = shapes_[count_++ % shapes_.size()];
    for (std::size_t slices = 0; block.size() < block_queries; ++slices) {
      if (slices == most_slices && block.size() == 0) {
        throw std::runtime_error("fuzz: no generator makes queries within the solver's terms");
      }
      if (slices >= most_slices) break;
      add_slice(draws::below(random_, generators_.size()), block);
    }
    add_images(block);
    return block;
  }

  /// Notes a hang at a query of the block.
  void note_hang(const AnyShape& shape, std::size_t maker) { hangs_.add(sort_of(shape, maker)); }

  /// Seconds that a query may take now.
  [[nodiscard]] double query_limit() const { return hangs_.seconds(); }
  /// Queries that were made and not asked.
  [[nodiscard]] std::uint64_t outside() const { return outside_; }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  static std::vector<AnyShape> answered(std::vector<AnyShape> shapes, const fast::Terms& terms) {
    std::erase_if(shapes, [&](const AnyShape& shape) { return !terms.answers(shape); });
    if (shapes.empty()) throw std::invalid_argument("fuzz: the solver answers none of the kinds");
    return shapes;
  }

  /// Keeps a query of the corpus, and one on straight lines for each shape.
  void keep(const AnyQuery& query) {
    for (const AnyShape& shape : shapes_) {
      if (shape.kind != query.kind()) continue;
      if (shape == query.shape()) {
        context_.pool(shape).keep(query);
      } else if (query.shape().is_straight()) {
        context_.pool(shape).keep(at_other_speed(shape, query.straight(), shape.degree));
      }
    }
  }

  [[nodiscard]] std::string sort_of(const AnyShape& shape, std::size_t maker) const {
    return fmt::format("{} {}", generators_[maker].name, to_text(shape));
  }

  /// Adds a slice of a generator's queries within the terms.
  void add_slice(std::size_t maker, FuzzBlock& block) {
    for (std::size_t i = 0; i < slice_queries; ++i) {
      const AnyQuery query =
          judge::as_asked(terms_, generators_[maker].make(block.shape, context_, random_));
      if (!judge::admits(terms_, query, context_.separation())) {
        ++outside_;
      } else if (hangs_.leaves_out(sort_of(block.shape, maker))) {
        ++left_out_;
      } else {
        block.add(query, maker);
        if (one_in(random_, queries_a_kept_one) && is_moderate(query.numbers())) {
          context_.pool(block.shape).add(query);
        }
      }
    }
  }

  void add_images(FuzzBlock& block) {
    const std::size_t made = block.size();
    for (std::size_t i = 0; i < made; ++i) {
      if (!one_in(random_, queries_an_image)) continue;
      const generate::Symmetry symmetry =
          generate::draw_symmetry(block.query(i), context_.separation(), random_);
      AnyQuery changed(block.queries(), i);
      if (auto numbers = image(symmetry, block.query(i)))
        changed = {block.shape, *std::move(numbers)};
      if (!judge::admits(terms_, changed, context_.separation())) continue;
      block.add(changed, block.makers[i]);
      block.images.push_back({.origin = i, .symmetry = symmetry});
    }
  }

  std::vector<AnyShape> shapes_;
  const fast::Terms& terms_;
  solvers::HangLimits hangs_;
  const std::vector<Generator>& generators_;
  GeneratorContext context_;
  Random random_;
  std::size_t count_ = 0;
  std::uint64_t outside_ = 0;
  std::uint64_t left_out_ = 0;
};

// ---- Judging ------------------------------------------------------------------------------------

/// Finds bounds that a method gives with nearly every yes, but not with all.
class BoundHabit {
 public:
  /// True if the solver usually gives this bound and now does not.
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

Plainness plainness_of(const Finding& finding) { return plainness(finding.simplest.query); }

/// Puts the most harmful group first, then that with the plainest example.
void sort_groups(fast::Promise promise, FuzzResult& result) {
  const auto rank = [&](std::size_t group) {
    const Finding& best = result.findings[result.groups[group].best];
    return std::pair(judge::harm_of(best.what, best.is_slight, promise), plainness_of(best));
  };
  std::vector<std::size_t> order(result.groups.size()), place(order.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, rank);
  std::vector<FindingGroup> sorted;
  for (const std::size_t group : order) {
    place[group] = sorted.size();
    sorted.push_back(result.groups[group]);
  }
  result.groups = std::move(sorted);
  for (Finding& finding : result.findings) finding.group = place[finding.group];
}

/// True if two answers to equivalent queries contradict.
bool contradict(const Answer& a, const Answer& b, bool same_time) {
  const bool both_decided = (a.verdict == Verdict::yes || a.verdict == Verdict::no) &&
                            (b.verdict == Verdict::yes || b.verdict == Verdict::no);
  if (!both_decided) return false;
  if (a.verdict != b.verdict) return true;
  return same_time && (a.toi_lower > b.toi_upper || b.toi_lower > a.toi_upper);
}

/// One run.
class FuzzRun {
 public:
  FuzzRun(const fast::Method& method, const FuzzOptions& options)
      : options_(options),
        method_(method),
        name_(method.name()),
        standard_(standard_of(method, options)),
        oracle_share_(name_ == judge_name() ? 1.0 : options.oracle_share),
        generators_(generators(options.separation,
                               !std::ranges::all_of(options.shapes, &AnyShape::is_straight))),
        maker_(method.info().terms, options, generators_),
        solver_(method, process_options(options)),
        method_options_(method_options(options)),
        random_(generate::mix(options.seed) + 2) {
    for (const Generator& generator : generators_) {
      result_.generators.push_back({.name = std::string(generator.name)});
    }
  }

  FuzzResult run() {
    while (!is_over()) run_block();
    result_.ended_by = ended_by();
    result_.outside = maker_.outside();
    result_.left_out = maker_.left_out();
    result_.query_limit_seconds = maker_.query_limit();
    sort_groups(standard_.promise, result_);
    result_.output = solver_.take_output();
    result_.seconds = seconds();
    result_.other_seconds = result_.seconds - result_.method_seconds - result_.shrink_seconds;
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is_stopped() const { return verify::base::is_stopped(options_.stop); }

  /// Wall-clock time of the run so far.
  [[nodiscard]] double seconds() const { return options_.clock() - start_; }

  [[nodiscard]] bool is_over() const {
    return is_stopped() || has_found_enough() || has_asked_enough() || end_.is_over();
  }

  [[nodiscard]] FuzzEnd ended_by() const {
    if (is_stopped()) return FuzzEnd::interrupt;
    if (has_found_enough()) return FuzzEnd::findings;
    return has_asked_enough() ? FuzzEnd::queries : FuzzEnd::time;
  }

  [[nodiscard]] bool has_asked_enough() const {
    return options_.most_queries != 0 && result_.queries >= options_.most_queries;
  }

  [[nodiscard]] bool has_found_enough() const {
    return options_.most_groups != 0 && result_.groups.size() >= options_.most_groups;
  }

  void run_block() {
    block_ = maker_.make();
    if (options_.most_queries != 0) {
      block_.cut(std::min<std::uint64_t>(block_.size(), options_.most_queries - result_.queries));
    }
    answers_.assign(block_.size(), Answer{});
    const double asked = seconds();
    solver_.set_query_limit(maker_.query_limit());
    // A block of a slow method may take minutes.
    const solvers::SolverRun run =
        solver_.solve(block_.queries(), answers_, method_options_, {.end = solver_deadline(end_)});
    result_.method_seconds += seconds() - asked;
    result_.unplaced_crashes += run.unplaced_crashes;
    limit_ = maker_.query_limit();
    for (const auto& [position, failure] : run.failures) {
      if (failure.kind != judge::Fault::hang) continue;
      maker_.note_hang(block_.shape, block_.makers[position]);
    }
    if (end_.is_over() || is_stopped()) result_.unanswered = block_.size() - run.answered;
    judge(run);
    if (options_.on_progress) options_.on_progress(seconds(), result_.queries);
  }

  /// Judges the answers, all of them unless the run must end. Even if they come late, there is time
  /// to judge some; crashes and hangs are always reported.
  void judge(const solvers::SolverRun& run) {
    judged_.assign(run.answered, CertifiedResult{});
    failures_ = run.failures;
    judging_end_ = end_.at_least(seconds_to_judge);
    std::size_t done = 0;
    while (done < judged_.size() && may_judge(done)) done = judge_part(done);
    std::size_t late = 0;
    for (const auto& [position, failure] : failures_) {
      if (position < done || has_found_enough()) continue;
      judge_together(position, 1);
      judge_query(position, &failure);
      ++late;
    }
    result_.unjudged += judged_.size() - done - late;
  }

  /// True if time remains to judge another query, after `done` queries of the block.
  [[nodiscard]] bool may_judge(std::size_t done) const {
    return !is_stopped() && !has_found_enough() && (done == 0 || !judging_end_.is_over());
  }

  /// Judges some queries from number `first` on. Returns the number of the next one.
  std::size_t judge_part(std::size_t first) {
    // In parts: with a distance and extreme coordinates a query may take a second.
    const std::size_t end = std::min(first + judged_together, judged_.size());
    judge_together(first, end - first);
    std::size_t i = first;
    while (i < end && may_judge(i)) {
      judge_query(i, failure_at(i));
      ++i;
    }
    return i;
  }

  void judge_together(std::size_t first, std::size_t count) {
    base::solve(block_.queries().part(first, count), std::span(judged_).subspan(first, count),
                {.separation = options_.separation, .max_threads = 1});
  }

  /// The failure at a query, or null.
  [[nodiscard]] const judge::Failure* failure_at(std::size_t i) const {
    return judge::failure_at(failures_, i);
  }

  void judge_query(std::size_t i, const judge::Failure* failure) {
    GeneratorStatistics& statistics = result_.generators[block_.makers[i]];
    ++result_.queries;
    ++statistics.queries;
    result_.images += block_.image(i) != nullptr ? 1U : 0U;
    if (judged_[i].verdict == Verdict::yes) {
      ++result_.collisions;
      ++statistics.collisions;
    }
    if (failure != nullptr) {
      report_failure(i, *failure);
    } else {
      examine_answer(i);
    }
  }

  /// Looks for every fault of an answer.
  void examine_answer(std::size_t i) {
    const judge::Question question{block_.query(i), options_.separation};
    const bool is_drawn = random_.unit() < oracle_share_;
    const MissingBounds missing = missing_bounds(answers_[i]);
    if (!is_drawn && !missing.any() &&
        is_beyond_doubt(question, judged_[i], answers_[i], standard_)) {
      return;
    }
    ++result_.judged_by_oracle;
    const exact::Decision verdict = base::decide(question.query, 0, question.separation);
    const judge::GroundTruth truth = judge::truth_of(result_.queries, verdict);
    if (name_ != judge_name()) {
      const auto of_judge = diagnose(question, truth, answer_of(judged_[i]),
                                     judge::standard_of(fast::certified_info()));
      if (of_judge) report(i, {*of_judge, judge_name()}, verdict);
    }
    if (auto diagnosis = diagnose(question, truth, answers_[i], standard_)) {
      explain_asymmetry(i, *diagnosis);
      report(i, {*diagnosis, name_}, verdict);
    } else if (missing.any()) {
      report(i,
             {{judge::Fault::not_finite,
               fmt::format("{} is NaN, but the solver gives it with other collisions",
                           missing.lower ? "toi_lower" : "toi_upper")},
              name_,
              missing},
             verdict);
    }
  }

  MissingBounds missing_bounds(const Answer& answer) {
    if (answer.verdict != Verdict::yes) return {};
    return {.lower = lower_habit_.is_missing(answer.toi_lower),
            .upper = upper_habit_.is_missing(answer.toi_upper)};
  }

  /// For an exact solver, contradictory answers to a query and its image are an asymmetry.
  void explain_asymmetry(std::size_t i, Diagnosis& diagnosis) const {
    const Image* const image = block_.image(i);
    if (image == nullptr || standard_.promise != fast::Promise::exact) return;
    const bool origin_has_answer = failure_at(image->origin) == nullptr;
    const Answer& other = answers_[image->origin];
    if (!origin_has_answer || !contradict(answers_[i], other, !image->symmetry.reversed)) return;
    diagnosis.what = judge::Fault::asymmetry;
    diagnosis.detail += "; the query that it is an exact image of is answered: " + to_text(other);
  }

  void report_failure(std::size_t i, const judge::Failure& failure) {
    ++result_.judged_by_oracle;
    report(i, {diagnose_failure(failure, limit_), name_},
           base::decide(block_.queries(), i, options_.separation));
  }

  /// The method that is wrong, and how.
  struct Charge {
    Diagnosis diagnosis;
    std::string_view method;
    MissingBounds missing = {};
  };

  /// True if the finding is a time that is late slightly.
  [[nodiscard]] bool is_slight(const Charge& charge, const Answer& answer,
                               const exact::Decision& verdict) const {
    return judge::is_slight(charge.diagnosis.what, judge::lateness_of(judge::truth_of(0, verdict),
                                                                      answer, standard_.terms));
  }

  /// Counts a finding, and keeps the first of a class.
  void report(std::size_t i, const Charge& charge, const exact::Decision& verdict) {
    if (!seeks(options_, charge.diagnosis.what)) {
      ++result_.other_findings;
      return;
    }
    ++result_.all_findings;
    ++result_.generators[block_.makers[i]].findings;
    const Class what{std::string(charge.method), charge.diagnosis.what,
                     to_text(block_.shape),      judged_[i].is_exact,
                     block_.makers[i],           is_slight(charge, answers_[i], verdict)};
    if (const auto known = classes_.find(what); known != classes_.end()) {
      ++result_.groups[known->second].count;
    } else if (!has_found_enough()) {
      classes_[what] = keep(i, charge, verdict);
    }
  }

  /// Returns the finding's group.
  std::size_t keep(std::size_t i, const Charge& charge, const exact::Decision& verdict) {
    const bool of_judge = charge.method == judge_name() && name_ != judge_name();
    const std::string& generator = result_.generators[block_.makers[i]].name;
    Finding finding{.what = charge.diagnosis.what,
                    .separation = options_.separation,
                    .method = std::string(charge.method),
                    .original = failing_case({block_.queries(), i},
                                             of_judge ? answer_of(judged_[i]) : answers_[i],
                                             verdict, charge.diagnosis.detail, generator),
                    .missing = charge.missing,
                    .is_slight = is_slight(charge, answers_[i], verdict),
                    .seconds = seconds(),
                    .queries = result_.queries,
                    .generator = generator};
    finding.simplest = finding.original;
    make_simpler(finding);
    finding.group = add_to_group(finding);
    result_.findings.push_back(std::move(finding));
    if (options_.on_finding) options_.on_finding(result_.findings.back());
    return result_.findings.back().group;
  }

  /// Counts a finding that is about to be kept in its group, which may be a new one.
  std::size_t add_to_group(const Finding& finding) {
    const auto [known, is_new] = groups_.try_emplace(signature_of(finding), result_.groups.size());
    if (is_new) result_.groups.push_back({.count = 0, .best = result_.findings.size()});
    FindingGroup& group = result_.groups[known->second];
    ++group.count;
    if (!is_new && plainness_of(finding) < plainness_of(result_.findings[group.best])) {
      group.best = result_.findings.size();
    }
    return known->second;
  }

  /// Simplifies its query.
  void make_simpler(Finding& finding) {
    if (options_.shrink_seconds == 0.0) return;
    const double begin = seconds();
    const double most =
        std::min(options_.shrink_seconds, shrink_share * judging_end_.seconds_left());
    simplify(method_, options_, judging_end_.at_most(most), finding);
    result_.shrink_seconds += seconds() - begin;
  }

  /// The class of a finding, by its obvious properties: the method that is wrong, the fault, the
  /// shape, whether the judge is exact, the generator, and whether a late time is slightly late.
  using Class = std::tuple<std::string, judge::Fault, std::string, bool, std::size_t, bool>;

  const FuzzOptions& options_;
  const fast::Method& method_;
  std::string name_;
  judge::Standard standard_;
  double oracle_share_;
  std::vector<Generator> generators_;
  FuzzBlockMaker maker_;
  solvers::SolverProcess solver_;
  fast::MethodOptions method_options_;
  Random random_;
  double start_ = options_.clock();
  base::Deadline end_{
      options_.seconds > 0.0 ? options_.seconds : std::numeric_limits<double>::infinity(),
      options_.clock};
  BoundHabit lower_habit_;
  BoundHabit upper_habit_;
  std::map<Class, std::size_t> classes_;  ///< the group of the first, which was kept
  std::map<Signature, std::size_t> groups_;
  FuzzResult result_;
  // The block at hand.
  FuzzBlock block_;
  std::vector<Answer> answers_;
  std::vector<CertifiedResult> judged_;
  std::vector<judge::QueryFailure> failures_;
  double limit_ = 0.0;  ///< of a query
  base::Deadline judging_end_;
};

}  // namespace

bool seeks(const FuzzOptions& options, judge::Fault what) {
  return options.only.empty() || std::ranges::find(options.only, what) != options.only.end();
}

fast::MethodOptions method_options(const FuzzOptions& options) {
  fast::MethodOptions result = options.method;
  result.separation = options.separation;
  return result;
}

std::string_view to_string(FuzzEnd end) {
  switch (end) {
    case FuzzEnd::time:
      return "time";
    case FuzzEnd::queries:
      return "queries";
    case FuzzEnd::findings:
      return "findings";
    default:
      return "interrupt";
  }
}

double FuzzResult::queries_per_second() const {
  return seconds > 0.0 ? static_cast<double>(queries) / seconds : 0.0;
}

double FuzzResult::judged_per_second() const {
  return other_seconds > 0.0 ? static_cast<double>(queries) / other_seconds : 0.0;
}

FuzzResult fuzz(const fast::Method& method, const FuzzOptions& options) {
  return FuzzRun(method, options).run();
}

}  // namespace touchstone::verify::fuzz
