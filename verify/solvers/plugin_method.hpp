#pragma once

/// \file
/// A plugin as a Method: a shared library with the interface of touchstone/plugin.h.
///
/// Loading and solving are for child processes (SolverProcess): one child asks the library for its
/// version and name, and solve() loads it into the process that first calls it. Answers are passed
/// on unchanged.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/solvers/child_process.hpp"

namespace touchstone::verify::solvers {

/// Terms in place of those that a solver states itself.
struct TermsChanges {
  std::vector<AnyKind> kinds = {};  ///< empty: as they are
  std::optional<double> starts_apart = std::nullopt;
  std::optional<bool> float_coordinates = std::nullopt;
  std::optional<fast::Times> times = std::nullopt;
  std::optional<double> time_error = std::nullopt;
};

/// The terms with the changes made.
[[nodiscard]] fast::Terms changed(fast::Terms terms, const TermsChanges& changes);

struct PluginOptions {
  /// Terms in place of those that the library states.
  TermsChanges terms = {};
  /// What the interface does not say: norms, tolerance and usual limit of checks.
  fast::MethodInfo known = {};
  /// Limits of the child process that asks for the name.
  ChildLimits limits = {};
  /// Wall-clock seconds that it may take.
  double load_seconds = 60.0;
  /// May be null. Once true, loading ends with an error.
  const std::atomic<bool>* stop = nullptr;
};

/// Loads a plugin, in a child process. A path without a slash is a file in the working directory:
/// no search takes place.
///
/// The method has the name that the library gives, and the promise and terms that it states
/// (touchstone_plugin_promise); without a statement the promise is conservative. Curves are within
/// its terms if it has a function for them and takes doubles; that function is asked straight
/// lines, too, if there is no other, and its tolerances are dropped. solve() loads the library into
/// the process that calls it, where it stays as long as the method lives; it throws DatasetError if
/// the file has changed since: a run has one solver. Exceptions of the library pass through it; an
/// invalid verdict becomes Verdict::error. Times of impact with any other verdict than yes are
/// dropped, and so are invalid tolerances (negative or NaN); infinite times of impact are kept:
/// judge::failure_of() reports them.
/// \throws DatasetError that names the file and the reason if it cannot be loaded, lacks a
/// function, is made for a version of the interface that this program does not know, has no name or
/// one that is not printable, has more than 100 bytes or is that of a built-in solver, states a
/// promise out of range, or ends its process, throws or takes too long on the way; Interrupted if
/// the options' stop turns true; std::system_error if no process can be made.
[[nodiscard]] std::unique_ptr<fast::Method> load_plugin(const std::filesystem::path& library,
                                                        const PluginOptions& options = {});

}  // namespace touchstone::verify::solvers
