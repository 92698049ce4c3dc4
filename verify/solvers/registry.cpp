#include "verify/solvers/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "touchstone/certified.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "verify/baselines/baselines.hpp"

namespace touchstone::verify::solvers {

namespace {

using Methods = std::vector<std::unique_ptr<const fast::Method>>;

/// Ours, then the baselines, those for curves last.
constexpr auto factories = std::to_array<std::unique_ptr<fast::Method> (*)()>({
    [] { return fast::certified_method(); },
    [] { return fast::tight_inclusion_method(); },
    baselines::accd_method,
    baselines::accd_limited_method,
    baselines::cubic_method,
    baselines::inversion_cubic_method,
    baselines::inversion_additive_method,
    baselines::subdivision_method,
    baselines::subdivision_largest_deviation_method,
    baselines::sampling_method,
    baselines::advancement_method,
});

Methods make_methods() {
  Methods all;
  for (const auto make : factories) all.push_back(make());
  return all;
}

}  // namespace

const std::vector<std::unique_ptr<const fast::Method>>& methods() {
  static const Methods all = make_methods();
  return all;
}

std::vector<std::string> default_methods(std::span<const AnyKind> kinds) {
  std::vector<std::string> names;
  for (const auto& method : methods()) {
    const fast::MethodInfo& info = method->info();
    const bool promises =
        info.promise != fast::Promise::none &&
        std::ranges::any_of(kinds, [&](AnyKind kind) { return info.terms.answers(kind); });
    if (promises && info.variant_of.empty() && !info.is_baseline) names.emplace_back(info.name);
  }
  return names;
}

const fast::Method& find_method(std::string_view name) {
  std::vector<std::string_view> names;
  for (const auto& method : methods()) {
    if (method->name() == name) return *method;
    names.push_back(method->name());
  }
  throw std::invalid_argument(
      fmt::format("no method is called {} (there are: {})", name, fmt::join(names, ", ")));
}

const fast::MethodInfo* find_info(std::string_view name) {
  for (const auto& method : methods()) {
    if (method->name() == name) return &method->info();
  }
  return nullptr;
}

std::string_view to_string(fast::Promise promise) {
  switch (promise) {
    case fast::Promise::none:
      return "none";
    case fast::Promise::conservative:
      return "conservative";
    default:
      return "exact";
  }
}

}  // namespace touchstone::verify::solvers
