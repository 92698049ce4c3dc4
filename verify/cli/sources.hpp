#pragma once

/// \file
/// The inputs of a command: paths on the command line, or none, as sources of queries; frames of a mesh.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "verify/cli/files.hpp"
#include "verify/cli/options.hpp"
#include "verify/data/dataset_error.hpp"
#include "verify/data/query_source.hpp"
#include "verify/mesh/frames.hpp"

namespace touchstone::verify::cli {

/// The queries that the user named, and the cores to use on them.
struct SourceArguments {
  std::vector<std::filesystem::path> paths;
  std::string kind;
  bool round = false;
  bool keep_going = false;
  unsigned threads = 0;
  std::uint64_t seed = default_seed;
  std::uint64_t count = 1000;
  SeparationArguments separation = {};

  /// Without a path the queries are those of the built-in set.
  [[nodiscard]] bool built_in_set() const { return paths.empty(); }
};

/// Adds the options that fill the arguments; these must live until the command line is parsed.
void add_source_options(CLI::App& command, SourceArguments& arguments);

/// The callbacks of a command for its sources.
struct SourceHandlers {
  /// Of the progress bar over all sources.
  std::string title;
  /// Called with a source and with what to tell the fraction of it that is done.
  std::function<void(data::QuerySource&, const std::function<void(double)>&)> use;
  /// A path or file that could not be opened.
  std::function<void(const std::filesystem::path&, const data::DatasetError&)> fail;
  /// Is the rest to be left alone? Asked before each source and after each failure.
  std::function<bool()> stopped;
};

/// The separation of a source: the user's, or the one recorded with the source.
/// \throws DatasetError naming both if they contradict each other.
[[nodiscard]] Separation separation_for(const SourceArguments& arguments,
                                        const data::QuerySource& source);

/// Opens and hands over the sources one after the other: the families of the built-in set (of
/// that with a separation, if one is asked for), or the dataset files of all paths, each once.
/// Queries skipped with keep_going, and what a search of folders leaves out, are reported on
/// standard error. An interrupt ends it wherever it is.
/// \param files gets the datasets, with what accompanies them. \throws std::runtime_error as Files does.
void for_each_source(const SourceArguments& arguments, Files& files,
                     const SourceHandlers& handlers);

/// Opens the frames of a mesh, as mesh::open_frames does. \param record gets their files
[[nodiscard]] std::unique_ptr<mesh::Frames> open_frames(
    Files& record, std::span<const std::filesystem::path> paths);

}  // namespace touchstone::verify::cli
