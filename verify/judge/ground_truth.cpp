#include "verify/judge/ground_truth.hpp"

#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify {
namespace {

std::variant<exact::Verdict, exact::DistanceVerdict> verdict_on(Kind kind, const Query& query,
                                                                const Separation& separation) {
  if (is_contact(separation)) return exact::decide(kind, query);
  return exact::decide(kind, query, separation);
}

}  // namespace

Decision::Decision(Kind kind, const Query& query, const Separation& separation)
    : separation_(separation), verdict_(verdict_on(kind, query, separation)) {}

bool Decision::collides() const {
  return std::visit([](const auto& verdict) { return verdict.collides(); }, verdict_);
}

const exact::AlgebraicNumber& Decision::toi() const {
  if (const auto* contact = std::get_if<exact::Verdict>(&verdict_)) return contact->impact->toi;
  return *std::get<exact::DistanceVerdict>(verdict_).toi;
}

exact::Certificate Decision::prove(Kind kind, const Query& query,
                                   const exact::ProveOptions& options) const {
  if (const auto* contact = std::get_if<exact::Verdict>(&verdict_)) {
    return exact::prove(kind, query, *contact, options);
  }
  return exact::prove(kind, query, separation_, std::get<exact::DistanceVerdict>(verdict_),
                      options);
}

}  // namespace touchstone::verify
