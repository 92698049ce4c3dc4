#include "verify/judge/responses.hpp"

#include <fmt/format.h>

namespace touchstone::verify::judge {

Responses Responses::of(const Judgement& judgement) {
  return {.asked = judgement.queries,
          .hangs = judgement.count(Fault::hang),
          .errors = judgement.errors_at_queries(),
          .unasked = judgement.outside + judgement.left_out};
}

std::optional<Silence> silence_of(std::string_view solver, const Responses& responses) {
  const auto& [asked, hangs, errors, unasked] = responses;
  if (asked + unasked == 0) return std::nullopt;
  if (hangs + errors >= asked) {
    return Silence{true, fmt::format("{} was not judged: it answered none of {} queries ({} hangs, "
                                     "{} errors, {} not asked)",
                                     solver, asked + unasked, hangs, errors, unasked)};
  }
  constexpr std::uint64_t queries_of_a_hang = 100;
  if (hangs * queries_of_a_hang <= asked) return std::nullopt;
  return Silence{false, fmt::format("{} hung at {} of {} queries: more than one in {} is a fault",
                                    solver, hangs, asked, queries_of_a_hang)};
}

}  // namespace touchstone::verify::judge
