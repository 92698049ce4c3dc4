#include "verify/jobs/prove.hpp"

#include <fmt/format.h>

#include <utility>

#include "touchstone/certificate_text.hpp"
#include "verify/base/thread_clock.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/jobs/stream.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The certificates of a part of a block.
struct ProvedPart {
  std::string text;
  ProofCounts counts;
  double oracle_nanoseconds = 0.0;
};

/// The parallel stage: the certificates of one block.
class BlockProofs {
 public:
  BlockProofs(const Block& block, const SourceProofOptions& options)
      : block_(block),
        options_(options),
        parts_((block.queries.size() + Passes::unit - 1) / Passes::unit) {
    Passes passes(block.queries.size(), options.stop);
    passes.run(Passes::unit, [this](std::size_t first, std::size_t count) {
      prove_part(first, count, parts_[first / Passes::unit]);
      return true;
    });
    complete_ = passes.complete();
  }

  [[nodiscard]] bool complete() const { return complete_ == block_.queries.size(); }

  /// The serial stage.
  void add_to(SourceProof& result) const {
    for (std::size_t part = 0; part * Passes::unit < complete_; ++part) {
      const auto& [text, counts, oracle_nanoseconds] = parts_[part];
      if (options_.on_certificates) options_.on_certificates(text);
      result.counts += counts;
      result.oracle_nanoseconds += oracle_nanoseconds;
    }
  }

 private:
  void prove_part(std::size_t first, std::size_t count, ProvedPart& part) const {
    std::vector<exact::Decision> verdicts;
    verdicts.reserve(count);
    const double start = base::thread_nanoseconds();
    for (std::size_t i = 0; i < count; ++i) {
      verdicts.push_back(
          exact::decide(block_.kind, block_.queries[first + i], options_.separation));
    }
    const double decided = base::thread_nanoseconds();
    for (std::size_t i = 0; i < count; ++i) {
      append_certificate(block_.kind, block_.queries[first + i], verdicts[i],
                         certificate_label(*block_.source, block_.indices[first + i]),
                         options_.proof, part.text, part.counts);
    }
    part.oracle_nanoseconds = decided - start;
    part.counts.nanoseconds = base::thread_nanoseconds() - decided;
  }

  const Block& block_;
  const SourceProofOptions& options_;
  std::vector<ProvedPart> parts_;
  std::size_t complete_ = 0;
};

void count(const exact::Certificate& certificate, ProofCounts& counts) {
  switch (certificate.claim) {
    case exact::Claim::no_collision:
      ++counts.no_collision;
      break;
    case exact::Claim::collision:
      ++counts.collision;
      break;
    default:
      ++counts.time_of_impact;
  }
  ++counts.subintervals[certificate.subintervals.size()];
}

double per_certificate(double sum, const ProofCounts& counts) {
  const std::uint64_t certificates = counts.certificates();
  return certificates == 0 ? 0.0 : sum / static_cast<double>(certificates);
}

}  // namespace

std::uint64_t ProofCounts::certificates() const {
  return no_collision + collision + time_of_impact;
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

void append_certificate(Kind kind, const Query& query, const exact::Decision& verdict,
                        std::string_view label, const exact::ProveOptions& options,
                        std::string& text, ProofCounts& counts) {
  try {
    const exact::Certificate certificate = exact::prove(kind, query, verdict, options);
    const std::size_t before = text.size();
    exact::write(text, certificate, label);
    count(certificate, counts);
    counts.bytes += text.size() - before;
  } catch (const exact::CertificateLimitError& error) {
    counts.beyond_limits.push_back(fmt::format("{}: no certificate: {}", label, error.what()));
  }
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

SourceProof& SourceProof::operator+=(const SourceProof& other) {
  counts += other.counts;
  oracle_nanoseconds += other.oracle_nanoseconds;
  skipped += other.skipped;
  rounded += other.rounded;
  interrupted = interrupted || other.interrupted;
  return *this;
}

SourceProof prove(data::QuerySource& source, const SourceProofOptions& options) {
  SourceProof result;
  const StreamResult ended = stream(
      source, [&](const Block& block) { return BlockProofs(block, options); },
      [&](const BlockProofs& proofs) { proofs.add_to(result); },
      {.threads = options.threads, .on_progress = options.on_progress, .stop = options.stop});
  result.skipped = ended.skipped;
  result.rounded = ended.rounded;
  result.reading_error = ended.error;
  result.interrupted = ended.interrupted;
  return result;
}

}  // namespace touchstone::verify::jobs
