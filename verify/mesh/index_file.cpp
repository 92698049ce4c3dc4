#include "verify/mesh/index_file.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "verify/data/npy.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::mesh {

static_assert(std::endian::native == std::endian::little, "indices are written as they are stored");

void write_index_pairs(const std::filesystem::path& path,
                       std::span<const std::array<std::int32_t, 2>> pairs) {
  io::OutputFile file(path);
  static constexpr std::array<std::uint64_t, 1> extents{2};
  file.write(data::npy_header_text("<i4", pairs.size(), extents));
  // The writer buffers each call as a whole.
  static constexpr std::size_t part = 4096;
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(part, pairs.size()))) {
    io::throw_if_interrupted();
    const auto bytes = pairs.first(std::min(part, pairs.size()));
    const void* const data = bytes.data();
    file.write({static_cast<const char*>(data), bytes.size_bytes()});
  }
  file.close();
}

}  // namespace touchstone::verify::mesh
