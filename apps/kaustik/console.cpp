#include "console.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "kaustik/base/to_integer.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

/// The first signal and when it came, in one number so that no other comes in between: µs · 256 +
/// signal; 0: none yet.
std::atomic<int64_t> first_signal = 0;
static_assert(std::atomic<int64_t>::is_always_lock_free);

constexpr int64_t same_moment_us = 200'000;

int64_t now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return int64_t(time.tv_sec) * 1'000'000 + time.tv_nsec / 1000;
}

void on_interrupt(int signal) {
  const int64_t now = now_us();
  int64_t first = 0;
  // Otherwise `first` is what came before.
  if (first_signal.compare_exchange_strong(first, now << 8 | signal)) return;
  if ((first & 255) == signal && now - (first >> 8) < same_moment_us) return;
  // It is delivered when this returns.
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

/// Of the terminal that standard error is.
size_t terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

}  // namespace

void warn(const std::string& message) { spdlog::warn(message); }

void note(const std::string& message) { spdlog::info(message); }

int usable_threads(int asked) {
  const int available = int(std::thread::hardware_concurrency());
  if (available == 0 || asked <= available) return asked;
  warn(fmt::format("--threads {}: this machine runs {} at a time, so that many are used", asked,
                   available));
  return available;
}

std::string duration_text(double seconds) {
  const auto s = to_integer(seconds + 0.5, int64_t(0), int64_t(1) << 53);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return seconds < 9.95 ? fmt::format("{:.1f} s", seconds) : fmt::format("{} s", s);
}

std::string count_text(double count) {
  if (count >= 1e9) return fmt::format("{:.2f} G", count / 1e9);
  if (count >= 1e6) return fmt::format("{:.2f} M", count / 1e6);
  if (count >= 1e3) return fmt::format("{:.1f} k", count / 1e3);
  return fmt::format("{:.0f} ", count);
}

namespace {

std::string bar_text(double fraction, size_t width) {
  const auto filled = size_t(to_integer(fraction * double(width), 0, int(width)));
  return fmt::format("[{}{}] ", std::string(filled, '#'), std::string(width - filled, '-'));
}

}  // namespace

std::string progress_text(double fraction, const std::vector<std::string>& facts, size_t columns) {
  constexpr size_t narrow = 40, wide = 80;
  std::string line;
  if (columns >= narrow) line = bar_text(fraction, columns >= wide ? 24 : 8);
  line += fmt::format("{:3.0f} %", 100 * fraction);
  for (const std::string& fact : facts) {
    if (line.size() + 2 + fact.size() > columns) break;
    line += "  " + fact;
  }
  return line.substr(0, columns);
}

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::show(const Progress& p) {
  if (quiet_) return;
  const bool done = p.stage == Progress::Stage::done;
  if (!terminal_ && !done && p.elapsed_s - last_printed_s_ < 5) return;
  last_printed_s_ = p.elapsed_s;
  std::vector<std::string> facts;
  facts.push_back(p.passes_total > 0 ? fmt::format("pass {}/{}", p.passes_done, p.passes_total)
                                     : fmt::format("pass {}", p.passes_done));
  if (done)
    facts.push_back(duration_text(p.elapsed_s));
  else if (p.remaining_s >= 0)
    facts.push_back(duration_text(p.remaining_s) + " left");
  if (std::isfinite(p.relative_error))
    facts.push_back(fmt::format("error {:.2f} %", 100 * p.relative_error));
  facts.push_back(count_text(p.rays_per_s) + "rays/s");
  if (p.photons_per_s > 0) facts.push_back(count_text(p.photons_per_s) + "photons/s");
  facts.push_back(fmt::format("{} MB", p.memory_bytes >> 20));
  print(p.fraction, facts);
}

void ProgressLine::show(double fraction, double elapsed_s) {
  if (quiet_ || elapsed_s < 1) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || elapsed_s - last_printed_s_ < (terminal_ ? 0.2 : 5)) return;
  last_printed_s_ = elapsed_s;
  std::vector<std::string> facts;
  if (fraction > 1e-3) facts.push_back(duration_text(elapsed_s * (1 / fraction - 1)) + " left");
  print(fraction, facts);
}

void ProgressLine::print(double fraction, const std::vector<std::string>& facts) {
  if (!terminal_) {
    say("{}", progress_text(fraction, facts, 1000));
    return;
  }
  // The last column stays free: some terminals go to the next line there.
  const size_t columns = std::max<size_t>(2, terminal_columns()) - 1;
  std::string line = progress_text(fraction, facts, columns);
  const size_t width = line.size();
  // What the line before it has left, as far as it did not go to another line when the terminal was
  // made narrower.
  line.resize(std::max(width, std::min(width_, columns)), ' ');
  width_ = width;
  std::fputs(("\r" + line).c_str(), stderr);
  std::fflush(stderr);
}

void ProgressLine::finish() {
  if (!quiet_ && terminal_) std::fputs("\n", stderr);
}

InterruptGuard::InterruptGuard() {
  first_signal = 0;
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  for (const int signal : signals_) ::sigaddset(&action.sa_mask, signal);
  for (size_t i = 0; i < signals_.size(); ++i) {
    ::sigaction(signals_[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals_[i], &action, nullptr);
  }
  watcher_ = std::jthread([this](std::stop_token ended) {
    while (!ended.stop_requested()) {
      if (first_signal != 0) source_.request_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

InterruptGuard::~InterruptGuard() {
  for (size_t i = 0; i < signals_.size(); ++i) ::sigaction(signals_[i], &before_[i], nullptr);
}

}  // namespace kaustik::app
