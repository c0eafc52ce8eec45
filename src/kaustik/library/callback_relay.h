#pragma once
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "kaustik/library/boundary.h"

namespace kaustik::v0::details {

/// Calls functions of the host's, one at a time, and knows from which thread.
class CallbackRelay {
 public:
  /// Throws CallbackFailure with what the function throws.
  template <typename Function, typename... Arguments>
  void call(const Function& function, const Arguments&... arguments) {
    if (!function) return;
    // A function may cause another one to be called.
    const std::lock_guard lock(mutex_);
    const Inside inside(caller_);
    try {
      function(arguments...);
    } catch (...) {
      throw CallbackFailure{std::current_exception()};
    }
  }
  /// Whether this thread is in a function of the host's.
  bool is_here() const { return caller_ == std::this_thread::get_id(); }

 private:
  struct Inside {
    explicit Inside(std::atomic<std::thread::id>& of)
        : caller(of), before(of.exchange(std::this_thread::get_id())) {}
    ~Inside() { caller = before; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    std::atomic<std::thread::id>& caller;
    std::thread::id before;
  };

  std::recursive_mutex mutex_;
  std::atomic<std::thread::id> caller_;
};

}  // namespace kaustik::v0::details
