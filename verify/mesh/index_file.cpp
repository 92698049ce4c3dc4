#include "verify/mesh/index_file.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string>

#include "verify/io/output_file.hpp"

namespace touchstone::verify::mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "indices are written as they are stored");

std::string header_text(std::size_t count) {
  using namespace std::string_literals;
  // With room for the largest count; a multiple of 64 in all, as NumPy pads it.
  static constexpr std::size_t total = 128, prefix = 10;
  std::string text = "\x93NUMPY\x01\0"s;
  text += static_cast<char>(total - prefix);
  text += '\0';
  text += "{'descr': '<i4', 'fortran_order': False, 'shape': (" + std::to_string(count) + ", 2), }";
  text.resize(total - 1, ' ');
  return text + '\n';
}

}  // namespace

void write_index_pairs(const std::filesystem::path& path,
                       std::span<const std::array<std::int32_t, 2>> pairs) {
  io::OutputFile file(path);
  file.write(header_text(pairs.size()));
  // The writer keeps what it is given at once in a buffer.
  static constexpr std::size_t part = 4096;
  for (; !pairs.empty(); pairs = pairs.subspan(std::min(part, pairs.size()))) {
    const auto bytes = pairs.first(std::min(part, pairs.size()));
    const void* const data = bytes.data();
    file.write({static_cast<const char*>(data), bytes.size_bytes()});
  }
  file.close();
}

}  // namespace touchstone::verify::mesh
