#include "verify/mesh/groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "verify/io/csv.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/number_text.hpp"

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

/// The numbers of many names.
class Numbers {
 public:
  explicit Numbers(const Groups& groups) : groups_(groups) {
    for (std::size_t i = 0; i < groups.names.size(); ++i) {
      numbers_.try_emplace(groups.names[i], static_cast<std::int32_t>(i));
    }
  }

  /// \throws std::invalid_argument if no group has this name.
  std::int32_t operator()(std::string_view name) const {
    const auto found = numbers_.find(std::string(io::trimmed(name)));
    return found != numbers_.end() ? found->second : number_of(groups_, std::string(name));
  }

 private:
  const Groups& groups_;
  std::unordered_map<std::string, std::int32_t> numbers_;
};

/// Calls take(numbers, number) for the lines of a table of groups, in any order but each once, and
/// a number that is not negative at their ends.
template <std::size_t names, class Take>
void read_table(const std::filesystem::path& path, const Groups& groups, std::string_view form,
                const Take& take) {
  const Numbers number_of(groups);
  std::map<std::array<std::int32_t, names>, std::uint64_t> known;
  io::LineReader lines(path);
  while (const auto line = lines.next()) {
    std::array<std::string, names + 1> fields;
    const io::CsvSplit split = io::split_csv(line->text, fields);
    const auto number = io::number_from_text<double>(io::trimmed(fields[names]));
    if (split.fault != io::CsvSplit::Fault::none || split.count != fields.size() || !number ||
        !std::isfinite(*number) || *number < 0.0) {
      throw io::DatasetError(path, {.line = line->number},
                             fmt::format("expected {}, the last a number >= 0, found {}", form,
                                         io::quote(line->text)));
    }
    std::array<std::int32_t, names> numbers{};
    std::transform(fields.begin(), fields.end() - 1, numbers.begin(), number_of);
    auto key = numbers;
    std::ranges::sort(key);
    const auto [first, is_new] = known.try_emplace(key, line->number);
    if (!is_new) {
      throw io::DatasetError(
          path, {.line = line->number},
          fmt::format("{} in line {}, too: leave one of them out",
                      names == 1 ? "the group has a radius" : "the two groups have a distance",
                      first->second));
    }
    take(numbers, *number);
  }
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

std::vector<double> read_radii(const std::filesystem::path& path, const Groups& groups) {
  std::vector<double> result(groups.names.size());
  read_table<1>(path, groups, "GROUP,RADIUS", [&](const auto& group, double radius) {
    result[static_cast<std::size_t>(group[0])] = radius;
  });
  return result;
}

std::vector<fast::GroupSeparation> read_separations(const std::filesystem::path& path,
                                                    const Groups& groups) {
  std::vector<fast::GroupSeparation> result;
  read_table<2>(path, groups, "GROUP,GROUP,DISTANCE", [&](const auto& two, double distance) {
    result.push_back({two, distance});
  });
  return result;
}

std::vector<std::array<std::int32_t, 2>> numbers_of(
    const Groups& groups, std::span<const std::pair<std::string, std::string>> names) {
  std::vector<std::array<std::int32_t, 2>> result;
  result.reserve(names.size());
  for (const auto& [a, b] : names) result.push_back({number_of(groups, a), number_of(groups, b)});
  return result;
}

}  // namespace touchstone::verify::mesh
