// Prints a hash of the answers of fast/ to queries and to steps: for the same input, the same text
// on every processor. It needs no package but Eigen, runs in one thread, and asks every kernel that
// the processor can run.
//
// touchstone_answers FOLDER...: the queries of a set's files (touchstone generate --npy), and its
// own steps.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fast/kernels.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/step.hpp"

namespace touchstone::tests {
namespace {

// ---- Hashes -------------------------------------------------------------------------------------

/// FNV-1a of numbers of 64 bits.
class Hash {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte, bits >>= 8U) {
      state_ = (state_ ^ (bits & 0xFFU)) * 0x100000001b3;
    }
  }
  /// All NaNs are the same.
  void add(double x) { add(std::isnan(x) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(x)); }
  void add(const fast::IndexPair& pair) {
    add(static_cast<std::uint64_t>(pair[0]));
    add(static_cast<std::uint64_t>(pair[1]));
  }
  void add(const fast::Distance& distance) {
    add(distance.lower);
    add(distance.upper);
  }
  void add(const fast::CertifiedResult& result) {
    add(static_cast<std::uint64_t>(result.verdict));
    add(std::uint64_t{result.is_exact});
    for (const double x : {result.toi_lower, result.toi_upper, result.u, result.v}) add(x);
  }
  void add(const fast::StepCollision& collision) {
    add(static_cast<std::uint64_t>(collision.kind));
    add(collision.pair);
    for (const double x : {collision.toi_lower, collision.toi_upper, collision.u, collision.v})
      add(x);
  }
  void add(const fast::PairDistance& pair) {
    add(static_cast<std::uint64_t>(pair.kind));
    add(pair.pair);
    add(pair.distance);
  }
  template <class Item>
  void add(const std::vector<Item>& items) {
    add(static_cast<std::uint64_t>(items.size()));
    for (const Item& item : items) add(item);
  }

  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325;
};

/// The hash that all kernels have.
/// \throws std::runtime_error, naming the first kernel with another one.
template <class Kernel, class HashOf>
std::uint64_t common_hash(std::span<const Kernel* const> kernels, const HashOf& hash_of) {
  std::optional<std::uint64_t> common;
  for (const Kernel* const kernel : kernels) {
    const std::uint64_t hash = hash_of(kernel);
    if (hash != common.value_or(hash)) {
      throw std::runtime_error("the answers of " +
                               std::string(fast::to_string(kernel->instructions)) +
                               " are not those of scalar");
    }
    common = hash;
  }
  return common.value();
}

// ---- Queries ------------------------------------------------------------------------------------

/// The queries of a file of little-endian float64 in shape (N, 8, 3), on a little-endian processor.
std::vector<Query> queries_of(const std::filesystem::path& path) {
  static_assert(std::endian::native == std::endian::little);
  std::ifstream file(path, std::ios::binary);
  std::array<char, 10> begin{};
  file.read(begin.data(), begin.size());
  if (!file || std::string_view(begin.data() + 1, 5) != "NUMPY")
    throw std::runtime_error(path.string() + " is no .npy file");
  const std::size_t header = static_cast<unsigned char>(begin[8]) +
                             256U * static_cast<unsigned char>(begin[9]) + begin.size();
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(path));
  std::vector<Query> queries((size - header) / sizeof(Query));
  file.seekg(static_cast<std::streamoff>(header));
  file.read(reinterpret_cast<char*>(queries.data()),
            static_cast<std::streamsize>(queries.size() * sizeof(Query)));
  if (!file) throw std::runtime_error(path.string() + " ends early");
  return queries;
}

std::uint64_t hash_of_certified(ContactKind kind, std::span<const Query> queries,
                                const Separation& separation) {
  return common_hash(fast::certified_kernels(), [&](const fast::CertifiedKernel* kernel) {
    std::vector<fast::CertifiedResult> results(queries.size());
    fast::solve({kind, queries}, results,
                {.separation = separation, .max_threads = 1, .kernels = {.certified = kernel}});
    Hash hash;
    hash.add(results);
    return hash.value();
  });
}

std::uint64_t hash_of_distances(ContactKind kind, std::span<const Query> queries) {
  Hash hash;
  std::vector<fast::Distance> results(queries.size());
  for (const Norm norm : {Norm::l2, Norm::linf}) {
    for (const double t : {0.0, 0.375, 1.0}) {
      fast::distances(kind, queries, t, norm, results, 1);
      hash.add(results);
    }
  }
  return hash.value();
}

