#include "verify/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <utility>

namespace touchstone::verify {
namespace {

std::atomic<bool> interrupt_flag = false;
std::atomic<std::int64_t> interrupt_time = 0;  // 0: none yet
static_assert(std::atomic<bool>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free,
              "a signal handler may touch nothing else");

/// Of a clock that only goes forward, and that a signal handler may read.
std::int64_t milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
}

extern "C" void on_signal(int signal) {
  const std::int64_t now = milliseconds();
  std::int64_t first = 0;
  if (interrupt_time.compare_exchange_strong(first, now)) {
    interrupt_flag = true;
  } else if (now - first >= same_interrupt_milliseconds) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

ProgressBar::ProgressBar(std::string title) : title_(std::move(title)) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
  drawn_ = false;
}

void ProgressBar::update(double fraction) {
  using namespace std::chrono_literals;
  const Clock::time_point now = Clock::now();
  if (now - start_ < 1s || now - last_draw_ < 100ms || isatty(STDERR_FILENO) == 0) return;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "\r{}\x1b[K", progress_line(title_, fraction, seconds));
  last_draw_ = now;
  drawn_ = true;
}

std::string progress_line(const std::string& title, double fraction, double seconds) {
  static constexpr int width = 30;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(done * width);
  std::string line = fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} %", title, "", filled, "",
                                 width - filled, 100.0 * done);
  if (done > 0.0) line += fmt::format(", {:.0f} s left", seconds * (1.0 - done) / done);
  return line;
}

const std::atomic<bool>& interrupted() {
  static const bool installed = [] {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    return true;
  }();
  static_cast<void>(installed);
  return interrupt_flag;
}

}  // namespace touchstone::verify
