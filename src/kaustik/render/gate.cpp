#include "kaustik/render/gate.h"

namespace kaustik {

void Gate::close() {
  const std::lock_guard lock(mutex_);
  if (is_closed_) return;
  since_ = Clock::now();
  is_closed_ = true;
}

void Gate::open() {
  {
    const std::lock_guard lock(mutex_);
    if (!is_closed_) return;
    before_s_ = before_s_ + std::chrono::duration<double>(Clock::now() - since_).count();
    is_closed_ = false;
  }
  opened_.notify_all();
}

void Gate::wait(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  opened_.wait(lock, stop, [this] { return !is_closed_; });
}

double Gate::closed_s() const {
  // Threads ask that often.
  if (!is_closed_) return before_s_;
  const std::lock_guard lock(mutex_);
  const std::chrono::duration<double> now = Clock::now() - since_;
  return is_closed_ ? before_s_ + now.count() : before_s_.load();
}

}  // namespace kaustik
