#pragma once

/// \file
/// The pairs of a scene that may collide up to a time, in floating point alone.
///
/// The search and the stages of the certified solver that run on lanes exclude all other pairs
/// (docs/theory.md, sections 8.2 and 6). No pair goes to the exact stage, so this is for callers
/// who ask more of the few pairs that remain. Primitives at rest are within a distance iff a step
/// without motion collides at that separation: then these are the pairs that may be so near.

#include <cstddef>
#include <functional>

#include "fast/step/scene.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

/// Calls take(kind, pair), with the numbers of the interface, for all pairs of the scene that
/// collide up to t_limit at its separation, and possibly for others, each once. Several threads
/// call it concurrently, in any order, under strict floating point. t_max has no effect. Uses the
/// threads of the caller's task arena. \throws Stopped as Step.
void for_each_possible_collision(const Scene& scene, double t_limit,
                                 const std::function<void(ContactKind, const IndexPair&)>& take);

/// The same at another separation, not greater than the scene's.
/// \param interval of the scene, with its rounded vertices for that separation
/// \param t_limit in [0, interval.end]
template <std::size_t instants>
void for_each_possible_collision(const Scene& scene, const SceneInterval<instants>& interval,
                                 const Separation& separation, double t_limit,
                                 const std::function<void(ContactKind, const IndexPair&)>& take);

}  // namespace touchstone::fast
