#include "verify/cli/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <utility>

#include "touchstone/any_kind.hpp"
#include "touchstone/broad_phase.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/mesh/groups.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

/// A source that is not open yet.
struct Unopened {
  fs::path name;
  std::function<std::unique_ptr<data::QuerySource>()> open;
};

/// The families of the built-in set, with the kinds that they have, of the shard.
std::vector<Unopened> built_in_sources(const SourceArguments& arguments) {
  const Separation separation = arguments.separation.given();
  const std::vector<AnyKind> kinds = kinds_of(arguments.kind);
  for (const AnyKind kind : kinds) require_kind(*arguments.command, kind);
  std::vector<Unopened> sources;
  std::size_t number = 0;
  for (const generate::Family& family : generate::families(separation, arguments.degrees)) {
    for (const AnyKind kind : kinds) {
      if (!generate::supports(family, kind) || !arguments.shard.contains(number++)) continue;
      sources.push_back({family.name, [=, &arguments] {
                           return generate::open_family(family, kind, arguments.seed,
                                                        arguments.count, separation);
                         }});
    }
  }
  if (number == 0) refuse_kind(arguments.kind);
  return sources;
}

/// The dataset files of all paths, each once, those of the shard; empty if stopped.
std::vector<fs::path> find_files(const SourceArguments& arguments, Files& record,
                                 const SourceHandlers& handlers) {
  static constexpr std::size_t most_named = 8;
  std::size_t left_out = 0;
  const data::LeftOut on_left_out = [&](const io::DatasetError& error) {
    if (++left_out <= most_named) report_warning(error.what());
  };
  std::vector<fs::path> files;
  std::set<fs::path> seen;
  for (const fs::path& path : arguments.paths) {
    try {
      for (const fs::path& file : data::find_datasets({&path, 1}, on_left_out)) {
        record.add_dataset(file);
        if (!seen.insert(fs::weakly_canonical(file)).second) continue;
        if (arguments.shard.contains(seen.size() - 1)) files.push_back(file);
      }
    } catch (const io::DatasetError& error) {
      handlers.fail(path, error);
      if (handlers.stopped()) return {};
    }
  }
  if (left_out > most_named)
    report_warning(fmt::format("left out: {} more", left_out - most_named));
  return files;
}

std::vector<Unopened> dataset_files(const SourceArguments& arguments, Files& record,
                                    const SourceHandlers& handlers) {
  data::DatasetOptions options;
  if (!arguments.kind.empty()) options.kind = kind_from_string(arguments.kind);
  options.round = arguments.round;
  options.keep_going = arguments.keep_going;
  options.on_skip = [](const io::DatasetError& error) { report_error(error.what()); };
  const std::vector<fs::path> files = find_files(arguments, record, handlers);
  require_kinds(*arguments.command, files, options.kind);
  std::vector<Unopened> sources;
  sources.reserve(files.size());
  for (const fs::path& file : files) {
    sources.push_back({file, [=] { return data::open_dataset(file, options); }});
  }
  return sources;
}

}  // namespace

void refuse_kind(const std::string& kind) {
  throw std::invalid_argument(
      "no chosen family has " + (kind.empty() ? "vertex-face or edge-edge" : kind) +
      " queries: name another --kind, or other families (cells are on straight lines alone)");
}

std::vector<AnyKind> kinds_of(const std::string& option) {
  if (option.empty()) return {contact_kinds.begin(), contact_kinds.end()};
  return {kind_from_string(option)};
}

void require_kinds(const Command& command, std::span<const fs::path> files,
                   std::optional<AnyKind> kind) {
  for (const fs::path& file : files) {
    try {
      require_kind(command, kind ? *kind : data::kind_from_path(file), file);
    } catch (const io::DatasetError&) {
      // Reported when it is opened, or its contents tell.
    }
  }
}

void add_path_options(Command& command, SourceArguments& arguments) {
  arguments.command = &command;
  begin_group(command, "Input");
  add_option(command, "PATH", arguments.paths);
  add_option(command, "--kind", arguments.kind);
  add_option(command, "--round", arguments.round);
  add_option(command, "--keep-going", arguments.keep_going);
  add_option(command, "--threads", arguments.threads);
  add_option(command, "--seed", arguments.seed);
}

void add_source_options(Command& command, SourceArguments& arguments) {
  add_path_options(command, arguments);
  add_option(command, "--count", arguments.count);
  add_option(command, "--degree", arguments.degrees);
  add_separation_options(command, arguments.separation);
}

Separation separation_for(const SourceArguments& arguments, const data::QuerySource& source) {
  try {
    const Separation settled = arguments.separation.settle(source.recorded_separation());
    if (is_zero(settled) || !source.kind().is_cell()) return settled;
    throw std::invalid_argument("its separation.json has a distance, which cells have not");
  } catch (const std::invalid_argument& error) {
    throw io::DatasetError(source.name(), {}, error.what());
  }
}

void require_same_separation(const fs::path& folder, const Separation& separation) {
  const Separation recorded = data::recorded_separation(folder / "any");
  const auto may_be_dataset = [](const fs::directory_entry& entry) {
    const fs::path extension = entry.path().extension();
    return entry.is_directory() || extension == ".csv" || extension == ".npy";
  };
  const bool is_free =
      is_zero(recorded) &&
      (!fs::exists(folder) || std::ranges::none_of(fs::directory_iterator(folder), may_be_dataset));
  if (is_free || judge::same_separation(recorded, separation)) return;
  throw std::runtime_error(
      fmt::format("{}: is for a minimum separation of {}, not {}; choose another folder",
                  folder.string(), judge::to_text(recorded), judge::to_text(separation)));
}

