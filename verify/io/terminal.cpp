#include "verify/io/terminal.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <system_error>

#include "verify/io/printable.hpp"

namespace touchstone::verify::io {
namespace {

/// Why standard output failed; 0: it has not.
std::atomic<int> output_error = 0;

std::atomic<bool> interrupt_flag = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

extern "C" void on_signal(int signal) {
  if (signal == SIGINT) std::signal(signal, SIG_DFL);
  interrupt_flag = true;
}

void install_handlers() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

}  // namespace

void print(std::FILE* stream, std::string_view text) {
  if (stream == stdout && output_error != 0) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream) == text.size()) return;
  if (stream == stdout) output_error = errno != 0 ? errno : EIO;
}

void finish_printing() {
  if (output_error == 0 && std::fflush(stdout) != 0) output_error = errno;
  if (output_error == 0 || output_error == EPIPE) return;
  throw std::runtime_error("standard output: cannot be written: " +
                           std::generic_category().message(output_error));
}

ProgressBar::ProgressBar(std::string_view title) : title_(printable(title)) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
  if (drawn_) print(stderr, "\r\x1b[K");
  drawn_ = false;
}

void ProgressBar::update(double fraction) {
  using namespace std::chrono_literals;
  const Clock::time_point now = Clock::now();
  const bool is_terminal = isatty(STDERR_FILENO) != 0;
  if (now - start_ < 1s || now - last_draw_ < (is_terminal ? 100ms : 10s)) return;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const std::string line = progress_line(title_, fraction, seconds);
  print(stderr, is_terminal ? fmt::format("\r{}\x1b[K", line) : line + '\n');
  last_draw_ = now;
  drawn_ = is_terminal;
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
    install_handlers();
    return true;
  }();
  static_cast<void>(installed);
  return interrupt_flag;
}

void throw_if_interrupted() {
  if (interrupt_flag) throw Interrupted();
}

void wait_for_input(int descriptor) {
  // A signal may reach another thread, or come just before the wait.
  static constexpr int look_again_milliseconds = 100;
  pollfd waited{.fd = descriptor, .events = POLLIN, .revents = 0};
  for (int ready = 0; ready == 0 || (ready < 0 && errno == EINTR);) {
    throw_if_interrupted();
    ready = ::poll(&waited, 1, look_again_milliseconds);
  }
}

}  // namespace touchstone::verify::io
