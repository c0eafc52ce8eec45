#pragma once
#include <memory>

namespace kaustik {

/// While it lives the loops of the whole program, with_threads() included, take at most so many
/// threads. For programs that own their process: by itself the scheduler takes as many as the
/// affinity mask allows, and knows nothing of quotas.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace kaustik
