#pragma once

/// \file
/// A source of queries in memory, with faults on demand.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/data/query_source.hpp"

namespace touchstone::tests {

class MemorySource final : public verify::data::QuerySource {
 public:
  MemorySource(const AnyShape& shape, std::vector<verify::data::RecordedQuery> queries)
      : shape_(shape), queries_(std::move(queries)) {}
  MemorySource(AnyKind kind, std::vector<verify::data::RecordedQuery> queries)
      : MemorySource(AnyShape{.kind = kind}, std::move(queries)) {}

  /// next() throws std::runtime_error(message) instead of giving query number `index`.
  void fail_at(std::size_t index, std::string message) {
    failure_ = index;
    message_ = std::move(message);
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] AnyShape shape() const override { return shape_; }
  [[nodiscard]] std::optional<verify::data::RecordedQuery> next() override {
    if (position_ == failure_) throw std::runtime_error(message_);
    if (position_ == queries_.size()) return std::nullopt;
    return queries_[position_++];
  }
  [[nodiscard]] double progress() const override {
    return static_cast<double>(position_) / static_cast<double>(queries_.size());
  }
  [[nodiscard]] std::uint64_t skipped() const override { return 3; }
  [[nodiscard]] std::uint64_t rounded() const override { return 5; }

 private:
  std::string name_ = "memory";
  AnyShape shape_;
  std::vector<verify::data::RecordedQuery> queries_;
  std::size_t position_ = 0;
  std::optional<std::size_t> failure_;
  std::string message_;
};

}  // namespace touchstone::tests
