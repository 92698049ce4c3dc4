#include "verify/solvers/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "fast/certified.hpp"
#include "fast/tight_inclusion.hpp"
#include "verify/baselines/accd.hpp"
#include "verify/baselines/bsc.hpp"
#include "verify/baselines/fprf.hpp"
#include "verify/baselines/irf.hpp"
#include "verify/baselines/msrf.hpp"
#include "verify/baselines/rp.hpp"
#include "verify/baselines/rrp.hpp"
#include "verify/baselines/tccd.hpp"
#include "verify/baselines/uirf.hpp"

namespace touchstone::verify {

namespace {

using Methods = std::vector<std::unique_ptr<const fast::Method>>;

std::unique_ptr<fast::Method> tight_inclusion_released() {
  return fast::tight_inclusion_method({.error_model = fast::ErrorModel::released});
}

/// The known methods, which are here to be compared with.
constexpr auto baselines = std::to_array<std::unique_ptr<fast::Method> (*)()>({
    tight_inclusion_released,
    baselines::irf_method,
    baselines::uirf_method,
    baselines::fprf_method,
    baselines::tccd_method,
    baselines::rp_method,
    baselines::rrp_method,
    baselines::bsc_method,
    baselines::msrf_method,
    baselines::accd_method,
});

/// Ours, then the baselines.
Methods make_methods() {
  Methods all;
  all.push_back(fast::certified_method());
  all.push_back(fast::tight_inclusion_method());
  all.push_back(fast::tight_inclusion_method({.error_model = fast::ErrorModel::published}));
  for (const auto make : baselines) all.push_back(make());
  return all;
}

/// Methods that differ from another one in a setting only, for comparison.
constexpr std::array<std::string_view, 1> variants{"tight_inclusion_published"};

}  // namespace

const std::vector<std::unique_ptr<const fast::Method>>& methods() {
  static const Methods all = make_methods();
  return all;
}

bool is_baseline(std::string_view name) {
  // They stand behind all others.
  const auto first = methods().end() - static_cast<std::ptrdiff_t>(baselines.size());
  return std::any_of(first, methods().end(),
                     [&](const auto& method) { return method->name() == name; });
}

std::vector<std::string_view> default_methods() {
  std::vector<std::string_view> names;
  for (const auto& method : methods()) {
    const std::string_view name = method->name();
    const bool is_variant = std::ranges::find(variants, name) != variants.end();
    const bool promises = method->promise() != fast::Promise::none;
    if (promises && !is_variant && !is_baseline(name)) names.push_back(name);
  }
  return names;
}

const fast::Method& find_method(std::string_view name) {
  std::string known;
  for (const auto& method : methods()) {
    if (method->name() == name) return *method;
    known += known.empty() ? "" : ", ";
    known += method->name();
  }
  throw std::invalid_argument(
      fmt::format("no method is called {} (there are: {})", name, known.empty() ? "none" : known));
}

Reach reach_of(std::string_view name) {
  // The published filter bounds the errors of the released order of operations too, and is not below
  // the released one: so what a yes with the released filter claims follows from it.
  const bool published = name == "tight_inclusion_published" || name == "tight_inclusion_released";
  if (name != "tight_inclusion" && !published) return stated_reach;
  return
      [model = published ? fast::ErrorModel::published : fast::ErrorModel::derived](
          Kind kind, const Query& query, const fast::Answer& answer, const Separation& separation) {
        return tight_inclusion_reach(kind, query, answer, separation, model);
      };
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

}  // namespace touchstone::verify
