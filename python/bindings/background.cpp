#include "python/bindings/background.hpp"

#include <pthread.h>

#include <exception>
#include <future>
#include <thread>
#include <utility>

#include "python/bindings/blocks.hpp"

namespace touchstone::python {
namespace {

std::atomic<bool> forked = false;

}  // namespace

void watch_forks() {
  pthread_atfork(nullptr, nullptr, [] { forked = true; });
}

bool is_forked() { return forked; }

bool run_in_background(const std::function<void()>& work, std::atomic<bool>& stop,
                       const std::function<void()>& while_waiting) {
  const pybind11::gil_scoped_release unlocked;
  std::packaged_task<void()> task(work);
  std::future<void> done = task.get_future();
  std::jthread thread(std::move(task));
  bool interrupted = false;
  std::exception_ptr error;
  const auto look = [&] {
    interrupted = is_interrupted();
    if (interrupted || !while_waiting) return;
    const pybind11::gil_scoped_acquire lock;
    while_waiting();
  };
  while (done.wait_for(signal_period) != std::future_status::ready && !interrupted && !error) {
    try {
      look();
    } catch (...) {
      error = std::current_exception();
    }
    if (interrupted || error) stop = true;
  }
  thread.join();
  if (interrupted || error) stop = false;
  if (error) std::rethrow_exception(error);
  if (!interrupted) done.get();
  return !interrupted;
}

}  // namespace touchstone::python
