#include "verify/solvers/contender.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace touchstone::verify {
namespace {

fast::CertifiedOptions in_one_thread(fast::CertifiedOptions options) {
  options.max_threads = 1;
  return options;
}

class MethodContender : public Contender {
 public:
  MethodContender(std::shared_ptr<const fast::Method> method, const fast::MethodOptions& options)
      : Contender(std::string(method->name()), method->promise()),
        method_(std::move(method)),
        options_(options) {}

  void solve(Kind kind, std::span<const Query> queries) final {
    if (answers_.size() < queries.size()) answers_.resize(queries.size());
    method_->solve(kind, queries, std::span(answers_).first(queries.size()), options_);
  }

  [[nodiscard]] fast::Answer answer(std::size_t i) const final { return answers_[i]; }

 private:
  std::shared_ptr<const fast::Method> method_;
  fast::MethodOptions options_;
  std::vector<fast::Answer> answers_;
};

class CertifiedContender final : public MethodContender {
 public:
  CertifiedContender(const fast::MethodOptions& options, const fast::CertifiedOptions& certified)
      : MethodContender(fast::certified_method(certified), options),
        certified_(in_one_thread(certified)) {
    certified_.t_max = options.t_max;
    certified_.separation = {.distance = options.min_separation, .norm = options.norm};
  }

  [[nodiscard]] std::vector<StageCount> stages(Kind kind, std::span<const Query> queries) override {
    std::vector<fast::CertifiedResult> results(queries.size());
    fast::solve(kind, queries, results, certified_);
    return count_stages(results);
  }

 private:
  fast::CertifiedOptions certified_;
};

/// The collisions that the certified solver finds, in order.
class CollisionContender : public Contender {
 public:
  CollisionContender(std::string name, const fast::CertifiedOptions& options)
      : Contender(std::move(name), fast::Promise::exact), options_(in_one_thread(options)) {}

  [[nodiscard]] fast::Answer answer(std::size_t i) const final {
    const auto found = std::ranges::lower_bound(collisions_, i, {}, &fast::Collision::candidate);
    if (found == collisions_.end() || found->candidate != i) return {.verdict = fast::Verdict::no};
    const fast::CertifiedResult& result = found->result;
    return {.verdict = result.verdict,
            .toi_lower = result.toi_lower,
            .toi_upper = result.toi_upper,
            .tolerance = fast::Answer::none};
  }

 protected:
  void keep(std::vector<fast::Collision> collisions) { collisions_ = std::move(collisions); }
  [[nodiscard]] const fast::CertifiedOptions& options() const { return options_; }

 private:
  fast::CertifiedOptions options_;
  std::vector<fast::Collision> collisions_;
};

class QueryContender final : public CollisionContender {
 public:
  explicit QueryContender(const fast::CertifiedOptions& options)
      : CollisionContender("certified_queries", options) {}

  void solve(Kind kind, std::span<const Query> queries) override {
    keep(fast::collisions(kind, queries, options()));
  }
};

class PairContender final : public CollisionContender {
 public:
  PairContender(const fast::MovingVertices& vertices, const fast::Candidates& candidates,
                const fast::CertifiedOptions& options)
      : CollisionContender("certified_pairs", options),
        vertices_(vertices),
        candidates_(candidates) {}

  [[nodiscard]] bool only_as_a_whole() const override { return true; }

  void solve(Kind kind, std::span<const Query> queries) override {
    if (kind != candidates_.kind || queries.size() != candidates_.pairs.size()) {
      throw std::invalid_argument("certified_pairs: these are not the queries of its candidates");
    }
    keep(fast::collisions(vertices_, candidates_, options()));
  }

 private:
  const fast::MovingVertices& vertices_;
  fast::Candidates candidates_;
};

}  // namespace

std::vector<StageCount> count_stages(std::span<const fast::CertifiedResult> results) {
  std::array<std::uint64_t, fast::stages> counts{};
  for (const fast::CertifiedResult& result : results) {
    ++counts[static_cast<std::size_t>(result.stage)];
  }
  std::vector<StageCount> named;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    named.push_back({fast::name(static_cast<fast::Stage>(i)), counts[i]});
  }
  return named;
}

std::vector<StageCount> Contender::stages(Kind, std::span<const Query>) { return {}; }

const Failure* Contender::failure(std::size_t) const { return nullptr; }

std::unique_ptr<Contender> contend(const fast::Method& method, const fast::MethodOptions& options) {
  // Shares nothing: the caller keeps the method alive.
  const std::shared_ptr<const fast::Method> borrowed(std::shared_ptr<const fast::Method>(),
                                                     &method);
  return std::make_unique<MethodContender>(borrowed, options);
}

std::unique_ptr<Contender> contend_certified(const fast::MethodOptions& options,
                                             const fast::CertifiedOptions& certified) {
  return std::make_unique<CertifiedContender>(options, certified);
}

std::unique_ptr<Contender> contend_with_queries(const fast::CertifiedOptions& certified) {
  return std::make_unique<QueryContender>(certified);
}

std::unique_ptr<Contender> contend_with_pairs(const fast::MovingVertices& vertices,
                                              const fast::Candidates& candidates,
                                              const fast::CertifiedOptions& certified) {
  return std::make_unique<PairContender>(vertices, candidates, certified);
}

}  // namespace touchstone::verify
