#pragma once
#include <exception>
#include <functional>
#include <thread>

namespace kaustik {

/// Calls `look` many times a second, from a thread of its own, while it lives: for work that tells
/// nothing of its progress for long. Once `look` has thrown, it is not called any more.
class Watch {
 public:
  explicit Watch(std::function<void()> look);
  Watch(const Watch&) = delete;  // its thread knows where it is
  Watch& operator=(const Watch&) = delete;
  /// Calls it no more, and throws what it has thrown. Without end() nobody hears of that.
  void end();

 private:
  std::exception_ptr failure_;  ///< of the thread while it runs
  std::jthread thread_;
};

}  // namespace kaustik
