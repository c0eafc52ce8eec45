#pragma once
#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <string>

namespace kaustik::fuzz {

/// Counts over all processes; in memory that they share. Pictures are wanted of every scene by
/// every integrator.
struct Counts {
  std::atomic<uint64_t> scenes{0}, refused{0}, wanted{0}, renders{0}, renders_refused{0},
      dropped{0}, with_lost_rays{0}, failures{0};
};

/// Where a worker is; in memory that it shares with its parent.
struct Position {
  std::atomic<uint64_t> seed{0};   ///< of the scene under way
  std::atomic<uint64_t> stage{0};  ///< as check_scene() tells
  std::atomic<uint64_t> steps{0};  ///< grows with every stage: while it does, nothing hangs
};

/// A process that checks the scenes of every `stride`-th seed from `first` to before `end`. What
/// ends it (a signal, a sanitizer, a hang) is told with its scene; then a new process goes on
/// behind it.
class Worker {
 public:
  Worker(uint64_t first, uint64_t end, uint64_t stride, std::string folder, bool tells_refusals,
         Counts& counts);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();

  /// Looks after the process; false once all is done.
  bool attend();

 private:
  void start(uint64_t first);
  [[noreturn]] void work(uint64_t first);
  void tell_end(int status, bool hung);

  uint64_t end_, stride_;
  std::string folder_;
  bool tells_refusals_;
  Counts& counts_;
  Position* position_;
  pid_t process_ = -1;
  uint64_t steps_seen_ = 0;
  double step_work_s_ = 0, step_begin_s_ = 0;  ///< when the stage began
};

/// "seed 17: what is wrong", the scene as XML, and how to see it again; to standard error.
void tell_failure(uint64_t seed, const std::string& what, const std::string& xml);

}  // namespace kaustik::fuzz
