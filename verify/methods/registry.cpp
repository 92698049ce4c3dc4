#include "verify/methods/registry.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace touchstone::verify {

const std::vector<std::unique_ptr<const fast::Method>>& methods() {
  static const std::vector<std::unique_ptr<const fast::Method>> all;
  return all;
}

const fast::Method& find_method(std::string_view name) {
  std::string known;
  for (const auto& method : methods()) {
    if (method->name() == name) return *method;
    known += known.empty() ? "" : ", ";
    known += method->name();
  }
  throw std::invalid_argument(fmt::format("no method is called {} (there are: {})", name,
                                          known.empty() ? "none" : known));
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
