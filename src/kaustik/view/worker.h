#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace kaustik::view {

/// A thread for what takes longer than the server's may be held up: one thing after the other.
class Worker {
 public:
  Worker();
  /// Ends what is being done; what waits is left out.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// From any thread. What `action` throws is lost.
  void run(std::function<void()> action);
  /// As the destructor does.
  void stop();

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> actions_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace kaustik::view