void print_queries(const std::filesystem::path& path) {
  const std::string of_kind = path.parent_path().filename().string();
  const ContactKind kind = kind_from_string(of_kind).contact();
  const std::vector<Query> queries = queries_of(path);
  std::printf("%s/%s %zu", of_kind.c_str(), path.stem().string().c_str(), queries.size());
  for (const Separation& separation :
       {Separation{}, Separation{0x1p-10, Norm::linf}, Separation{0x1p-10, Norm::l2}}) {
    std::printf(" %016llx",
                static_cast<unsigned long long>(hash_of_certified(kind, queries, separation)));
  }
  std::printf(" %016llx\n", static_cast<unsigned long long>(hash_of_distances(kind, queries)));
}

// ---- Steps --------------------------------------------------------------------------------------

/// Multiples of 2^-24 in [0,1), the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 40U) * 0x1p-24;
  }

 private:
  std::uint64_t state_;
};

/// Two uneven sheets of n² squares, one above the other, which move through each other.
struct Sheets {
  std::vector<double> before, after;
  std::vector<fast::Face> faces;

  Sheets(std::int32_t n, std::uint64_t seed) {
    Random random(seed);
    for (std::int32_t sheet = 0; sheet < 2; ++sheet) {
      const auto first = static_cast<std::int32_t>(before.size() / 3);
      for (std::int32_t i = 0; i <= n; ++i) {
        for (std::int32_t j = 0; j <= n; ++j) add_vertex(i, j, sheet, random);
      }
      for (std::int32_t i = 0; i < n; ++i) {
        for (std::int32_t j = 0; j < n; ++j) {
          const std::int32_t a = first + i * (n + 1) + j, b = a + n + 1;
          faces.push_back({a, a + 1, b});
          faces.push_back({b, a + 1, b + 1});
        }
      }
    }
  }

 private:
  void add_vertex(int i, int j, int sheet, Random& random) {
    const double x = i + 0.7 * random(), y = j + 0.7 * random(), z = 1.5 * sheet + random();
    before.insert(before.end(), {x, y, z});
    after.insert(after.end(), {x + random(), y - random(), z + (0.75 - sheet) * random()});
  }
};

template <class Impact>
void add_impact(Hash& hash, const std::optional<Impact>& impact) {
  hash.add(std::uint64_t{impact.has_value()});
  if (impact) hash.add(impact->pairs);
}

std::uint64_t hash_of_step(const Sheets& sheets, const fast::StepOptions& options) {
  const fast::Step step(std::span(sheets.before), std::span(sheets.after), {.faces = sheets.faces},
                        options);
  Hash hash;
  add_impact(hash, step.earliest());
  hash.add(step.collisions());
  hash.add(step.free_step_size().value_or(-1.0));
  const fast::LineSearchLimit limit = fast::line_search_limit(step, 0.25);
  hash.add(limit.step_size);
  hash.add(limit.pairs);
  for (const Norm norm : {Norm::l2, Norm::linf}) {
    add_impact(hash, fast::least_distance(step, 0.0, norm));
    add_impact(hash, fast::least_distance(step, 0.625, norm));
  }
  return hash.value();
}

void print_steps() {
  constexpr int cells = 12, seeds = 8;
  for (const Separation& separation :
       {Separation{}, Separation{0x1p-6, Norm::linf}, Separation{0x1p-6, Norm::l2}}) {
    Hash hash;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const Sheets sheets(cells, seed);
      hash.add(common_hash(fast::certified_kernels(), [&](const fast::CertifiedKernel* kernel) {
        return common_hash(fast::search_kernels(), [&](const fast::SearchKernel* search) {
          return hash_of_step(
              sheets,
              {.solve = {.separation = separation, .max_threads = 1, .kernels = {kernel, search}}});
        });
      }));
    }
    std::printf("steps of %zu faces %d %016llx\n", Sheets(cells, 0).faces.size(), seeds,
                static_cast<unsigned long long>(hash.value()));
  }
}

void run(std::span<char* const> folders) {
  std::fputs("kernels:", stderr);
  for (const fast::CertifiedKernel* const kernel : fast::certified_kernels()) {
    std::fprintf(stderr, " %s", std::string(fast::to_string(kernel->instructions)).c_str());
  }
  std::fputs("\n", stderr);
  for (const char* const folder : folders) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() == ".npy") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) print_queries(file);
  }
  print_steps();
}

}  // namespace
}  // namespace touchstone::tests

int main(int count, char** arguments) {
  try {
    touchstone::tests::run(
        std::span<char* const>(arguments, static_cast<std::size_t>(count)).subspan(1));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "touchstone_answers: %s\n", error.what());
    return 1;
  }
  return 0;
}
