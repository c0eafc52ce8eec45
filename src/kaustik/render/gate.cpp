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
    before_ += Clock::now() - since_;
    is_closed_ = false;
  }
  opened_.notify_all();
}

void Gate::wait(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  opened_.wait(lock, stop, [this] { return !is_closed_; });
}

double Gate::closed_s() const {
  const std::lock_guard lock(mutex_);
  std::chrono::duration<double> all = before_;
  if (is_closed_) all += Clock::now() - since_;
  return all.count();
}

}  // namespace kaustik
