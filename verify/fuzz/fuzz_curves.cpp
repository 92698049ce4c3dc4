#include "verify/fuzz/fuzz_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "touchstone/oracle.hpp"
#include "verify/generate/curved_families.hpp"
#include "verify/generate/random.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judge.hpp"

namespace touchstone::verify::fuzz {
namespace {

constexpr std::size_t curved_block_size = 64;

/// Queries of one form.
struct CurvedBlock {
  Kind kind;
  std::size_t degree;
  bool is_rational;
  std::vector<double> numbers;

  [[nodiscard]] CurvedQueries queries() const { return {degree, is_rational, numbers}; }
};

class CurvedDraws {
 public:
  CurvedDraws(bool is_low, const CurvedFuzzOptions& options)
      : is_low_(is_low),
        kinds_(options.kinds),
        has_distance_(options.method.separation.distance > 0.0),
        random_(options.seed) {}

  CurvedBlock next() {
    const Kind kind = kinds_.at(pick(kinds_.size()));
    CurvedBlock block = random_.coin() ? of_family(kind) : of_numbers(kind);
    if (random_.coin()) mutate(block);
    return block;
  }

 private:
  std::size_t pick(std::size_t count) {
    return static_cast<std::size_t>(random_.between(0, static_cast<std::int64_t>(count) - 1));
  }

  CurvedBlock of_family(Kind kind) {
    auto all = generate::curved_families(2 + pick(2), curved_block_size, random_.bits());
    std::erase_if(all, [kind](const auto& family) { return family.kind != kind; });
    generate::CurvedFamily& family = all.at(pick(all.size()));
    return {kind, family.degree, family.is_rational, std::move(family.numbers)};
  }

  /// Small multiples of 1/4 or any numbers, about the same place.
  CurvedBlock of_numbers(Kind kind) {
    CurvedBlock block{kind, 2 + pick(2), false, {}};
    // (The oracle takes up to seconds for rational curves of degree 2 at a distance.)
    block.is_rational = random_.coin() && !(is_low_ && has_distance_);
    const std::size_t most = has_distance_ ? 2 : 4;
    if (!is_low_) block.degree = 1 + pick(block.is_rational ? most / 2 : most);
    if (is_low_ && block.is_rational) block.degree = 2;
    const bool is_whole = random_.coin();
    // One weight for all points, for each primitive, or for each point.
    const std::size_t weights = 1 + pick(3);
    const std::size_t second = kind == Kind::vertex_face ? 1 : 2;
    for (std::size_t row = 0; row < curved_block_size * (block.degree + 1); ++row) {
      std::array<double, moving_points> of_point{};
      for (double& w : of_point) w = is_whole ? number(1, 3) : random_.uniform(0.5, 2.0);
      for (std::size_t point = 0; point < moving_points; ++point) {
        for (int axis = 0; axis < 3; ++axis) {
          block.numbers.push_back(is_whole ? number(-8, 8) / 4.0 : random_.uniform(-1.0, 1.0));
        }
        if (!block.is_rational) continue;
        const std::size_t of = weights == 1   ? 0
                               : weights == 2 ? (point >= second ? 1U : 0U)
                                              : point;
        block.numbers.push_back(of_point.at(of));
      }
    }
    return block;
  }

  double number(std::int64_t least, std::int64_t greatest) {
    return static_cast<double>(random_.between(least, greatest));
  }

  /// Changes some numbers of each query.
  void mutate(CurvedBlock& block) {
    const std::size_t size = block.queries().numbers_of_query();
    const std::size_t stride = block.queries().numbers_of_point();
    for (std::size_t first = 0; first < block.numbers.size(); first += size) {
      for (std::size_t change = pick(4); change > 0; --change) {
        const std::size_t place = first + pick(size);
        double& x = block.numbers[place];
        const double way = random_.coin() ? std::numeric_limits<double>::infinity() : 0.0;
        const std::size_t other = first + pick(size / stride) * stride + place % stride;
        switch (pick(3)) {
          case 0:
            x = std::nextafter(x, way);
            break;
          case 1:
            x = std::ldexp(x, static_cast<int>(random_.between(-10, 10)));
            break;
          default:
            x = block.numbers[other];
        }
      }
    }
  }

  bool is_low_;
  std::vector<Kind> kinds_;
  bool has_distance_;
  generate::Random random_;
};

/// The first fault that breaks the promise.
std::optional<judge::Fault> fault_of(const fast::Answer& answer, const exact::Decision& truth,
                                     fast::Promise promise) {
  for (const judge::Fault fault : judge::judge_verdict(judge::truth_of(0, truth), answer)) {
    if (judge::breaks(fault, promise)) return fault;
  }
  return std::nullopt;
}

}  // namespace

CurvedFuzzResult fuzz_curves(const AnswerCurves& answer, bool is_low,
                             const CurvedFuzzOptions& options) {
  CurvedFuzzResult result;
  CurvedDraws draws(is_low, options);
  const double begin = options.clock();
  const auto is_over = [&] {
    return (options.stop != nullptr && *options.stop) ||
           (options.seconds > 0.0 && options.clock() - begin >= options.seconds) ||
           (options.most_queries != 0 && result.queries >= options.most_queries) ||
           (options.most_findings != 0 && result.findings.size() >= options.most_findings);
  };
  while (!is_over()) {
    const CurvedBlock block = draws.next();
    const CurvedQueries queries = block.queries();
    const std::vector<fast::Answer> answers = answer(block.kind, queries, options.method);
    for (std::size_t i = 0; i < queries.size() && !is_over(); ++i) {
      const exact::Decision truth =
          exact::decide(block.kind, queries.query(i), options.method.separation);
      ++result.queries;
      result.collisions += truth.collides() ? 1U : 0U;
      const auto fault = fault_of(answers[i], truth, options.promise);
      if (!fault) continue;
      const auto row = queries.row(i);
      result.findings.push_back({*fault, block.kind, block.degree, block.is_rational,
                                 std::vector<double>(row.begin(), row.end()), answers[i]});
    }
    if (options.on_progress) options.on_progress(result.queries);
  }
  return result;
}

}  // namespace touchstone::verify::fuzz
