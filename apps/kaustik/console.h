#pragma once
#include <signal.h>

#include <array>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "kaustik/render/session.h"

namespace kaustik::app {

/// One line on standard error that is kept up to date, as wide as the terminal is at the moment; on
/// anything but a terminal a line now and then. Shows percent, passes, time left, error, rays/s,
/// photons/s, memory: as much of it, in this order, as there is room for.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  void show(const Progress& progress);
  /// Percent and time left of work that is no render, called from any thread.
  void show(double fraction, double elapsed_s);
  void finish();

 private:
  void print(double fraction, const std::vector<std::string>& facts);
  bool quiet_, terminal_;
  double last_printed_s_ = -1e9;
  size_t width_ = 0;
  std::mutex mutex_;
};

/// The first of `facts` behind a bar, in at most `columns` columns; without a bar where it is
/// narrow.
std::string progress_text(double fraction, const std::vector<std::string>& facts, size_t columns);

/// Turns the first Ctrl-C (SIGINT), SIGTERM or SIGHUP into a stop request; a second one, of
/// whichever, ends the program at once. The same one again within a moment is the first: some send
/// it to the process and to its group. What is ignored stays so: SIGHUP under
/// nohup, SIGINT of a script's background jobs.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  std::stop_token token() const { return source_.get_token(); }

 private:
  static constexpr std::array<int, 3> signals_ = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, signals_.size()> before_{};
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
