#include "verify/solvers/plugin_method.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "touchstone/plugin.h"
#include "verify/base/deadline.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::solvers {
namespace {

static_assert(static_cast<int>(fast::Promise::none) == TOUCHSTONE_PROMISES_NOTHING &&
              static_cast<int>(fast::Promise::conservative) == TOUCHSTONE_PROMISES_CONSERVATIVE &&
              static_cast<int>(fast::Promise::exact) == TOUCHSTONE_PROMISES_EXACT);
static_assert(static_cast<int>(fast::Times::bounds) == TOUCHSTONE_TIMES_BOUNDS &&
              static_cast<int>(fast::Times::estimates) == TOUCHSTONE_TIMES_ESTIMATES &&
              static_cast<int>(fast::Times::none) == TOUCHSTONE_TIMES_NONE);
static_assert(static_cast<int>(Norm::linf) == TOUCHSTONE_LINF &&
              static_cast<int>(Norm::l2) == TOUCHSTONE_L2);
static_assert(static_cast<int>(fast::Verdict::no) == TOUCHSTONE_NO &&
              static_cast<int>(fast::Verdict::yes) == TOUCHSTONE_YES &&
              static_cast<int>(fast::Verdict::undecided) == TOUCHSTONE_UNDECIDED &&
              static_cast<int>(fast::Verdict::error) == TOUCHSTONE_ERROR);

struct CloseLibrary {
  void operator()(void* handle) const { ::dlclose(handle); }
};
using Library = std::unique_ptr<void, CloseLibrary>;

/// The system's description of the last failure, without the file's name at its front.
std::string loader_reason(const std::string& file) {
  const char* const text = ::dlerror();
  if (text == nullptr) return "unknown reason";
  const std::string reason = text, prefix = file + ": ";
  return reason.starts_with(prefix) ? reason.substr(prefix.size()) : reason;
}

/// The state of a file: it differs from that of another file of the same name, and changes with the
/// file.
std::string state_of(const std::filesystem::path& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return {};
  return fmt::format("{} {} {} {}.{:09}", file.st_dev, file.st_ino, file.st_size,
                     file.st_mtim.tv_sec, file.st_mtim.tv_nsec);
}

/// \pre the path is absolute. \param state of the file when the run began
Library open_library(const std::filesystem::path& path, const std::string& state) {
  const std::string& file = path.native();
  Library library(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) throw io::DatasetError(path, {}, "cannot load: " + loader_reason(file));
  if (state_of(path) != state) {
    throw io::DatasetError(path, {}, "has changed since it was loaded first");
  }
  return library;
}

template <class Function>
Function* find_function(const Library& library, const std::filesystem::path& path,
                        const char* name) {
  void* const address = ::dlsym(library.get(), name);
  if (address == nullptr) throw io::DatasetError(path, {}, std::string("defines no ") + name);
  return reinterpret_cast<Function*>(address);
}

/// Version 2 only added an option after the others, which a plugin of version 1 does not read.
constexpr std::int32_t oldest_version = 1;

void check_version(const Library& library, const std::filesystem::path& path) {
  const auto version = find_function<decltype(touchstone_plugin_version)>(
      library, path, "touchstone_plugin_version")();
  if (version >= oldest_version && version <= TOUCHSTONE_PLUGIN_VERSION) return;
  throw io::DatasetError(path, {},
                         "made for version " + std::to_string(version) +
                             " of the plugin interface, this program has version " +
                             std::to_string(TOUCHSTONE_PLUGIN_VERSION));
}

std::string read_name(const Library& library, const std::filesystem::path& path) {
  const char* const name =
      find_function<decltype(touchstone_plugin_name)>(library, path, "touchstone_plugin_name")();
  if (name == nullptr) throw io::DatasetError(path, {}, "has no name");
  constexpr std::size_t longest = 100;
  const std::string_view text(name, ::strnlen(name, longest + 1));
  if (text.size() > longest) {
    throw io::DatasetError(path, {}, fmt::format("name has more than {} bytes", longest));
  }
  if (text.empty() || !io::is_printable(text)) {
    throw io::DatasetError(path, {}, "name is not one line of text: " + io::quote(text));
  }
  if (find_info(text) != nullptr) {
    throw io::DatasetError(path, {}, fmt::format("name is that of a built-in solver: {}", text));
  }
  return std::string(text);
}

/// A promise and its terms.
struct Stated {
  fast::Promise promise = fast::Promise::conservative;
  fast::Terms terms = {};
};

Stated checked(const TouchstonePluginPromise& stated, const std::filesystem::path& path) {
  const auto require = [&](bool is_valid, const char* field) {
    if (!is_valid) {
      throw io::DatasetError(path, {},
                             std::string("touchstone_plugin_promise() sets ") + field +
                                 " out of range; touchstone/plugin.h names the values");
    }
  };
  const auto is_flag = [](std::int32_t value) { return value == 0 || value == 1; };
  require(
      stated.promise >= TOUCHSTONE_PROMISES_NOTHING && stated.promise <= TOUCHSTONE_PROMISES_EXACT,
      "promise");
  const auto& [contacts, cells] = std::tie(stated.kinds, stated.elements);
  require(std::ranges::all_of(contacts, is_flag) && std::ranges::all_of(cells, is_flag) &&
              contacts[0] + contacts[1] + cells[0] + cells[1] != 0,
          "kinds or elements");
  require(is_flag(stated.is_float), "is_float");
  require(stated.times >= TOUCHSTONE_TIMES_BOUNDS && stated.times <= TOUCHSTONE_TIMES_NONE,
          "times");
  require(std::isfinite(stated.starts_apart), "starts_apart");
  require(std::isfinite(stated.time_error) && stated.time_error >= 0.0, "time_error");
  Stated result{.promise = static_cast<fast::Promise>(stated.promise),
                .terms = {.contacts = {contacts[0] == 1, contacts[1] == 1},
                          .cells = {cells[0] == 1, cells[1] == 1},
                          .float_coordinates = stated.is_float == 1,
                          .times = static_cast<fast::Times>(stated.times),
                          .time_error = stated.time_error}};
  if (stated.starts_apart >= 0.0) result.terms.starts_apart = stated.starts_apart;
  return result;
}

/// Null if the library does not define it.
template <class Function>
Function* find_optional(const Library& library, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(library.get(), name));
}

