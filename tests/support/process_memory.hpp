#pragma once

/// \file
/// The memory of the test's process.

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace touchstone::tests {

/// In bytes.
struct ProcessMemory {
  std::uint64_t address_space, resident;
};

inline ProcessMemory process_memory() {
  ProcessMemory pages{};
  std::ifstream("/proc/self/statm") >> pages.address_space >> pages.resident;
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {.address_space = pages.address_space * page, .resident = pages.resident * page};
}

}  // namespace touchstone::tests
