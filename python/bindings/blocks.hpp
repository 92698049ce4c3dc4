#pragma once

/// \file
/// Work on a batch outside Python's lock, in blocks, until it is done or Python is interrupted.
///
/// The calling thread and up to threads − 1 others take block after block from a counter, each in
/// order. So at every moment the blocks that have been taken are the first ones, and a run that
/// stops early has done all queries up to a number. The calling thread looks for signals between
/// its blocks. Threads are made for each call and end with it: no pool is lost by a fork.

#include <pybind11/pybind11.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace touchstone::python {

/// The time between two looks for signals.
inline constexpr std::chrono::milliseconds signal_period{50};

/// True if Python is to be interrupted (Ctrl-C), which ends with this call. In other threads than
/// the main one: false. \pre the caller does not hold the lock.
/// \throws pybind11::error_already_set if a handler of a signal raises anything else.
[[nodiscard]] inline bool is_interrupted() {
  const pybind11::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() == 0) return false;
  if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) throw pybind11::error_already_set();
  PyErr_Clear();
  return true;
}

/// The threads for a number of blocks, where a user asks for `threads`; 0: one for each core that
/// the process may use.
/// \throws std::invalid_argument for a negative number.
[[nodiscard]] inline std::size_t team_size(int threads, std::size_t blocks) {
  if (threads < 0) throw std::invalid_argument("threads must not be negative");
  if (threads == 1 || blocks <= 1) return 1;  // to count cores takes longer than a query
  const std::size_t wanted = threads == 0 ? std::thread::hardware_concurrency() : unsigned(threads);
  return std::clamp<std::size_t>(wanted, 1, blocks);
}

/// Calls work(first, count) for blocks of a batch, from several threads at once.
/// \param block the maximum number of queries in a block
/// \param progress None, or what the calling thread calls now and then with the number of queries
/// that have been taken
/// \returns the number of queries that are done, from the first on: `size`, or fewer if Python is
/// interrupted. \throws what work throws. \pre the caller holds the lock.
template <class Work>
[[nodiscard]] std::size_t in_blocks(std::size_t size, std::size_t block, int threads,
                                    const pybind11::object& progress, const Work& work) {
  const std::size_t blocks = (size + block - 1) / block;
  const std::size_t team = team_size(threads, blocks);
  const bool has_progress = !progress.is_none();
  const pybind11::gil_scoped_release unlocked;
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> stop = false;
  std::exception_ptr error;
  std::mutex error_guard;
  const auto take_blocks = [&](const auto& is_over) {
    try {
      while (!stop && !is_over()) {
        const std::size_t first = next.fetch_add(1) * block;
        if (first >= size) return;
        work(first, std::min(block, size - first));
      }
    } catch (...) {
      const std::scoped_lock guard(error_guard);
      if (!error) error = std::current_exception();
    }
    stop = true;
  };
  {
    std::vector<std::jthread> others;
    while (others.size() + 1 < team) {
      others.emplace_back([&] { take_blocks([] { return false; }); });
    }
    auto looked = std::chrono::steady_clock::now();
    take_blocks([&] {
      const auto now = std::chrono::steady_clock::now();
      if (now - looked < signal_period) return false;
      looked = now;
      if (is_interrupted()) return true;
      if (has_progress) {
        const pybind11::gil_scoped_acquire lock;
        progress(std::min(size, next * block));
      }
      return false;
    });
  }
  if (error) std::rethrow_exception(error);
  return std::min(size, next * block);
}

}  // namespace touchstone::python
