#pragma once

/// \file
/// The messages of exceptions.

#include <string>

namespace touchstone::tests {

/// The message of an exception of that type that the work throws, or "".
template <class Error, class Work>
[[nodiscard]] std::string message_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace touchstone::tests
