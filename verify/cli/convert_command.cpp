// touchstone convert: datasets of any format as a store.
//
// A store is a folder that every command reads as a dataset: shards of queries as .npy files below
// KIND/, their recorded labels and times of impact beside them as for every dataset
// (verify/data/ground_truth_files.hpp), and manifest.json, which has the size, digest, number of
// queries, kind and origin of each.

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/base/cores.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/data/npy.hpp"
#include "verify/data/store.hpp"
#include "verify/io/json.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::cli::convert_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> paths;
  std::string kind;
  bool round = false;
  bool keep_going = false;
  unsigned threads = 0;
  fs::path folder;
  std::uint64_t shard_size = 1'000'000;
  std::string source;
  std::string licence;
};

/// A file that is converted, and the name of its shards.
struct Origin {
  fs::path file;
  std::string name;
};

/// The file's name below the path that led to it, in one word without that of a kind.
std::string shard_name(const fs::path& file, const fs::path& path) {
  const fs::path inside = fs::is_directory(path) ? file.lexically_relative(path) : file.filename();
  std::string name;
  for (const fs::path& part : inside.parent_path()) {
    const auto is_part = [&](Kind kind) { return part == to_string(kind); };
    if (std::ranges::none_of(all_kinds, is_part)) name += part.string() + "_";
  }
  return name + data::dataset_stem(file);
}

/// A shard that is being written.
class StoredShard {
 public:
  StoredShard(const fs::path& folder, const std::string& name, const QueryShape& shape)
      : queries_file_(folder / (name + ".npy")),
        labels_file_(folder / "mma_bool" / (name + "_mma_bool.json")),
        tois_file_(folder / "toi" / (name + "_toi.csv")),
        queries_(queries_file_, shape) {}

  void write(const data::RecordedQuery& query) {
    queries_.write(query.query.numbers());
    if (query.collides)
      labels_ += fmt::format("{}{}", labelled_++ == 0 ? "" : ",", *query.collides);
    if (query.toi) {
      if (!tois_) {
        fs::create_directories(tois_file_.parent_path());
        tois_.emplace(tois_file_);
      }
      tois_->write(count_, *query.toi);
    }
    ++count_;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Completes the files, and returns them.
  std::vector<fs::path> close() {
    std::vector<fs::path> files{queries_file_};
    if (labelled_ != 0 && labelled_ != count_) {
      throw std::runtime_error(queries_file_.string() + ": only some of its queries have labels");
    }
    if (labelled_ != 0) {
      fs::create_directories(labels_file_.parent_path());
      io::OutputFile file(labels_file_);
      file.write("[" + labels_ + "]\n");
      file.close();
      files.push_back(labels_file_);
    }
    if (tois_) {
      tois_->close();
      files.push_back(tois_file_);
    }
    queries_.close();
    return files;
  }

 private:
  fs::path queries_file_, labels_file_, tois_file_;
  data::NpyWriter queries_;
  std::string labels_;
  std::uint64_t labelled_ = 0;
  std::optional<data::ToiWriter> tois_;
  std::uint64_t count_ = 0;
};

/// A run: the files in parallel, then the manifest.
class ConvertRun {
 public:
  explicit ConvertRun(const Arguments& arguments) : arguments_(arguments) {
    if (fs::exists(arguments.folder) && !fs::is_empty(arguments.folder)) {
      throw std::runtime_error(arguments.folder.string() + ": is not empty; choose another folder");
    }
    std::set<std::pair<std::string, Kind>> names;
    for (const fs::path& path : arguments.paths) {
      for (const fs::path& file : data::find_datasets({&path, 1})) {
        origins_.push_back({file, shard_name(file, path)});
        const Kind kind =
            arguments.kind.empty() ? data::kind_from_path(file) : kind_from_string(arguments.kind);
        if (!names.emplace(origins_.back().name, kind).second) {
          throw std::runtime_error(file.string() + ": another input has the name " +
                                   origins_.back().name + " too");
        }
      }
    }
    shards_.resize(origins_.size());
  }

  Status run() {
    require_one_separation();
    // A manifest without shards: until the end the folder is not a store.
    static_cast<void>(write_manifest());
    io::ProgressBar bar("convert");
    std::atomic<std::size_t> done = 0;
    oneapi::tbb::task_arena arena(base::cores_for(arguments_.threads));
    arena.execute([&] {
      oneapi::tbb::parallel_for(std::size_t{0}, origins_.size(), [&](std::size_t i) {
        if (io::interrupted() || (failed_ && !arguments_.keep_going)) return;
        try {
          shards_[i] = convert(origins_[i]);
        } catch (const std::exception& error) {
          fail(error.what());
        }
        const std::scoped_lock lock(mutex_);
        bar.update(static_cast<double>(++done) / static_cast<double>(origins_.size()));
      });
    });
    bar.clear();
    if (io::interrupted()) return Status::interrupted;
    if (failed_ && !arguments_.keep_going) return Status::bad_input;
    io::print(stdout, write_manifest());
    return failed_ ? Status::bad_input : Status::all_well;
  }

