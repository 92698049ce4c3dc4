#pragma once

/// \file
/// The public spdlog, as far as the adapter calls it: the same names and signatures, to compile
/// against.

#include <memory>
#include <string>
#include <utility>

namespace spdlog {

class logger {
 public:
  explicit logger(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::shared_ptr<logger> clone(std::string name) const {
    return std::make_shared<logger>(std::move(name));
  }

 private:
  std::string name_;
};

inline std::shared_ptr<logger> default_logger() {
  static const auto instance = std::make_shared<logger>("");
  return instance;
}

}  // namespace spdlog
