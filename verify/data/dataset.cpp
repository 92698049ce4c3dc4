#include "verify/data/dataset.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <deque>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "verify/data/csv_dataset.hpp"
#include "verify/data/npy_dataset.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {
namespace {

namespace fs = std::filesystem;

bool is_ground_truth_folder(const fs::path& path) {
  static constexpr std::array<std::string_view, 4> names{"toi", "mma_bool", "boxes", "frames"};
  return std::find(names.begin(), names.end(), path.filename().string()) != names.end();
}

bool is_dataset_name(const fs::path& path) {
  const std::string name = path.filename().string();
  const bool is_csv = name.ends_with(".csv") || name.ends_with(".csv.zst");
  return path.extension() == ".npy" || (is_csv && !dataset_stem(path).ends_with("_toi"));
}

bool is_ground_truth_name(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.ends_with("_toi.csv") || name.ends_with("_mma_bool.json") ||
         name == "separation.json";
}

/// The search of a folder and all below it. Links to folders are followed after all other folders
/// have been searched, and no folder is searched twice: a file keeps its plain path, and a ring of
/// links ends.
class Search {
 public:
  explicit Search(const LeftOut& on_left_out) : on_left_out_(on_left_out) {}

  [[nodiscard]] std::vector<fs::path> below(const fs::path& folder) {
    visit(folder, false);
    while (!links_.empty()) {
      const Link link = std::move(links_.front());
      links_.pop_front();
      visit(link.path, link.companions);
    }
    std::ranges::sort(found_);
    return std::move(found_);
  }

 private:
  struct Link {
    fs::path path;
    bool companions;  ///< it stands in a folder of companions
  };

  void visit(const fs::path& folder, bool companions) {
    if (!visited_.insert(fs::canonical(folder)).second) {
      leave_out(folder, "leads to a folder that was searched already");
      return;
    }
    std::vector<fs::directory_entry> entries;
    std::ranges::copy(fs::directory_iterator(folder), std::back_inserter(entries));
    std::ranges::sort(entries);
    for (const fs::directory_entry& entry : entries) take(entry, companions);
  }

  void take(const fs::directory_entry& entry, bool companions) {
    std::error_code error;
    const fs::file_type type = entry.status(error).type();
    if (type == fs::file_type::directory) {
      take_folder(entry, companions || is_ground_truth_folder(entry.path()));
    } else if (type == fs::file_type::regular) {
      take_file(entry.path(), companions);
    } else if (entry.is_symlink(error)) {
      leave_out(entry.path(), "a link that leads to no file or folder");
    } else {
      leave_out(entry.path(), "neither a file nor a folder");
    }
  }

  void take_folder(const fs::directory_entry& entry, bool companions) {
    if (entry.is_symlink()) {
      links_.push_back({entry.path(), companions});
    } else {
      visit(entry.path(), companions);
    }
  }

  void take_file(const fs::path& path, bool companions) {
    const bool is_dataset = is_dataset_name(path);
    if (is_dataset && !companions) {
      found_.push_back(path);
    } else if (is_dataset) {
      leave_out(path, "in a folder of companion files; name the file itself to read it");
    } else if (!companions && !is_ground_truth_name(path) && !io::is_partial(path)) {
      leave_out(path, "no dataset (.csv, .npy)");
    }
  }

  void leave_out(const fs::path& path, const std::string& reason) const {
    if (on_left_out_) on_left_out_(io::DatasetError(path, {}, "left out: " + reason));
  }

  const LeftOut& on_left_out_;
  std::vector<fs::path> found_;
  std::deque<Link> links_;
  std::set<fs::path> visited_;
};

std::vector<fs::path> datasets_below(const fs::path& folder, const LeftOut& on_left_out) {
  std::vector<fs::path> found;
  try {
    found = Search(on_left_out).below(folder);
  } catch (const fs::filesystem_error& error) {
    const fs::path& where = error.path1().empty() ? folder : error.path1();
    throw io::DatasetError(where, {}, "cannot read: " + error.code().message());
  }
  if (found.empty()) throw io::DatasetError(folder, {}, "no dataset (.csv, .npy) in this folder");
  return found;
}

/// Bytes beyond ASCII belong to letters.
bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80U;
}

/// True if the text contains the word without an adjacent letter.
bool contains_word(std::string_view text, std::string_view word) {
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string_view::npos; ++at) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_letter(text[at - 1]);
    if (begins && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

/// The kind that the deepest part with a kind names.
std::optional<AnyKind> kind_from_parts(const fs::path& path) {
  std::optional<AnyKind> kind;
  for (const fs::path& part : path) {
    const std::string name = part.string();
    std::vector<AnyKind> named;
    std::ranges::copy_if(all_kinds, std::back_inserter(named),
                         [&](AnyKind one) { return contains_word(name, to_string(one)); });
    if (named.size() > 1) {
      throw io::DatasetError(path, {}, io::quote(name) + " names several kinds; pass --kind");
    }
    if (!named.empty()) kind = named.front();
  }
  return kind;
}

/// True if a file's name without extension ends in this, by itself ("ee"), after a number ("326ee")
/// or after a separator ("x_ee", "x-326ee"). "tree" does not.
bool ends_in_word(std::string_view stem, std::string_view ending) {
  if (!stem.ends_with(ending)) return false;
  stem.remove_suffix(ending.size());
  const std::size_t last = stem.find_last_not_of("0123456789");
  return last == std::string_view::npos || !is_letter(stem[last]);
}

}  // namespace

std::vector<fs::path> find_datasets(std::span<const fs::path> paths, const LeftOut& on_left_out) {
  std::vector<fs::path> found;
  for (const fs::path& path : paths) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found)
      throw io::DatasetError(path, {}, "does not exist");
    if (error) throw io::DatasetError(path, {}, "cannot read: " + error.message());
    if (status.type() == fs::file_type::directory) {
      const std::vector<fs::path> below = datasets_below(path, on_left_out);
      found.insert(found.end(), below.begin(), below.end());
    } else {
      found.push_back(path);
    }
  }
  return found;
}

AnyKind kind_from_path(const fs::path& path) {
  if (const auto kind = kind_from_parts(path)) return *kind;
  const std::string stem = dataset_stem(path);
  if (ends_in_word(stem, "vf")) return ContactKind::vertex_face;
  if (ends_in_word(stem, "ee")) return ContactKind::edge_edge;
  if (const auto kind = kind_from_parts(fs::absolute(path).lexically_normal())) return *kind;
  throw io::DatasetError(path, {},
                         "the path does not say whether its queries are vertex-face or edge-edge; "
                         "pass --kind vertex-face or --kind edge-edge");
}

std::unique_ptr<QuerySource> open_dataset(const fs::path& path, const DatasetOptions& options) {
  const fs::path extension = path.extension();
  if (extension == ".csv" || path.string().ends_with(".csv.zst"))
    return std::make_unique<CsvDataset>(path, options);
  if (extension == ".npy" || extension == ".npz")
    return std::make_unique<NpyDataset>(path, options);
  throw io::DatasetError(path, {},
                         "unknown format: only .csv, .csv.zst, .npy and .npz are datasets");
}

}  // namespace touchstone::verify::data