 private:
  void fail(const std::string& message) {
    const std::scoped_lock lock(mutex_);
    report_error(message);
    failed_ = true;
  }

  [[nodiscard]] data::DatasetOptions options() {
    data::DatasetOptions result;
    if (!arguments_.kind.empty()) result.kind = kind_from_string(arguments_.kind);
    result.round = arguments_.round;
    result.keep_going = arguments_.keep_going;
    result.on_skip = [this](const io::DatasetError& error) { fail(error.what()); };
    return result;
  }

  /// A store has one separation. \throws std::runtime_error for inputs of several.
  void require_one_separation() const {
    if (origins_.empty()) return;
    const Separation first = data::recorded_separation(origins_.front().file);
    for (const Origin& origin : origins_) {
      if (judge::same_separation(data::recorded_separation(origin.file), first)) continue;
      throw std::runtime_error(origin.file.string() + ": is for another minimum separation than " +
                               origins_.front().file.string() + "; convert them one by one");
    }
    fs::create_directories(arguments_.folder);
    if (!is_zero(first)) data::write_separation(arguments_.folder, first);
  }

  /// Writes the shards of a file, and returns their part of the manifest.
  nlohmann::json convert(const Origin& origin) {
    const auto source = data::open_dataset(origin.file, options());
    const fs::path folder = arguments_.folder / to_string(source->kind());
    fs::create_directories(folder);
    nlohmann::json result = nlohmann::json::array();
    std::optional<StoredShard> shard;
    std::uint64_t first = 0;
    const auto finish = [&] {
      const std::uint64_t count = shard->count();
      result.push_back(described(shard->close(), *source, first, count));
      shard.reset();
    };
    for (auto query = source->next(); query && !io::interrupted(); query = source->next()) {
      if (shard && shard->count() == arguments_.shard_size) finish();
      if (!shard) {
        shard.emplace(folder, fmt::format("{}-{:05}", origin.name, result.size()), source->shape());
        first = query->index;
      }
      shard->write(*query);
    }
    if (shard) finish();
    return result;
  }

  [[nodiscard]] nlohmann::json described(const std::vector<fs::path>& files,
                                         const data::QuerySource& source, std::uint64_t first,
                                         std::uint64_t count) const {
    nlohmann::json list = nlohmann::json::array();
    for (const fs::path& file : files) {
      list.push_back(data::described(file, file.lexically_relative(arguments_.folder).string()));
    }
    return {{"files", list},
            {"queries", count},
            {"kind", to_string(source.kind())},
            {"origin", source.name()},
            {"first", first}};
  }

  /// Writes the manifest of the shards that are done; returns a line about them.
  [[nodiscard]] std::string write_manifest() const {
    nlohmann::json shards = nlohmann::json::array();
    std::uint64_t queries = 0;
    for (const nlohmann::json& some : shards_) {
      for (const nlohmann::json& shard : some) {
        queries += shard.at("queries").get<std::uint64_t>();
        shards.push_back(shard);
      }
    }
    io::OutputFile file(arguments_.folder / data::manifest_name);
    file.write(io::json_document({{"format", data::store_format},
                                  {"program", version()},
                                  {"source", io::text_or_null(arguments_.source)},
                                  {"licence", io::text_or_null(arguments_.licence)},
                                  {"queries", queries},
                                  {"shards", shards}}));
    file.close();
    return fmt::format("{} queries in {} shards below {}\n", queries, shards.size(),
                       io::printable(arguments_.folder.string()));
  }

  const Arguments& arguments_;
  std::vector<Origin> origins_;
  std::vector<nlohmann::json> shards_;
  std::mutex mutex_;
  std::atomic<bool> failed_ = false;
};

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("convert", "Write datasets as a store of arrays, for large runs");
  command->option_defaults()->group("Input");
  add_option(*command, "PATH", arguments->paths);
  add_option(*command, "--kind", arguments->kind);
  add_option(*command, "--round", arguments->round);
  add_option(*command, "--keep-going", arguments->keep_going);
  add_option(*command, "--threads", arguments->threads);
  command->option_defaults()->group("Output");
  add_option(*command, "--out", arguments->folder);
  add_option(*command, "--shard-size", arguments->shard_size);
  add_option(*command, "--source", arguments->source);
  add_option(*command, "--licence", arguments->licence);
  set_help(*command, "touchstone convert data/handcrafted --out store --licence MIT",
           "Files are converted in parallel, in bounded memory. Labels and times of impact are "
           "written beside the shards. Every command reads the store as a dataset; manifest.json "
           "has the SHA-256 of each file.\n" +
               std::string(writing_statuses));
  command->callback([arguments, &status] { status = ConvertRun(*arguments).run(); });
}

}  // namespace touchstone::verify::cli::convert_command
