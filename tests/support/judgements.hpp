#pragma once

/// \file
/// Judgements for tests.

#include "verify/judge/judgement.hpp"

namespace touchstone::tests {

/// Adds an answer without regard to its query. Its tolerance, if it has one, is compared with the
/// distance of two points at one place, which never contradicts it.
inline void add(verify::judge::Judgement& judgement, const verify::judge::GroundTruth& truth,
                const fast::Answer& answer, const verify::judge::Failure* failure = nullptr) {
  judgement.add({Kind::vertex_face, Query{}}, truth, answer, {}, failure);
}

}  // namespace touchstone::tests
