#pragma once
#include <chrono>
#include <functional>
#include <string>

#include "kaustik/render/checkpoint.h"

namespace kaustik {

/// Keeps a render's checkpoint file up to date.
class CheckpointKeeper {
 public:
  /// Writes to `path` about every `interval_s` seconds ("": never), more rarely where writing would
  /// take more than a tenth of the time. `record` is what is known when the session starts; `warn`
  /// is told why one could not be written. `integrator` is the session's, which must outlive this.
  CheckpointKeeper(std::string path, double interval_s, RenderRecord record,
                   const Integrator& integrator, std::function<void(const std::string&)> warn);

  /// After each pass: writes if it is time. A failure is told, and the render may go on.
  void pass_done(const Film& film);
  /// At the end: writes what has changed since. Throws Error.
  void write_last(const Film& film);
  /// With the time until now.
  RenderRecord record() const;

 private:
  using Clock = std::chrono::steady_clock;
  void write(const Film& film);

  std::string path_;
  double interval_s_;
  RenderRecord record_;
  const Integrator& integrator_;
  std::function<void(const std::string&)> warn_;
  Clock::time_point start_, next_;
  uint32_t passes_written_ = 0;  ///< of the picture and of regions
};

}  // namespace kaustik