/// The promise that the library states, before it is checked; the usual one if it has no function.
TouchstonePluginPromise read_promise(const Library& library) {
  TouchstonePluginPromise promise{.size = sizeof(TouchstonePluginPromise),
                                  .promise = TOUCHSTONE_PROMISES_CONSERVATIVE,
                                  .kinds = {1, 1},
                                  .is_float = 0,
                                  .times = TOUCHSTONE_TIMES_BOUNDS,
                                  .starts_apart = -1.0,
                                  .time_error = fast::Terms{}.time_error,
                                  .elements = {0, 0}};
  const auto state =
      find_optional<decltype(touchstone_plugin_promise)>(library, "touchstone_plugin_promise");
  if (state != nullptr) state(&promise);
  return promise;
}

/// The answer, with an error in place of an invalid verdict.
fast::Answer checked(const TouchstonePluginAnswer& answer) {
  if (answer.verdict < TOUCHSTONE_NO || answer.verdict > TOUCHSTONE_ERROR) {
    return {.verdict = fast::Verdict::error};
  }
  const auto verdict = static_cast<fast::Verdict>(answer.verdict);
  // Neither a NaN nor a negative number is a tolerance; no comparison holds for a NaN.
  const double tolerance = answer.tolerance >= 0.0 ? answer.tolerance : fast::Answer::none;
  if (verdict != fast::Verdict::yes) return {.verdict = verdict, .tolerance = tolerance};
  return {.verdict = verdict,
          .toi_lower = answer.toi_lower,
          .toi_upper = answer.toi_upper,
          .tolerance = tolerance};
}

/// Ends this process if it is a copy that the solver made of the process that was asked. The copy's
/// answers would overwrite those of the original.
class SameProcess {
 public:
  SameProcess() = default;
  SameProcess(const SameProcess&) = delete;
  SameProcess& operator=(const SameProcess&) = delete;
  SameProcess(SameProcess&&) = delete;
  SameProcess& operator=(SameProcess&&) = delete;
  ~SameProcess() {
    if (::getpid() != process_) ::_exit(0);
  }

 private:
  pid_t process_ = ::getpid();
};

/// The functions that solve; null for those that a library does not define.
struct Functions {
  decltype(touchstone_plugin_solve)* solve = nullptr;
  decltype(touchstone_plugin_solve_batch)* solve_batch = nullptr;
  decltype(touchstone_plugin_solve_curved)* solve_curved = nullptr;
};

/// \throws DatasetError if there is neither one for lines nor one for curves.
Functions find_functions(const Library& library, const std::filesystem::path& path) {
  Functions found{.solve_batch = find_optional<decltype(touchstone_plugin_solve_batch)>(
                      library, "touchstone_plugin_solve_batch"),
                  .solve_curved = find_optional<decltype(touchstone_plugin_solve_curved)>(
                      library, "touchstone_plugin_solve_curved")};
  constexpr const char* name = "touchstone_plugin_solve";
  using Solve = decltype(touchstone_plugin_solve);
  found.solve = found.solve_curved == nullptr ? find_function<Solve>(library, path, name)
                                              : find_optional<Solve>(library, name);
  return found;
}

