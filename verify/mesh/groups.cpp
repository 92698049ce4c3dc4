#include "verify/mesh/groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"

namespace touchstone::verify::mesh {
namespace {

std::int32_t number_of(const Groups& groups, const std::string& name) {
  const auto found = std::ranges::find(groups.names, name);
  if (found != groups.names.end()) {
    return static_cast<std::int32_t>(found - groups.names.begin());
  }
  static constexpr std::size_t most_named = 20;
  std::string names;
  for (const std::string& known :
       std::span(groups.names).first(std::min(most_named, groups.names.size()))) {
    if (!known.empty()) names += (names.empty() ? "" : ", ") + io::quote(known);
  }
  if (groups.names.size() > most_named) names += ", …";
  throw std::invalid_argument(fmt::format("no group {}; there are: {}", io::quote(name), names));
}

}  // namespace

Groups read_groups(const std::filesystem::path& path, std::size_t vertices) {
  Groups groups;
  std::unordered_map<std::string, std::int32_t> numbers;
  io::LineReader lines(path);
  while (const auto line = lines.next()) {
    const auto fail = [&](const std::string& reason) {
      throw io::DatasetError(path, {.line = line->number}, reason);
    };
    if (groups.of_vertex.size() == vertices) {
      fail(fmt::format("a group for more than the {} vertices of the mesh", vertices));
    }
    const std::string name(io::trimmed(line->text));
    if (name.empty()) fail("no name of a group");
    const auto [found, is_new] =
        numbers.try_emplace(name, static_cast<std::int32_t>(groups.names.size()));
    if (is_new) groups.names.push_back(name);
    groups.of_vertex.push_back(found->second);
  }
  if (groups.of_vertex.size() < vertices) {
    throw io::DatasetError(path, {},
                           fmt::format("{} lines, but the mesh has {} vertices: a group's name "
                                       "for each, a line each",
                                       groups.of_vertex.size(), vertices));
  }
  return groups;
}

std::vector<std::array<std::int32_t, 2>> numbers_of(
    const Groups& groups, std::span<const std::pair<std::string, std::string>> names) {
  std::vector<std::array<std::int32_t, 2>> result;
  result.reserve(names.size());
  for (const auto& [a, b] : names) result.push_back({number_of(groups, a), number_of(groups, b)});
  return result;
}

}  // namespace touchstone::verify::mesh
