#include "verify/data/npy.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/data/npy_header.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data {
namespace {

static_assert(std::endian::native == std::endian::little, "queries are read as they are stored");

constexpr std::string_view query_descr = "<f8";
constexpr std::array<std::uint64_t, 2> query_extents{query_points, 3};

/// Number of queries that the header announces. \throws NpyHeaderError if it is that of another
/// array.
std::uint64_t query_count(const NpyHeader& header) {
  require_doubles(header);
  if (header.shape.size() != 3 || header.shape[1] != query_extents[0] ||
      header.shape[2] != query_extents[1]) {
    throw NpyHeaderError("shape " + shape_text(header) + ", expected (N, 8, 3)");
  }
  return header.shape[0];
}

/// Reads all that stands before the data and returns the number of queries.
std::uint64_t read_header(io::InputFile& file) {
  const NpyHeader header =
      read_npy_header([&file](std::span<char> buffer) { return file.read_all(buffer); });
  const std::uint64_t count = query_count(header);
  const std::uint64_t data_size = file.size() - header.size;
  if (data_size % sizeof(Query) != 0 || data_size / sizeof(Query) != count) {
    throw NpyHeaderError(fmt::format("{} bytes of data, but the shape says {} queries of {} bytes",
                                     data_size, count, sizeof(Query)));
  }
  return count;
}

}  // namespace

NpyReader::NpyReader(const std::filesystem::path& path) : file_(path) {
  try {
    count_ = read_header(file_);
  } catch (const NpyHeaderError& error) {
    throw io::DatasetError(path, {}, error.what());
  }
}

const Query& NpyReader::next() {
  if (next_in_block_ == block_.size()) fill();
  ++position_;
  return block_[next_in_block_++];
}

void NpyReader::fill() {
  // 96 KiB: a system call is not felt, and the block stays in the processor's cache.
  static constexpr std::uint64_t block_size = 512;
  block_.resize(std::min(block_size, count_ - position_));
  next_in_block_ = 0;
  void* const bytes = block_.data();
  const std::size_t size =
      file_.read_all({static_cast<char*>(bytes), block_.size() * sizeof(Query)});
  block_.resize(size / sizeof(Query));
  if (!block_.empty()) return;
  throw io::DatasetError(
      file_.path(), {},
      fmt::format("has become shorter while it was read: query {} of {} is missing", position_,
                  count_));
}

NpyWriter::NpyWriter(std::filesystem::path path) : file_(std::move(path)) {
  file_.write(npy_header_text(query_descr, 0, query_extents));
}

void NpyWriter::write(const Query& query) {
  if (!is_finite(query)) throw std::invalid_argument("a coordinate must be finite");
  const void* const bytes = &query;
  file_.write({static_cast<const char*>(bytes), sizeof(Query)});
  ++count_;
}

void NpyWriter::close() {
  file_.overwrite(0, npy_header_text(query_descr, count_, query_extents));
  file_.close();
}

}  // namespace touchstone::verify::data
