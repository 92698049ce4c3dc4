#pragma once

/// \file
/// A wrong answer as a C++ program that includes nothing of this project: for the authors of a solver, who
/// compile it beside their own code.

#include <optional>
#include <string>
#include <string_view>

#include "verify/fuzz/reproduce.hpp"

namespace touchstone::verify::fuzz {

/// The interface through which such a program calls the solver.
enum class CallInterface : std::uint8_t {
  plugin,      ///< verify/plugin.h, of a library that is loaded
  ticcd,       ///< the public Tight-Inclusion: ticcd::vertexFaceCCD, edgeEdgeCCD
  ipc_toolkit  ///< the public IPC Toolkit: ipc::AdditiveCCD
};

/// "plugin", "ticcd" or "ipc-toolkit".
[[nodiscard]] std::string_view to_string(CallInterface interface);

/// The interface of that name, if there is one.
[[nodiscard]] std::optional<CallInterface> call_interface_from_string(std::string_view name);

/// That of the public code that a built-in method follows, if there is such code; else plugins'.
[[nodiscard]] CallInterface usual_interface(const SolverCall& solver);

/// The text of a C++17 program: it asks the one query, prints the answer beside the truth, and ends with
/// 1 if the answer is wrong as it was found to be, 0 if it is not, and 2 if there is nothing to ask. Of
/// crashes, hangs and such it ends with 0 where they do not happen.
/// \pre all coordinates are finite
[[nodiscard]] std::string as_main(const Reproduction& found, CallInterface interface);

}  // namespace touchstone::verify::fuzz
