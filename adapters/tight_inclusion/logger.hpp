#pragma once

/// \file
/// The logger of Tight-Inclusion's `tight_inclusion/logger.hpp`, for programs that write to it; the
/// adapter does not. The program finds and links spdlog itself.

#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

namespace ticcd {

namespace touchstone_adapter {

inline std::shared_ptr<spdlog::logger>& shared_logger() {
  static std::shared_ptr<spdlog::logger> logger = spdlog::default_logger()->clone("ticcd");
  return logger;
}

}  // namespace touchstone_adapter

inline spdlog::logger& logger() { return *touchstone_adapter::shared_logger(); }

/// Replaces the logger; not while other threads use it.
inline void set_logger(std::shared_ptr<spdlog::logger> logger) {
  touchstone_adapter::shared_logger() = std::move(logger);
}

}  // namespace ticcd
