#include "verify/solvers/published.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "verify/published/tight_inclusion_filters.hpp"
#include "verify/solvers/plugin_method.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::solvers {
namespace {

/// What the interface of plugins does not say about each.
const std::vector<fast::MethodInfo>& known_methods() {
  const auto tight_inclusion = [](std::string_view name, fast::ErrorFilter filter) {
    return fast::MethodInfo{.name = name,
                            .variant_of = "tight_inclusion",
                            .norms = {Norm::linf},
                            .is_tolerance_driven = true,
                            .filter = filter};
  };
  constexpr std::int64_t slow = 100'000;
  static const std::vector<fast::MethodInfo> all{
      tight_inclusion("tight_inclusion_published", verify::published::published_filter),
      tight_inclusion("tight_inclusion_float", verify::published::float_filter),
      // The filter of the paper bounds the errors of the released order of operations too, and is
      // not below the released one, so it implies the claim of a yes.
      tight_inclusion("tight_inclusion_released", verify::published::published_filter),
      {.name = "irf", .is_tolerance_driven = true, .usual_max_checks = slow},
      {.name = "uirf", .is_tolerance_driven = true, .usual_max_checks = slow},
      {.name = "fprf", .norms = {Norm::l2}},
      {.name = "tccd"},
      {.name = "rp"},
      {.name = "rrp"},
      {.name = "bsc"},
      {.name = "msrf", .norms = {Norm::l2}}};
  return all;
}

std::unique_ptr<fast::Method> load_published(const fast::MethodInfo& known) {
  const std::filesystem::path library =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "published" /
      fmt::format("{}.so", known.name);
  if (!std::filesystem::exists(library)) {
    throw std::invalid_argument(
        fmt::format("{} is a published method, a plugin that is not built ({}): ./run build "
                    "touchstone_published",
                    known.name, library.string()));
  }
  return load_plugin(library, {.known = known});
}

}  // namespace

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const bool baselines : {false, true}) {
    for (const auto& method : methods()) {
      if (method->info().is_baseline == baselines) names.emplace_back(method->name());
    }
    if (baselines) continue;
    for (const fast::MethodInfo& known : known_methods()) names.emplace_back(known.name);
  }
  return names;
}

const fast::Method& find_any(std::string_view name) {
  const auto known = std::ranges::find(known_methods(), name, &fast::MethodInfo::name);
  if (known != known_methods().end()) {
    static std::mutex mutex;
    static std::map<std::string_view, std::unique_ptr<fast::Method>> loaded;
    const std::scoped_lock lock(mutex);
    std::unique_ptr<fast::Method>& method = loaded[known->name];
    if (!method) method = load_published(*known);
    return *method;
  }
  if (find_info(name) != nullptr) return find_method(name);
  throw std::invalid_argument(
      fmt::format("no method is called {} (there are: {})", name, fmt::join(all_names(), ", ")));
}

}  // namespace touchstone::verify::solvers
