#include "kaustik/view/worker.h"

#include <utility>

namespace kaustik::view {

Worker::Worker() : thread_([this] { work(); }) {}

Worker::~Worker() { stop(); }

void Worker::stop() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  actions_.clear();
}

void Worker::run(std::function<void()> action) {
  {
    const std::lock_guard lock(mutex_);
    if (ends_) return;
    actions_.push_back(std::move(action));
  }
  changed_.notify_all();
}

void Worker::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ends_ || !actions_.empty(); });
    if (ends_) return;
    std::function<void()> action = std::move(actions_.front());
    actions_.pop_front();
    lock.unlock();
    try {
      action();
    } catch (...) {
      // Who asked is told when the reply is destroyed.
    }
    action = nullptr;
    lock.lock();
  }
}

}  // namespace kaustik::view
