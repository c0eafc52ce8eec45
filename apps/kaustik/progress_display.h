#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "kaustik/render/session.h"

namespace kaustik::app {

/// How progress is shown on standard error.
enum class ProgressStyle {
  bar,    ///< a line that is kept up to date, as wide as the terminal is at the moment
  plain,  ///< a line now and then
  none
};

/// Shows percent, passes, time left, error, rays/s, photons/s, memory: as much of it, in this
/// order, as there is room for; and tells it to events().
class ProgressDisplay {
 public:
  explicit ProgressDisplay(ProgressStyle style) : style_(style) {}
  ~ProgressDisplay() { finish(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  void show(const Progress& progress);
  /// Percent and time left of work that is no render, called from any thread.
  void show(double fraction, double elapsed_s);
  /// What comes next comes below it.
  void finish();

 private:
  void print(double fraction, const std::vector<std::string>& facts, bool must_be_shown);
  const ProgressStyle style_;
  double last_printed_s_ = -1e9;
  std::mutex mutex_;
};

/// The first of `facts` behind a bar, in at most `columns` columns; without a bar where it is
/// narrow.
std::string progress_text(double fraction, const std::vector<std::string>& facts, size_t columns);

}  // namespace kaustik::app