static_assert(sizeof(Query) == 24 * sizeof(double) && greatest_degree == 8);

TouchstonePluginOptions plugin_options(const fast::MethodOptions& options) {
  return {.tolerance = options.tolerance,
          .max_checks = options.max_checks,
          .min_separation = options.separation.distance,
          .t_max = options.t_max,
          .norm = static_cast<std::int32_t>(options.separation.norm)};
}

constexpr TouchstonePluginAnswer unanswered{.verdict = TOUCHSTONE_ERROR,
                                            .toi_lower = fast::Answer::none,
                                            .toi_upper = fast::Answer::none,
                                            .tolerance = fast::Answer::none};

static_assert(AnyKind(ContactKind::edge_edge).number() == TOUCHSTONE_EDGE_EDGE &&
              AnyKind(cell_kinds.front()).number() == TOUCHSTONE_TETRAHEDRON);

class PluginMethod final : public fast::Method {
 public:
  PluginMethod(std::filesystem::path path, std::string state, std::string name,
               const Stated& stated, fast::MethodInfo known)
      : path_(std::move(path)),
        state_(std::move(state)),
        name_(std::move(name)),
        info_(std::move(known)) {
    info_.name = name_;
    info_.promise = stated.promise;
    info_.terms = stated.terms;
  }

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }

  void solve(const AnyQueries& queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& options) const override {
    std::call_once(is_loaded_, [this] {
      library_ = open_library(path_, state_);
      functions_ = find_functions(library_, path_);
    });
    if (queries.empty()) return;
    std::vector<TouchstonePluginAnswer> found(answers.size(), unanswered);
    ask(queries, plugin_options(options), found);
    std::ranges::transform(found, answers.begin(),
                           [](const TouchstonePluginAnswer& answer) { return checked(answer); });
  }

 private:
  void ask(const AnyQueries& queries, const TouchstonePluginOptions& options,
           std::span<TouchstonePluginAnswer> found) const {
    const SameProcess same;
    const auto kind = static_cast<std::int32_t>(queries.kind.number());
    if (queries.is_straight() && functions_.solve_batch != nullptr) {
      functions_.solve_batch(kind, std::ssize(found), queries.numbers.data(), &options,
                             found.data());
      return;
    }
    const bool as_lines = queries.is_straight() && functions_.solve != nullptr;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double* const numbers = queries.row(i).data();
      if (as_lines) {
        functions_.solve(kind, numbers, &options, &found[i]);
      } else {
        functions_.solve_curved(kind, static_cast<std::int32_t>(queries.degree),
                                queries.is_rational ? 1 : 0, numbers, &options, &found[i]);
        found[i].tolerance = fast::Answer::none;
      }
    }
  }

  std::filesystem::path path_;
  std::string state_;
  std::string name_;
  fast::MethodInfo info_;
  mutable std::once_flag is_loaded_;
  mutable Library library_;
  mutable Functions functions_;
};

// ---- In a child process -------------------------------------------------------------------------

// The child's messages: a word, followed by a text.
constexpr std::string_view calls = "calls ";    // the function that runs from now on
constexpr std::string_view named = "named ";    // the name: all is well
constexpr std::string_view refused = "error ";  // the reason why it is no plugin
constexpr std::string_view threw = "threw ";
constexpr std::string_view vowed = "vowed ";   // the bytes of the promise
constexpr std::string_view curves = "curves";  // it answers queries on curves

void tell(const ChildChannel& channel, std::string_view word, std::string_view text) {
  const std::string message = std::string(word) + std::string(text);
  static_cast<void>(channel.send(message.substr(0, ChildChannel::most_bytes)));
}

void load_and_ask(const std::filesystem::path& path, const ChildChannel& channel) {
  tell(channel, calls, "its constructors");
  Library library = open_library(path, state_of(path));
  tell(channel, calls, "touchstone_plugin_version()");
  check_version(library, path);
  tell(channel, calls, "touchstone_plugin_name()");
  const std::string name = read_name(library, path);
  tell(channel, calls, "touchstone_plugin_promise()");
  const TouchstonePluginPromise promise = read_promise(library);
  tell(channel, vowed, {reinterpret_cast<const char*>(&promise), sizeof promise});
  if (find_functions(library, path).solve_curved != nullptr) tell(channel, curves, "");
  // Its destructors need not run.
  static_cast<void>(library.release());
  tell(channel, named, name);
}

