#include "verify/jobs/block_truth.hpp"

#include <utility>

#include "verify/base/thread_clock.hpp"
#include "verify/jobs/certify.hpp"

namespace touchstone::verify::jobs {

BlockTruth::BlockTruth(const QueryBlock& block, BlockTruthOptions options, Passes& passes)
    : block_(block),
      options_(std::move(options)),
      truths_(block.size()),
      parts_(Passes::units(block.size())) {
  passes.run(Passes::unit, [this](std::size_t first, std::size_t count) {
    decide(first, count, parts_[first / Passes::unit]);
    return true;
  });
}

std::span<const DecidedPart> BlockTruth::parts(std::size_t count) const {
  return std::span(parts_).first(Passes::units(count));
}

void BlockTruth::decide(std::size_t first, std::size_t count, DecidedPart& part) {
  const double start = base::thread_nanoseconds();
  const std::vector<exact::Decision> verdicts =
      exact::decide(block_.queries().part(first, count), options_.separation);
  part.nanoseconds = base::thread_nanoseconds() - start;
  for (std::size_t i = 0; i < count; ++i) {
    const exact::Decision& verdict = verdicts[i];
    const std::uint64_t index = block_.indices[first + i];
    for (judge::Mismatch& mismatch :
         judge::judge_label(index, block_.labels[first + i], verdict, options_.comparison)) {
      part.mismatches.push_back(std::move(mismatch));
    }
    truths_[first + i] =
        options_.times ? judge::truth_of(index, verdict)
                       : judge::GroundTruth{
                             .index = index, .collides = verdict.collides(), .toi = std::nullopt};
  }
  if (options_.certificates) prove(first, verdicts, part);
}

void BlockTruth::prove(std::size_t first, const std::vector<exact::Decision>& verdicts,
                       DecidedPart& part) const {
  const double start = base::thread_nanoseconds();
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    append_certificate(block_.queries(), first + i, verdicts[i],
                       certificate_label(*block_.source, block_.indices[first + i]), options_.proof,
                       part.certificates, part.proofs);
  }
  part.proofs.nanoseconds = base::thread_nanoseconds() - start;
}

void BlockTruth::add_to(CertifyResult& result, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    ++result.queries;
    result.collisions += truths_[i].collides ? 1U : 0U;
    result.labels += options_.comparison.uses_verdict(block_.labels[i]) ? 1U : 0U;
    result.tois += options_.comparison.uses_toi(block_.labels[i]) ? 1U : 0U;
  }
  for (const DecidedPart& part : parts(count)) {
    for (const judge::Mismatch& mismatch : part.mismatches) {
      ++(mismatch.of == judge::Mismatch::Of::label ? result.label_mismatches
                                                   : result.toi_mismatches);
      result.mismatches.push_back(mismatch);
    }
    result.microseconds += 1e-3 * part.nanoseconds;
    result.proofs += part.proofs;
  }
}

}  // namespace touchstone::verify::jobs
