#include "console.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "kaustik/base/to_integer.h"

namespace kaustik::app {
namespace {

volatile std::sig_atomic_t interrupts = 0;

void on_interrupt(int signal) {
  interrupts = interrupts + 1;
  std::signal(signal, SIG_DFL);
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

std::string bar_text(double fraction) {
  constexpr int width = 24;
  const int filled = to_integer(fraction * width, 0, width);
  return fmt::format("[{}{}] {:3.0f} %", std::string(size_t(filled), '#'),
                     std::string(size_t(width - filled), '-'), 100 * fraction);
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::show(const Progress& p) {
  if (quiet_) return;
  const bool done = p.stage == Progress::Stage::done;
  if (!terminal_ && !done && p.elapsed_s - last_printed_s_ < 5) return;
  last_printed_s_ = p.elapsed_s;
  std::string line = bar_text(p.fraction);
  line += p.passes_total > 0 ? fmt::format("  pass {}/{}", p.passes_done, p.passes_total)
                             : fmt::format("  pass {}", p.passes_done);
  if (done)
    line += fmt::format("  {}", duration_text(p.elapsed_s));
  else if (p.remaining_s >= 0)
    line += fmt::format("  {} left", duration_text(p.remaining_s));
  line += fmt::format("  {}rays/s", count_text(p.rays_per_s));
  if (p.photons_per_s > 0) line += fmt::format("  {}photons/s", count_text(p.photons_per_s));
  line += fmt::format("  {} MB", p.memory_bytes >> 20);
  if (std::isfinite(p.relative_error))
    line += fmt::format("  error {:.2f} %", 100 * p.relative_error);
  print(line);
}

void ProgressLine::show(double fraction, double elapsed_s) {
  if (quiet_ || elapsed_s < 1) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || elapsed_s - last_printed_s_ < (terminal_ ? 0.2 : 5)) return;
  last_printed_s_ = elapsed_s;
  std::string line = bar_text(fraction);
  if (fraction > 1e-3)
    line += fmt::format("  {} left", duration_text(elapsed_s * (1 / fraction - 1)));
  print(line);
}

void ProgressLine::print(const std::string& text) {
  std::string line = text;
  if (terminal_) {
    const size_t width = line.size();
    if (width < width_) line += std::string(width_ - width, ' ');
    width_ = width;
    fmt::print(stderr, "\r{}", line);
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

void ProgressLine::finish() {
  if (!quiet_ && terminal_) fmt::print(stderr, "\n");
}

InterruptGuard::InterruptGuard() {
  interrupts = 0;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  watcher_ = std::jthread([this](std::stop_token ended) {
    while (!ended.stop_requested()) {
      if (interrupts > 0) source_.request_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace kaustik::app