/// The work of the child: each of its possible ends has a message.
void describe(const std::filesystem::path& path, const ChildChannel& channel) {
  try {
    load_and_ask(path, channel);
  } catch (const io::DatasetError& error) {
    tell(channel, refused, error.reason());
  } catch (const std::exception& error) {
    tell(channel, threw, error.what());
  } catch (...) {
    tell(channel, threw, "not a std::exception");
  }
}

/// Loads the library in a child process.
class Loading {
 public:
  Loading(const std::filesystem::path& path, const std::filesystem::path& absolute,
          const PluginOptions& options)
      : path_(path),
        options_(options),
        child_([&absolute](const ChildChannel& channel) { describe(absolute, channel); },
               options.limits, folder_.path()) {}

  /// The library's name. \throws DatasetError as load_plugin does.
  std::string name() {
    using Event = ChildProcess::Event;
    const Clock::time_point start = Clock::now();
    constexpr ChildProcess::Seconds often(0.25);
    std::string message;
    CapturedOutput ignored;
    for (;;) {
      const Event event = child_.wait(often, message, ignored);
      if (event == Event::ended) fail(child_.end(ignored).failure);
      if (event == Event::message) {
        if (auto name = read(message)) return std::move(*name);
      }
      if (base::is_stopped(options_.stop)) throw io::Interrupted();
      const ChildProcess::Seconds passed = Clock::now() - start;
      if (passed.count() > options_.load_seconds) fail({.kind = judge::Fault::hang});
    }
  }

  /// Its promise, under the terms of the options. \pre name() has returned.
  [[nodiscard]] Stated stated() const {
    Stated result = stated_;
    result.terms = changed(result.terms, options_.terms);
    // The numbers of curves are not rounded for it.
    if (answers_curves_ && !result.terms.float_coordinates) {
      result.terms.most_degree = greatest_degree;
      result.terms.rational = true;
    }
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// The name, if the message tells it.
  std::optional<std::string> read(const std::string& message) {
    const auto is_about = [&](std::string_view word) { return message.starts_with(word); };
    const std::string text = message.substr(std::min(message.size(), calls.size()));
    if (is_about(named)) return text;
    if (is_about(vowed)) {
      TouchstonePluginPromise promise{};
      std::memcpy(&promise, text.data(), std::min(sizeof promise, text.size()));
      stated_ = checked(promise, path_);
    }
    if (is_about(curves)) answers_curves_ = true;
    if (is_about(refused)) throw io::DatasetError(path_, {}, text);
    if (is_about(threw)) fail({.kind = judge::Fault::exception, .what = text});
    if (is_about(calls)) at_ = text;
    return std::nullopt;
  }

  [[noreturn]] void fail(const judge::Failure& failure) const {
    std::string reason = to_text(failure);
    if (failure.kind == judge::Fault::hang) {
      reason +=
          fmt::format(" for {} s; a greater --query-limit allows more", options_.load_seconds);
    }
    throw io::DatasetError(path_, {}, "cannot load: " + at_ + ": " + reason);
  }

  const std::filesystem::path& path_;
  const PluginOptions& options_;
  TemporaryFolder folder_;
  ChildProcess child_;
  std::string at_ = "before its constructors";
  Stated stated_;
  bool answers_curves_ = false;
};
static_assert(calls.size() == named.size() && named.size() == refused.size() &&
              refused.size() == threw.size() && threw.size() == vowed.size());

}  // namespace

fast::Terms changed(fast::Terms terms, const TermsChanges& changes) {
  if (!changes.kinds.empty()) {
    terms.contacts = {};
    terms.cells = {};
    for (const AnyKind kind : changes.kinds) terms.add(kind);
  }
  if (changes.starts_apart) terms.starts_apart = changes.starts_apart;
  terms.float_coordinates = changes.float_coordinates.value_or(terms.float_coordinates);
  terms.times = changes.times.value_or(terms.times);
  terms.time_error = changes.time_error.value_or(terms.time_error);
  return terms;
}

std::unique_ptr<fast::Method> load_plugin(const std::filesystem::path& library,
                                          const PluginOptions& options) {
  // A child works in another folder.
  std::filesystem::path absolute = std::filesystem::absolute(library);
  std::string state = state_of(absolute);
  Loading loading(library, absolute, options);
  std::string name = loading.name();
  return std::make_unique<PluginMethod>(std::move(absolute), std::move(state), std::move(name),
                                        loading.stated(), options.known);
}

}  // namespace touchstone::verify::solvers
