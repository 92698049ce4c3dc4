#include "verify/jobs/prove.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"

namespace touchstone::verify::jobs {
namespace {

double per_certificate(double sum, const ProofCounts& counts) {
  const std::uint64_t certificates = counts.certificates();
  return certificates == 0 ? 0.0 : sum / static_cast<double>(certificates);
}

}  // namespace

std::uint64_t ProofCounts::certificates() const {
  return no_collision + collision + time_of_impact;
}

void ProofCounts::add(const exact::Certificate& certificate) {
  ++(certificate.claim == exact::Claim::no_collision ? no_collision
     : certificate.claim == exact::Claim::collision  ? collision
                                                     : time_of_impact);
  ++subintervals[certificate.subintervals.size()];
}

ProofCounts& ProofCounts::operator+=(const ProofCounts& other) {
  no_collision += other.no_collision;
  collision += other.collision;
  time_of_impact += other.time_of_impact;
  for (const auto& [size, certificates] : other.subintervals) subintervals[size] += certificates;
  bytes += other.bytes;
  nanoseconds += other.nanoseconds;
  beyond_limits.insert(beyond_limits.end(), other.beyond_limits.begin(), other.beyond_limits.end());
  return *this;
}

std::string certificate_label(std::string_view source, std::uint64_t index) {
  return fmt::format("{}:{}", io::printable(source), index);
}

std::string to_text(const ProofCounts& counts) {
  io::TextTable claims({io::word_column("claim", 15), {"certificates"}});
  claims.add({"no collision", std::to_string(counts.no_collision)});
  claims.add({"collision", std::to_string(counts.collision)});
  claims.add({"time of impact", std::to_string(counts.time_of_impact)});
  claims.add({"total", std::to_string(counts.certificates())});
  io::TextTable subintervals({io::word_column("subintervals", 15), {"certificates"}});
  for (const auto& [size, certificates] : counts.subintervals) {
    subintervals.add({std::to_string(size), std::to_string(certificates)});
  }
  std::string text = claims.text() + '\n' + subintervals.text();
  text += fmt::format("\n{} bytes, {:.1f} bytes/certificate, {:.2f} µs/certificate\n", counts.bytes,
                      per_certificate(static_cast<double>(counts.bytes), counts),
                      per_certificate(1e-3 * counts.nanoseconds, counts));
  return text;
}

nlohmann::json to_json(const ProofCounts& counts) {
  nlohmann::json subintervals = nlohmann::json::object();
  for (const auto& [size, certificates] : counts.subintervals) {
    subintervals[std::to_string(size)] = certificates;
  }
  return {{"certificates", counts.certificates()},
          {"no_collision", counts.no_collision},
          {"collision", counts.collision},
          {"time_of_impact", counts.time_of_impact},
          {"subintervals", std::move(subintervals)},
          {"bytes", counts.bytes},
          {"bytes_per_certificate", per_certificate(static_cast<double>(counts.bytes), counts)},
          {"us_per_certificate", per_certificate(1e-3 * counts.nanoseconds, counts)},
          {"beyond_limits", counts.beyond_limits.size()}};
}

}  // namespace touchstone::verify::jobs
