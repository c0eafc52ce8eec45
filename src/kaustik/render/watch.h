#pragma once
#include <functional>
#include <thread>

namespace kaustik {

/// Calls `look` many times a second, from a thread of its own, while it lives: for work that tells
/// nothing of its progress for long.
class Watch {
 public:
  explicit Watch(std::function<void()> look);

 private:
  std::jthread thread_;
};

}  // namespace kaustik
