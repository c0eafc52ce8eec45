#pragma once
#include <chrono>
#include <functional>
#include <string>

#include "kaustik/render/checkpoint.h"

namespace kaustik {

/// Whether the file that is there may hold more passes of the same render: those of a process that
/// renders the same part, since engines start some twice.
enum class CheckpointOwner { one, perhaps_several };

/// Keeps a render's checkpoint file up to date.
class CheckpointKeeper {
 public:
  /// Writes to `path` about every `interval_s` seconds ("": never), more rarely where writing would
  /// take more than a tenth of the time. `record` is what is known when the session starts; `warn`
  /// is told why one could not be written, or was not since it would have replaced one of more
  /// passes. `integrator` is the session's, which must outlive this.
  CheckpointKeeper(std::string path, CheckpointOwner owner, double interval_s, RenderRecord record,
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
  /// False: one of more passes is there, and stays.
  bool write_unless_behind(const Film& film);
  /// Whether the file that is there has all passes of the film, and more.
  bool is_behind(const Film& film) const;

  std::string path_;
  CheckpointOwner owner_;
  double interval_s_;
  RenderRecord record_;
  const Integrator& integrator_;
  std::function<void(const std::string&)> warn_;
  Clock::time_point start_, next_;
  uint32_t passes_written_ = 0;  ///< of the picture and of regions
  bool has_told_ = false;        ///< that it is behind
};

}  // namespace kaustik
