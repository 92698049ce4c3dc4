#pragma once

/// \file
/// A descriptor of the system, closed with its object.

#include <unistd.h>

#include <utility>

namespace touchstone::verify::io {

class Descriptor {
 public:
  /// \param number of the system; −1: none
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int get() const { return number_; }
  /// Closes it now. \returns what close() of the system returns, 0 if there is none.
  int close() { return number_ < 0 ? 0 : ::close(std::exchange(number_, -1)); }

 private:
  int number_;
};

}  // namespace touchstone::verify::io
