#include "verify/cli/options.hpp"

#include <stdexcept>

namespace touchstone::verify::cli {

OptionalOutput::OptionalOutput(const std::string& name) : name_(name) {
  if (name.empty()) return;
  file_.open(name, std::ios::binary | std::ios::trunc);
  if (!file_) throw std::runtime_error(name + ": cannot be opened for writing");
}

void OptionalOutput::close() {
  if (name_.empty()) return;
  file_.close();
  if (!file_) throw std::runtime_error(name_ + ": could not be written completely");
}

}  // namespace touchstone::verify::cli
