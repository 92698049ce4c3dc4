#pragma once

/// \file
/// A wrong answer as a self-contained C++ program, which the authors of a solver compile with
/// their own code.

#include <optional>
#include <string>
#include <string_view>

#include "verify/fuzz/reproduce.hpp"

namespace touchstone::verify::fuzz {

/// The interface with which such a program calls the solver.
enum class CallInterface : std::uint8_t {
  plugin,  ///< touchstone/plugin.h, of a loaded library
  // These know straight lines alone.
  ticcd,       ///< the public Tight-Inclusion: ticcd::vertexFaceCCD, edgeEdgeCCD
  ipc_toolkit  ///< the public IPC Toolkit: ipc::AdditiveCCD
};

/// "plugin", "ticcd" or "ipc-toolkit".
[[nodiscard]] std::string_view to_string(CallInterface interface);

/// The interface with that name, if there is one.
[[nodiscard]] std::optional<CallInterface> call_interface_from_string(std::string_view name);

/// The interface of the public code of a built-in method, if there is such code; otherwise that of
/// plugins.
[[nodiscard]] CallInterface usual_interface(const SolverCall& solver);

/// The text of a C++17 program: it solves the query, prints the answer and the truth, and its exit
/// status is 1 if the answer is wrong as found, 0 if it is not, and 2 if the solver cannot be
/// called. For crashes, hangs and the like the status is 0 if they do not happen. Of a query on
/// curves the interface is that of plugins.
/// \pre all coordinates are finite
[[nodiscard]] std::string as_main(const Reproduction& found, CallInterface interface);

}  // namespace touchstone::verify::fuzz
