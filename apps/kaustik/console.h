#pragma once
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "kaustik/render/session.h"

namespace kaustik::app {

/// One line on standard error that is kept up to date; on anything but a terminal a line now and
/// then. Shows percent, time left, rays/s, photons/s, memory, error.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  void show(const Progress& progress);
  /// Percent and time left of work that is no render, called from any thread.
  void show(double fraction, double elapsed_s);
  void finish();

 private:
  void print(const std::string& line);
  bool quiet_, terminal_;
  double last_printed_s_ = -1e9;
  size_t width_ = 0;
  std::mutex mutex_;
};

/// Turns the first interrupt (Ctrl-C) or termination signal into a stop request; a second one ends
/// the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

void warn(const std::string& message);
/// What the user may want to know, on standard error.
void note(const std::string& message);
/// Threads to use where `asked` are asked for (0: all): no more than the machine runs at a time.
int usable_threads(int asked);
/// "1 h 02 min", "3 min 04 s", "12 s".
std::string duration_text(double seconds);
/// "12.3 M", "4.5 k".
std::string count_text(double count);

}  // namespace kaustik::app
