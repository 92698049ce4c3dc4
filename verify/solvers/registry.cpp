#include "verify/solvers/registry.hpp"

#include <fmt/format.h>

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
    fast::tight_inclusion_method,
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

std::string method_names() {
  std::string names;
  for (const auto& method : methods()) {
    names += names.empty() ? "" : ", ";
    names += method->name();
  }
  return names;
}

std::vector<std::string> default_methods(std::span<const Kind> kinds) {
  std::vector<std::string> names;
  for (const auto& method : methods()) {
    const fast::MethodInfo& info = method->info();
    const bool promises =
        info.promise != fast::Promise::none &&
        std::ranges::any_of(kinds, [&](Kind kind) { return info.terms.answers(kind); });
    if (promises && info.variant_of.empty() && !info.is_baseline) names.emplace_back(info.name);
  }
  return names;
}

namespace {

Methods::const_iterator find(std::string_view name) {
  return std::ranges::find_if(methods(),
                              [&](const auto& method) { return method->name() == name; });
}

}  // namespace

const fast::Method& find_method(std::string_view name) {
  const auto found = find(name);
  if (found != methods().end()) return **found;
  throw std::invalid_argument(
      fmt::format("no method is called {} (there are: {})", name, method_names()));
}

const fast::MethodInfo* find_info(std::string_view name) {
  const auto found = find(name);
  return found == methods().end() ? nullptr : &(*found)->info();
}

bool is_own_name(std::string_view name) { return find_info(name) != nullptr; }

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