void for_each_source(const SourceArguments& arguments, Files& files,
                     const SourceHandlers& handlers) {
  until_interrupted([&] {
    const std::vector<Unopened> sources = arguments.built_in_set()
                                              ? built_in_sources(arguments)
                                              : dataset_files(arguments, files, handlers);
    io::ProgressBar bar(handlers.title);
    for (std::size_t i = 0; i < sources.size() && !handlers.stopped(); ++i) {
      if (handlers.begin) handlers.begin(sources.size() - i);
      try {
        handlers.use(*sources[i].open(), [&](double fraction) {
          bar.update((static_cast<double>(i) + fraction) / static_cast<double>(sources.size()));
        });
      } catch (const io::DatasetError& error) {
        handlers.fail(sources[i].name, error);
      }
    }
  });
}

void until_stopped(Files& files, const std::function<bool()>& has_results,
                   const std::function<void()>& work) {
  until_interrupted([&] {
    try {
      work();
    } catch (const fast::Stopped&) {
      throw;
    } catch (const io::Interrupted&) {
      throw;
    } catch (const std::exception& error) {
      if (!has_results()) throw;
      report_error(error.what());
      files.note_failure();
    }
  });
}

Status status_of_queries(const SourceArguments& arguments, std::uint64_t queries) {
  if (queries != 0 || arguments.is_part() || io::interrupted()) return Status::all_well;
  report_error(arguments.built_in_set()
                   ? "no query was asked"
                   : arguments.paths.front().string() + ": no query: nothing was asked");
  return Status::bad_input;
}

data::QueryGroup& group_of(std::vector<data::QueryGroup>& groups, const std::string& path,
                           const AnyShape& shape) {
  const auto known = std::ranges::find(groups, shape, &data::QueryGroup::shape);
  if (known != groups.end()) return *known;
  std::string name = path;
  if (!shape.is_straight()) {
    name += fmt::format("{}, degree {}", shape.is_rational ? ", rational" : "", shape.degree);
  }
  return groups.emplace_back(std::move(name), shape);
}

void until_interrupted(const std::function<void()>& work) {
  try {
    work();
  } catch (const fast::Stopped&) {
  } catch (const io::Interrupted&) {
  }
}

std::vector<fs::path> frame_files(std::span<const fs::path> paths) {
  std::vector<fs::path> others;
  std::vector<fs::path> files = mesh::frame_files(paths, &others);
  if (!others.empty()) {
    report_warning(fmt::format("{}: left out, as they are no .ply or .obj files: {}, among them {}",
                               paths.front().string(), others.size(),
                               std::ranges::min(others).filename().string()));
  }
  return files;
}

std::unique_ptr<mesh::Frames> open_frames(Files& record, std::span<const fs::path> paths) {
  std::vector<fs::path> files = frame_files(paths);
  record.add_inputs(files);
  const fs::path first = files.front();
  auto frames = mesh::open_frames(std::move(files));
  report_note(first, frames->mesh().note);
  return frames;
}

void report_note(const fs::path& mesh, const std::string& note) {
  if (!note.empty()) report_warning(mesh.string() + ": " + note);
}

namespace {

/// The groups if they are needed: empty if all can collide, and vertices are not welded.
mesh::Groups groups_for(Files& files, const GroupArguments& arguments, const mesh::Mesh& mesh,
                        bool is_welded) {
  if (!arguments.file.empty()) {
    files.add_input(arguments.file);
    return mesh::read_groups(arguments.file, static_cast<std::size_t>(mesh.vertices.rows()));
  }
  if (arguments.is_empty() && !is_welded) return {};
  if (!mesh.groups.error.empty()) {
    throw std::runtime_error(mesh.groups.error + "; --groups FILE names one for each vertex");
  }
  if (mesh.groups.names.empty() && !arguments.is_empty()) {
    const std::string option = !arguments.apart.empty()        ? "--apart"
                               : !arguments.radii_file.empty() ? "--radii"
                                                               : "--separations";
    throw std::runtime_error(
        option + " needs groups: from names (o, g) in an OBJ file, or by --groups FILE");
  }
  return mesh.groups;
}

}  // namespace

NamedGroups collision_groups(Files& files, const GroupArguments& arguments, const mesh::Mesh& mesh,
                             Norm norm, bool is_welded) {
  mesh::Groups groups = groups_for(files, arguments, mesh, is_welded);
  fast::CollisionGroups result{.of_vertices = groups.of_vertex,
                               .apart = mesh::numbers_of(groups, arguments.apart)};
  if (!arguments.radii_file.empty()) {
    if (norm != Norm::l2) {
      throw std::invalid_argument(
          "--radii are those of spheres, in l2: leave --norm linf out, or name the distances of "
          "pairs in --separations");
    }
    files.add_input(arguments.radii_file);
    result.radii = mesh::read_radii(arguments.radii_file, groups);
  }
  if (!arguments.separations_file.empty()) {
    files.add_input(arguments.separations_file);
    result.separations = mesh::read_separations(arguments.separations_file, groups);
  }
  return {std::move(result), std::move(groups.names)};
}

void add_thickness_options(Command& command, GroupArguments& arguments) {
  add_option(command, "--radii", arguments.radii_file);
  add_option(command, "--separations", arguments.separations_file);
}

void add_group_options(Command& command, GroupArguments& arguments) {
  add_option(command, "--groups", arguments.file);
  add_option(command, "--apart", arguments.apart);
}

}  // namespace touchstone::verify::cli
