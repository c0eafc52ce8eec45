#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace kaustik {

/// Lets the threads of a render rest. Thread-safe.
class Gate {
 public:
  Gate() = default;
  Gate(const Gate&) = delete;
  Gate& operator=(const Gate&) = delete;

  void close();
  void open();
  bool is_closed() const { return is_closed_; }
  /// Returns at once where it is open; else waits until it is opened or a stop is requested.
  void pass(const std::stop_token& stop) {
    if (is_closed_) wait(stop);
  }
  /// How long it has been closed, in all, s.
  double closed_s() const;

 private:
  using Clock = std::chrono::steady_clock;
  void wait(const std::stop_token& stop);

  std::atomic<bool> is_closed_ = false;
  mutable std::mutex mutex_;
  std::condition_variable_any opened_;
  Clock::time_point since_;           ///< when it was closed, if it is
  std::atomic<double> before_s_ = 0;  ///< how long it was closed before
};

}  // namespace kaustik
