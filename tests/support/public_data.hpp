#pragma once

/// \file
/// The public data, which is not part of the project and may be missing. A build without the tool
/// has no readers for it.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tests/support/built_files.hpp"
#include "verify/data/dataset.hpp"

namespace touchstone::tests {

/// The folder that TOUCHSTONE_DATA names, by default ../shared/datasets beside the project; empty,
/// with a message, if it is missing.
[[nodiscard]] inline std::filesystem::path public_data_folder() {
  const char* const variable = std::getenv("TOUCHSTONE_DATA");  // NOLINT(concurrency-mt-unsafe)
  std::filesystem::path folder =
      variable != nullptr ? std::filesystem::path(variable)
                          : std::filesystem::path(tests::source_folder()) / "../shared/datasets";
  if (std::filesystem::exists(folder)) return folder;
  std::printf("MISSING public data: %s (set TOUCHSTONE_DATA)\n", folder.string().c_str());
  return {};
}

/// All files of queries of the public data; empty if it, or its readers, are missing.
[[nodiscard]] inline std::vector<std::filesystem::path> public_datasets() {
#ifdef TOUCHSTONE_READERS
  const std::filesystem::path folder = public_data_folder();
  if (folder.empty()) return {};
  const std::array paths{folder / "handcrafted", folder / "simulation"};
  return verify::data::find_datasets(paths);
#else
  return {};
#endif
}

/// Calls visit(file, index, kind, query) for all queries of public_datasets(). \returns false if
/// there are none.
template <class Visit>
bool for_each_public_query([[maybe_unused]] const Visit& visit) {
  const auto files = public_datasets();
#ifdef TOUCHSTONE_READERS
  for (const auto& file : files) {
    const auto source = verify::data::open_dataset(file);
    while (const auto recorded = source->next()) {
      visit(file, recorded->index, source->kind().contact(), recorded->query.straight());
    }
  }
#endif
  return !files.empty();
}

}  // namespace touchstone::tests
