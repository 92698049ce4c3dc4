#include "verify/methods/plugin.hpp"

#include <dlfcn.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "verify/dataset/dataset_error.hpp"
#include "verify/plugin.h"
#include "verify/printable.hpp"

namespace touchstone::verify {
namespace {

static_assert(static_cast<int>(Kind::vertex_face) == touchstone_vertex_face &&
              static_cast<int>(Kind::edge_edge) == touchstone_edge_edge);
static_assert(static_cast<int>(Norm::linf) == touchstone_linf &&
              static_cast<int>(Norm::l2) == touchstone_l2);
static_assert(static_cast<int>(fast::Verdict::no) == touchstone_no &&
              static_cast<int>(fast::Verdict::yes) == touchstone_yes &&
              static_cast<int>(fast::Verdict::undecided) == touchstone_undecided &&
              static_cast<int>(fast::Verdict::error) == touchstone_error);

struct CloseLibrary {
  void operator()(void* handle) const { ::dlclose(handle); }
};
using Library = std::unique_ptr<void, CloseLibrary>;

/// What the system says of the last failure, without the file's name that it puts in front.
std::string loader_reason(const std::string& file) {
  const char* const text = ::dlerror();
  if (text == nullptr) return "unknown reason";
  const std::string reason = text, prefix = file + ": ";
  return reason.starts_with(prefix) ? reason.substr(prefix.size()) : reason;
}

Library open_library(const std::filesystem::path& path) {
  const std::string file = path.has_parent_path() ? path.string() : "./" + path.string();
  Library library(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) throw DatasetError(path, {}, "cannot load: " + loader_reason(file));
  return library;
}

template <class Function>
Function* find_function(const Library& library, const std::filesystem::path& path,
                        const char* name) {
  void* const address = ::dlsym(library.get(), name);
  if (address == nullptr) throw DatasetError(path, {}, std::string("defines no ") + name);
  return reinterpret_cast<Function*>(address);
}

/// Version 2 only added an option behind the others, so a plugin of version 1 reads what it knows.
constexpr std::int32_t oldest_version = 1;

void check_version(const Library& library, const std::filesystem::path& path) {
  const auto version = find_function<decltype(touchstone_plugin_version)>(
      library, path, "touchstone_plugin_version")();
  if (version >= oldest_version && version <= touchstone_interface_version) return;
  throw DatasetError(path, {},
                     "made for version " + std::to_string(version) +
                         " of the plugin interface, this program has version " +
                         std::to_string(touchstone_interface_version));
}

std::string read_name(const Library& library, const std::filesystem::path& path) {
  const char* const name =
      find_function<decltype(touchstone_plugin_name)>(library, path, "touchstone_plugin_name")();
  if (name == nullptr) throw DatasetError(path, {}, "has no name");
  const std::string_view text = name;
  if (text.empty() || !is_printable(text)) {
    throw DatasetError(path, {}, "name is not one line of text: " + quote(text));
  }
  return std::string(text);
}

/// The answer with an error in place of what is none.
fast::Answer checked(const touchstone_answer& answer) {
  static constexpr fast::Answer error{.verdict = fast::Verdict::error};
  if (answer.verdict < touchstone_no || answer.verdict > touchstone_error) return error;
  const auto verdict = static_cast<fast::Verdict>(answer.verdict);
  // No comparison holds of a NaN: what is no tolerance becomes one.
  const double tolerance = answer.tolerance >= 0.0 ? answer.tolerance : fast::Answer::none;
  if (verdict != fast::Verdict::yes) return {.verdict = verdict, .tolerance = tolerance};
  if (std::isinf(answer.toi_lower) || std::isinf(answer.toi_upper)) return error;
  return {.verdict = verdict,
          .toi_lower = answer.toi_lower,
          .toi_upper = answer.toi_upper,
          .tolerance = tolerance};
}

class PluginMethod final : public fast::Method {
 public:
  PluginMethod(Library library, const std::filesystem::path& path, const PluginOptions& options)
      : library_(std::move(library)),
        name_(read_name(library_, path)),
        solve_(find_function<Solve>(library_, path, "touchstone_plugin_solve")),
        promise_(options.promise) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] fast::Promise promise() const override { return promise_; }

  void solve(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& options) const override {
    const touchstone_options plugin_options{.tolerance = options.tolerance,
                                            .max_checks = options.max_checks,
                                            .min_separation = options.min_separation,
                                            .t_max = options.t_max,
                                            .norm = static_cast<std::int32_t>(options.norm)};
    for (std::size_t i = 0; i < queries.size(); ++i) {
      answers[i] = ask(kind, queries[i], plugin_options);
    }
  }

 private:
  using Solve = decltype(touchstone_plugin_solve);

  [[nodiscard]] fast::Answer ask(Kind kind, const Query& query,
                                 const touchstone_options& options) const {
    touchstone_answer answer{.verdict = touchstone_error,
                             .toi_lower = fast::Answer::none,
                             .toi_upper = fast::Answer::none,
                             .tolerance = fast::Answer::none};
    try {
      solve_(static_cast<std::int32_t>(kind), query.coordinates.data(), &options, &answer);
    } catch (...) {
      return {.verdict = fast::Verdict::error};
    }
    return checked(answer);
  }

  Library library_;
  std::string name_;
  Solve* solve_;
  fast::Promise promise_;
};

}  // namespace

std::unique_ptr<fast::Method> load_plugin(const std::filesystem::path& library,
                                          const PluginOptions& options) {
  Library loaded = open_library(library);
  check_version(loaded, library);
  return std::make_unique<PluginMethod>(std::move(loaded), library, options);
}

}  // namespace touchstone::verify
