#include "fast/step/sieve.hpp"

#include <span>
#include <vector>

#include "fast/platform/threads.hpp"

namespace touchstone::fast {

template <std::size_t instants>
void for_each_possible_collision(const Scene& scene, const SceneInterval<instants>& interval,
                                 const Separation& separation, double t_limit,
                                 const std::function<void(ContactKind, const IndexPair&)>& take) {
  const std::vector<SearchPart> parts = scene.parts(groups_of_part);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const ContactKind kind = parts[i].kind;
    for_each_block(
        scene, [&](PairBuffer& pairs) { scene.find(interval.trees, parts[i], pairs); },
        [&](std::span<const IndexPair> pairs) {
          scene.sieve(kind, pairs, interval.rounded, separation, t_limit,
                      [&](std::size_t place) { take(kind, scene.reported(kind, pairs[place])); });
        });
  });
}

template void for_each_possible_collision(
    const Scene& scene, const SceneInterval<1>& interval, const Separation& separation,
    double t_limit, const std::function<void(ContactKind, const IndexPair&)>& take);

void for_each_possible_collision(const Scene& scene, double t_limit,
                                 const std::function<void(ContactKind, const IndexPair&)>& take) {
  const double end = t_end_of(t_limit);
  const Separation& separation = scene.certified().separation;
  if (end <= short_end) {
    for_each_possible_collision(scene, scene.up_to<1>(end), separation, t_limit, take);
  } else {
    for_each_possible_collision(scene, scene.up_to<2>(end), separation, t_limit, take);
  }
}

}  // namespace touchstone::fast
