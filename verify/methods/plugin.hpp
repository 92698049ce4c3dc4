#pragma once

/// \file
/// Anyone's solver as a Method: a shared library that speaks the interface of verify/plugin.h.
///
/// What a library answers is checked here, so that no judge sees an answer that is none. What it
/// does to the process is not: whoever judges a plugin calls it through solve_isolated().

#include <filesystem>
#include <memory>

#include "fast/method.hpp"

namespace touchstone::verify {

struct PluginOptions {
  /// What the library is held to; the interface has no way to say it.
  fast::Promise promise = fast::Promise::conservative;
};

/// Loads a plugin. A path without a slash is a file in the working directory: no search takes
/// place. The library stays loaded as long as the method lives.
///
/// The method's name is what the library calls itself. It answers Verdict::error where the library
/// throws a C++ exception, gives a verdict that is none, or says yes with an infinite time of
/// impact. Times of impact with any other verdict than yes are dropped, and so is a tolerance that
/// is none (negative or NaN).
/// \throws DatasetError naming the file and the reason if it cannot be loaded, lacks a function, is
/// made for a version of the interface that this program does not know, or has no printable name.
[[nodiscard]] std::unique_ptr<fast::Method> load_plugin(const std::filesystem::path& library,
                                                        const PluginOptions& options = {});

}  // namespace touchstone::verify
