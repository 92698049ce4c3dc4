#pragma once

/// \file
/// The inputs of a command: sources of queries from paths or the built-in set, and frames of
/// a mesh.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "touchstone/step.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/options.hpp"
#include "verify/data/query_group.hpp"
#include "verify/data/query_source.hpp"
#include "verify/generate/families.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/mesh/frames.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::cli {

/// Part `index` of `count` of a list, from 0 on.
struct Shard {
  std::size_t index = 0;
  std::size_t count = 1;

  [[nodiscard]] bool contains(std::size_t number) const { return number % count == index; }
};

/// The queries of the command line, and the number of cores.
struct SourceArguments {
  const Command* command = nullptr;  ///< whose arguments these are
  std::vector<std::filesystem::path> paths;
  std::string kind;
  bool round = false;
  bool keep_going = false;
  unsigned threads = 0;
  std::uint64_t seed = default_seed;
  std::uint64_t count = 1000;
  std::vector<std::string> degrees = {"1"};  ///< of the built-in set (generate::families)
  SeparationArguments separation = {};
  /// The part of the sources that is used.
  Shard shard = {};
  /// The record of the part, as JSON (sharded_run.hpp); empty if the run is no part.
  std::string shard_record = {};

  /// Without a path the built-in set is used.
  [[nodiscard]] bool built_in_set() const { return paths.empty(); }
  [[nodiscard]] bool is_part() const { return !shard_record.empty(); }
};

/// \throws std::invalid_argument, as no family of the built-in set is left for this kind.
[[noreturn]] void refuse_kind(const std::string& kind);

/// The kinds that --kind asks for: without it, those about contact.
[[nodiscard]] std::vector<AnyKind> kinds_of(const std::string& option);

/// \throws std::invalid_argument as require_kind, if it is thrown for a file of this kind, which by
/// default its path tells.
void require_kinds(const Command& command, std::span<const std::filesystem::path> files,
                   std::optional<AnyKind> kind);

/// Adds PATH, --kind, --round, --keep-going, --threads and --seed; the arguments must live until
/// the command line is parsed.
void add_path_options(Command& command, SourceArguments& arguments);

/// Adds these and the others that fill the arguments.
void add_source_options(Command& command, SourceArguments& arguments);

/// The callbacks of a command for its sources.
struct SourceHandlers {
  /// The title of the progress bar over all sources.
  std::string title;
  /// Called with a source and with a function that reports its completed fraction.
  std::function<void(data::QuerySource&, const std::function<void(double)>&)> use;
  /// Called with a path or file that could not be opened.
  std::function<void(const std::filesystem::path&, const io::DatasetError&)> fail;
  /// True to skip the rest; called before each source and after each failure.
  std::function<bool()> stopped;
  /// Called before each source with the number of those that are left, this one included; may be
  /// null.
  std::function<void(std::size_t)> begin = nullptr;
};

/// The separation of a source: from the options, or recorded with the source.
/// \throws DatasetError naming both if they contradict each other, or if cells have one.
[[nodiscard]] Separation separation_for(const SourceArguments& arguments,
                                        const data::QuerySource& source);

/// \throws std::runtime_error if the folder, which queries are to be written to, has some for
/// another separation.
void require_same_separation(const std::filesystem::path& folder, const Separation& separation);

/// Opens the sources in order and passes them on: the families of the built-in set (for the
/// separation, if one is requested), or the dataset files of all paths, each once. Queries skipped
/// with keep_going, and files that a search of folders skips, are reported on standard error. An
/// interrupt ends it at any point.
/// \throws std::invalid_argument before any work as require_kind.
/// \param files records the datasets and their companions. \throws std::runtime_error as Files.
void for_each_source(const SourceArguments& arguments, Files& files,
                     const SourceHandlers& handlers);

/// The group of that shape among those of a path, added if there is none yet. On curves its name
/// ends in their degree.
[[nodiscard]] data::QueryGroup& group_of(std::vector<data::QueryGroup>& groups,
                                         const std::string& path, const AnyShape& shape);

/// Works until an interrupt, after which the command goes on with the results so far.
void until_interrupted(const std::function<void()>& work);

/// The same until an error, too, which is reported and noted; it is thrown if there are no results.
void until_stopped(Files& files, const std::function<bool()>& has_results,
                   const std::function<void()>& work);

/// The status of a run that found nothing wrong, by its number of queries: bad_input, which is
/// reported, if there was none, unless the run is a part of others or was interrupted.
[[nodiscard]] Status status_of_queries(const SourceArguments& arguments, std::uint64_t queries);

/// The files of frames, as mesh::frame_files. Reports the other entries of a folder.
[[nodiscard]] std::vector<std::filesystem::path> frame_files(
    std::span<const std::filesystem::path> paths);

/// Reports the parts of a mesh's file that were ignored or changed.
void report_note(const std::filesystem::path& mesh, const std::string& note);

/// Opens the frames of a mesh, as mesh::open_frames, and reports the parts that are not read.
/// \param record records their files
[[nodiscard]] std::unique_ptr<mesh::Frames> open_frames(
    Files& record, std::span<const std::filesystem::path> paths);

// Collision groups on the command line: --groups and --apart, --radii and --separations.

struct GroupArguments {
  std::string file;
  /// Pairs of names of groups between which collisions are ignored.
  std::vector<std::pair<std::string, std::string>> apart;
  std::string radii_file;
  std::string separations_file;

  [[nodiscard]] bool is_empty() const {
    return file.empty() && apart.empty() && radii_file.empty() && separations_file.empty();
  }
};

/// Adds --radii and --separations, the thickness of groups. As below.
void add_thickness_options(Command& command, GroupArguments& arguments);

/// Adds --groups and --apart. The arguments must live until the command line is parsed.
void add_group_options(Command& command, GroupArguments& arguments);

/// The requested groups of a mesh, by their numbers.
struct NamedGroups {
  fast::CollisionGroups rules;
  std::vector<std::string> names;
};

/// \param files records the input files
/// \param norm Of the separation: radii need l2.
/// \param is_welded True if the mesh's own groups are needed also without these arguments.
/// \throws std::runtime_error, std::invalid_argument or DatasetError if they cannot be used.
[[nodiscard]] NamedGroups collision_groups(Files& files, const GroupArguments& arguments,
                                           const mesh::Mesh& mesh, Norm norm = Norm::l2,
                                           bool is_welded = false);

}  // namespace touchstone::verify::cli
