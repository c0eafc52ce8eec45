#pragma once
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "kaustik/base/progress.h"

namespace kaustik {

struct Lessons;
struct Pass;
struct PassReport;

/// What passes teach where several processes share them: each hands over what its own passes have
/// taught, one of them adds all of it in the order of the passes and tells the others what passes
/// are to go by. So plans have the same bits as in one process.
class SharedLessons {
 public:
  virtual ~SharedLessons() = default;
  /// First pass of the next epoch, the passes before which need nothing of one another, once
  /// lessons_for() has been asked for one of them. Absent: none comes.
  virtual std::optional<uint32_t> epoch_end(uint32_t pass) const = 0;
  /// What a pass goes by, for take_over(): all that passes before its epoch have taught. Those that
  /// were not added are traced. Empty if nothing is learned: then each process makes its plans
  /// itself. Worth nothing if it was stopped.
  virtual Lessons lessons_for(const Pass& pass, const std::stop_token& stop,
                              const ProgressFunction& progress, PassReport& report) = 0;
  /// Goes by these. Throws Error(input) if they are damaged or of another picture.
  virtual void take_over(const Lessons& lessons) = 0;
  /// What a pass has taught that was prepared, once: it is forgotten then. Empty: nothing.
  virtual std::vector<uint8_t> take_taught(uint32_t pass) = 0;
  /// Adds it. A pass that is not the next one is left out: it will be traced anew if it is needed.
  /// Throws as take_over() does.
  virtual void add_taught(const Pass& pass, const std::vector<uint8_t>& taught) = 0;
};

}  // namespace kaustik
