#pragma once

/// \file
/// Work that has no blocks, outside Python's lock: in a thread of its own, while the caller waits
/// and looks for signals. At an interrupt the work is told to stop, which it does soon.

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <optional>

namespace touchstone::python {

/// Notes forks. Called once.
void watch_forks();

/// True in a child of fork(), where the threads of a pool do not exist.
[[nodiscard]] bool is_forked();

/// Calls work() in a thread of its own, and while_waiting() in this one now and then, with Python's
/// lock. \returns false if Python was interrupted: then `stop` was true until the work returned or
/// threw, and what it threw is dropped.
/// \throws what it throws. \pre the caller holds the lock.
[[nodiscard]] bool run_in_background(const std::function<void()>& work, std::atomic<bool>& stop,
                                     const std::function<void()>& while_waiting = nullptr);

/// The result of work(); `progress`, unless None, is called now and then.
/// \throws what it throws; KeyboardInterrupt. \pre the caller holds the lock.
template <class Work>
[[nodiscard]] auto in_background(const Work& work, std::atomic<bool>& stop,
                                 const pybind11::object& progress = pybind11::none()) {
  std::optional<decltype(work())> result;
  std::function<void()> while_waiting;
  if (!progress.is_none()) while_waiting = [&] { progress(); };
  const auto run = [&] { result.emplace(work()); };
  if (run_in_background(run, stop, while_waiting)) return *std::move(result);
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw pybind11::error_already_set();
}

}  // namespace touchstone::python
