#include "verify/baselines/method_support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "fast/platform/floating_point_state.hpp"
#include "touchstone/mesh.hpp"
#include "verify/baselines/closest_features.hpp"

namespace touchstone::baselines {
namespace {

fast::Answer answer_of(AnswerFunction answer, const AnyQueries& queries, std::size_t i,
                       const fast::MethodOptions& options) {
  if (!is_finite(queries.row(i))) return {.verdict = fast::Verdict::error};
  try {
    return answer(queries, i, options);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    return {.verdict = fast::Verdict::yes};
  }
}

class BaselineMethod final : public fast::Method {
 public:
  BaselineMethod(fast::MethodInfo info, AnswerFunction answer)
      : info_(std::move(info)), answer_(answer) {
    info_.is_baseline = true;
  }

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }

  void solve(const AnyQueries& queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& options) const override {
    if (!are_valid(options)) {
      std::ranges::fill(answers, fast::Answer{.verdict = fast::Verdict::error});
      return;
    }
    const fast::StrictFloatingPoint state;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      answers[i] = answer_of(answer_, queries, i, options);
    }
  }

 private:
  fast::MethodInfo info_;
  AnswerFunction answer_;
};

}  // namespace

bool are_valid(const fast::MethodOptions& options) {
  return std::isfinite(options.tolerance) && options.tolerance > 0.0 &&
         std::isfinite(options.separation.distance) && options.separation.distance >= 0.0 &&
         options.t_max >= 0.0 && options.t_max <= 1.0;
}

std::uint32_t to_checks(std::int64_t steps) {
  return static_cast<std::uint32_t>(
      std::min<std::int64_t>(steps, std::numeric_limits<std::uint32_t>::max()));
}

Eigen::Vector3d position_at(const Query& query, std::size_t point, double t) {
  return point_of(query, 0, point) + t * (point_of(query, 1, point) - point_of(query, 0, point));
}

double squared_distance_at(ContactKind kind, const Query& query, double t) {
  const auto at = [&](std::size_t point) { return position_at(query, point, t); };
  return kind == ContactKind::vertex_face
             ? closest_point_squared_distance(at(0), {at(1), at(2), at(3)})
             : closest_points_squared_distance({at(0), at(1)}, {at(2), at(3)});
}

std::unique_ptr<fast::Method> baseline_method(fast::MethodInfo info, AnswerFunction answer) {
  return std::make_unique<BaselineMethod>(std::move(info), answer);
}

}  // namespace touchstone::baselines
