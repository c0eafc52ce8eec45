#include "kaustik/render/watch.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace kaustik {
namespace {

constexpr std::chrono::milliseconds interval(20);

void watch(const std::stop_token& ended, const std::function<void()>& look) {
  std::mutex mutex;
  std::condition_variable_any end;
  std::unique_lock lock(mutex);
  while (!end.wait_for(lock, ended, interval, [&] { return ended.stop_requested(); })) look();
}

}  // namespace

Watch::Watch(std::function<void()> look)
    : thread_([this, look = std::move(look)](const std::stop_token& ended) {
        try {
          watch(ended, look);
        } catch (...) {
          failure_ = std::current_exception();
        }
      }) {}

void Watch::end() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace kaustik
