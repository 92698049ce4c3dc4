#pragma once

/// \file
/// Queries as the vertices of a Wavefront OBJ file: of the lines "v x y z", each eight are the
/// points of a query, in the order of Query. Other statements are passed over
/// (verify/io/obj_statements.hpp).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "verify/data/dataset_source.hpp"
#include "verify/io/obj_statements.hpp"

namespace touchstone::verify::data {

/// The queries of an OBJ file as a stream.
class ObjDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  ObjDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override { return statements_.progress(); }
  [[nodiscard]] std::uint64_t rounded() const override { return rounded_; }

 private:
  [[nodiscard]] bool at_end() override;
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;
  /// Sets a point. \throws DatasetError if the statement has no three numbers.
  void read_point(const io::ObjStatement& vertex, std::span<double> point);

  io::ObjStatements statements_;
  /// The first vertex of the next query, if at_end() has read it.
  std::optional<io::ObjStatement> ahead_;
  std::uint64_t rounded_ = 0;
};

}  // namespace touchstone::verify::data
