#include "verify/methods/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "fast/certified.hpp"
#include "fast/tight_inclusion.hpp"

namespace touchstone::verify {

namespace {

using Methods = std::vector<std::unique_ptr<const fast::Method>>;

Methods make_methods() {
  Methods all;
  all.push_back(fast::certified_method());
  all.push_back(fast::tight_inclusion_method());
  all.push_back(fast::tight_inclusion_method({.error_model = fast::ErrorModel::published}));
  return all;
}

/// Methods that differ from another one in a setting only, for comparison.
constexpr std::array<std::string_view, 1> variants{"tight_inclusion_published"};

}  // namespace

const std::vector<std::unique_ptr<const fast::Method>>& methods() {
  static const Methods all = make_methods();
  return all;
}

std::vector<std::string_view> default_methods() {
  std::vector<std::string_view> names;
  for (const auto& method : methods()) {
    const bool is_variant = std::ranges::find(variants, method->name()) != variants.end();
    if (method->promise() != fast::Promise::none && !is_variant) names.push_back(method->name());
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
  const bool published = name == "tight_inclusion_published";
  if (name != "tight_inclusion" && !published) return nullptr;
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
