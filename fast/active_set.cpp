#include "touchstone/contacts.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <tuple>

#include "fast/certified/exact/closest_point_parameters.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/step/scene.hpp"

namespace touchstone::fast {
namespace {

using Eigen::Vector3d;

/// F at the contact, in units of 2^-500 of the greatest coordinate, so that nothing overflows, nor
/// underflows at the least times: F = r − u p − v q.
struct Contact {
  Vector3d p, q;
  Vector3d f;     ///< F
  Vector3d rate;  ///< F'
  double error;   ///< estimated error of F, from rounding and the enclosure of the time
};

Contact contact_of(Kind kind, const Query& query, const StepCollision& collision) {
  using exact_stage::AffineVectors;
  auto [start, end] = exact_stage::scaled_vectors(kind, query);
  for (AffineVectors* const one : {&start, &end}) {
    for (Vector3d* const vector : {&one->r, &one->p, &one->q}) *vector *= 0x1p500;
  }
  const double t = collision.toi_upper, u = collision.u, v = collision.v;
  const AffineVectors now{(1.0 - t) * start.r + t * end.r, (1.0 - t) * start.p + t * end.p,
                          (1.0 - t) * start.q + t * end.q};
  const AffineVectors moved{end.r - start.r, end.p - start.p, end.q - start.q};
  Contact result;
  result.p = now.p;
  result.q = now.q;
  result.f = now.r - u * now.p - v * now.q;
  result.rate = moved.r - u * moved.p - v * moved.q;
  constexpr double rounding = 0x1p-40;
  const double size = std::max({now.r.lpNorm<Eigen::Infinity>(), result.p.lpNorm<Eigen::Infinity>(),
                                result.q.lpNorm<Eigen::Infinity>()});
  result.error = rounding * size + (t - collision.toi_lower) * result.rate.stableNorm();
  return result;
}

/// The normal of a pair with a product p × q.
Vector3d normal_along(const Contact& contact, const Vector3d& product) {
  const Vector3d n = product.stableNormalized();
  const double height = n.dot(contact.f), speed = n.dot(contact.rate);
  const bool is_apart = std::abs(height) > contact.error;
  return (is_apart ? height < 0.0 : speed > 0.0) ? Vector3d(-n) : n;
}

/// The normal of a degenerate pair.
Vector3d normal_of_degenerate(const Contact& contact) {
  const Vector3d& longer = contact.p.stableNorm() >= contact.q.stableNorm() ? contact.p : contact.q;
  const Vector3d along = longer.stableNormalized();
  const auto upright = [&](const Vector3d& x) -> Vector3d { return x - x.dot(along) * along; };
  if (contact.f.stableNorm() > contact.error) return contact.f.stableNormalized();
  const Vector3d against = upright(-contact.rate);
  constexpr double noise = 0x1p-40;
  if (against.stableNorm() > noise * contact.rate.stableNorm()) return against.stableNormalized();
  Eigen::Index axis = 0;
  along.cwiseAbs().minCoeff(&axis);
  return upright(Vector3d::Unit(axis)).normalized();
}

Vector3d normal_of(const Contact& contact) {
  constexpr double least_sine = 0x1p-20;
  const Vector3d product = contact.p.stableNormalized().cross(contact.q.stableNormalized());
  if (product.norm() > least_sine) return normal_along(contact, product);
  return normal_of_degenerate(contact);
}

/// The place of a point of the query at a time.
Vector3d place(const Query& query, std::size_t point, double t) {
  return (1.0 - t) * query.point(0, point) + t * query.point(1, point);
}

ActiveContact active_contact(const Step& step, const StepCollision& collision) {
  const Kind kind = Step::kind_of(collision.kind);
  const Query query = step.query_of(collision.kind, collision.pair);
  const double u = collision.u, v = collision.v;
  const auto at = [&](std::size_t point) { return place(query, point, collision.toi_upper); };
  const bool is_face = kind == Kind::vertex_face;
  return {collision, is_face ? at(0) : Vector3d((1.0 - u) * at(0) + u * at(1)),
          is_face ? Vector3d((1.0 - u - v) * at(1) + u * at(2) + v * at(3))
                  : Vector3d((1.0 - v) * at(2) + v * at(3)),
          normal_of(contact_of(kind, query, collision))};
}

}  // namespace

std::vector<ActiveContact> active_set(const Step& step, const Separation& separation) {
  const std::vector<StepCollision> collisions = step.with_separation(separation).collisions();
  const StrictFloatingPoint strict;
  std::vector<ActiveContact> result;
  result.reserve(collisions.size());
  for (const StepCollision& one : collisions) result.push_back(active_contact(step, one));
  std::ranges::sort(result, [](const ActiveContact& a, const ActiveContact& b) {
    return std::tie(a.toi_lower, a.toi_upper, a.kind, a.pair) <
           std::tie(b.toi_lower, b.toi_upper, b.kind, b.pair);
  });
  return result;
}

ActiveContact contact_at(const Step& step, PairKind kind, const IndexPair& pair, double t,
                         Norm norm) {
  if (!(t >= 0.0 && t <= 1.0))
    throw std::invalid_argument("contact_at: the time must be in [0, 1]");
  const StrictFloatingPoint strict;
  const auto [u, v] =
      exact_stage::nearest_parameters(Step::kind_of(kind), step.query_of(kind, pair), t, norm);
  const CertifiedResult nearest{
      .verdict = Verdict::yes, .toi_lower = t, .toi_upper = t, .u = u, .v = v};
  return active_contact(step, collision_of(kind, pair, nearest));
}

}  // namespace touchstone::fast
