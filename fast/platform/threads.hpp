#pragma once

/// \file
/// Work in a limited number of threads, through oneTBB.
///
/// Without oneTBB (TOUCHSTONE_TBB is not defined) functions of the same names run everything in the
/// caller's thread, in order, with the same answers.

#include <algorithm>

#include "fast/platform/floating_point_state.hpp"

#ifdef TOUCHSTONE_TBB
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_reduce.h>
#include <oneapi/tbb/task_arena.h>
#ifdef _WIN32
// Names of variables here, macros in <windows.h>, which oneTBB reads.
#undef far
#undef near
#endif
#else
#include <array>
#include <cstddef>
#endif

namespace touchstone::fast {

#ifdef TOUCHSTONE_TBB
namespace tbb = oneapi::tbb;
#else
/// The part of oneTBB that this module uses, in one thread.
namespace tbb {

template <class Index>
class blocked_range {
 public:
  blocked_range(Index begin, Index end, std::size_t /*grain*/) : begin_(begin), end_(end) {}
  [[nodiscard]] Index begin() const { return begin_; }
  [[nodiscard]] Index end() const { return end_; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }

 private:
  Index begin_, end_;
};

template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
  body(range);
}

template <class Index, class Body>
void parallel_for(Index begin, Index end, const Body& body) {
  for (Index i = begin; i < end; ++i) body(i);
}

template <class Index, class Value, class Body, class Join>
Value parallel_reduce(const blocked_range<Index>& range, const Value& identity, const Body& body,
                      const Join& /*join*/) {
  return body(range, identity);
}

template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
  first();
  second();
}

template <class Value>
class enumerable_thread_specific {
 public:
  [[nodiscard]] Value& local() { return only_[0]; }
  [[nodiscard]] auto begin() { return only_.begin(); }
  [[nodiscard]] auto end() { return only_.end(); }

 private:
  std::array<Value, 1> only_;
};

}  // namespace tbb
#endif

#ifdef TOUCHSTONE_TBB
/// An arena that no other call uses. oneTBB (2021.8) loses 7 kB with each arena that it destroys,
/// so arenas are kept for later calls: as many as there are calls at the same time. A fork can
/// leave the lock taken for ever; a call that does not get it at once does without.
class BorrowedArena {
 public:
  explicit BorrowedArena(int threads) : threads_(threads) {
    const std::unique_lock lock(idle().guard, std::try_to_lock);
    auto& arenas = idle().by_threads;
    if (lock && !arenas[threads].empty()) {
      arena_ = std::move(arenas[threads].back());
      arenas[threads].pop_back();
    } else {
      arena_ = std::make_unique<tbb::task_arena>(threads);
    }
  }
  ~BorrowedArena() {
    const std::unique_lock lock(idle().guard, std::try_to_lock);
    if (!lock) return;
    try {
      idle().by_threads[threads_].push_back(std::move(arena_));
    } catch (const std::bad_alloc&) {
      // The arena is destroyed if there is no memory.
    }
  }
  BorrowedArena(const BorrowedArena&) = delete;
  BorrowedArena& operator=(const BorrowedArena&) = delete;

  [[nodiscard]] tbb::task_arena& operator*() { return *arena_; }

 private:
  struct Idle {
    std::mutex guard;
    std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>> by_threads;
  };
  /// The idle arenas, never destroyed: threads may search until the program has ended.
  static Idle& idle() {
    static Idle* const all = new Idle;
    return *all;
  }

  int threads_;
  std::unique_ptr<tbb::task_arena> arena_;
};
#endif

/// Calls work() in an arena of at most this number of threads (0: touchstone::all_cores), under
/// strict floating point, and returns its result. It may run in another thread than the caller's.
/// Its tasks have to establish strict floating point themselves.
template <class Work>
auto with_threads([[maybe_unused]] int max_threads, const Work& work) {
  const auto strictly = [&work] {
    const StrictFloatingPoint strict;
    return work();
  };
#ifdef TOUCHSTONE_TBB
  // oneTBB would not start more threads than cores.
  const int cores = tbb::info::default_concurrency();
  BorrowedArena arena(max_threads == 0 ? cores : std::min(max_threads, cores));
  return (*arena).execute(strictly);
#else
  return strictly();
#endif
}

}  // namespace touchstone::fast
