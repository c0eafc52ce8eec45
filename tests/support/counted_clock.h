#pragma once
#include <atomic>
#include <cstdint>
#include <functional>

namespace kaustik::test {

/// A clock that goes on only where a test says so: how busy the machine is makes no difference.
class CountedClock {
 public:
  void advance(double ms) { nanoseconds_ += int64_t(ms * 1e6); }
  /// For SessionSettings::clock.
  std::function<double()> reader() const {
    return [this] { return double(nanoseconds_) * 1e-9; };
  }

 private:
  std::atomic<int64_t> nanoseconds_ = 0;
};

}  // namespace kaustik::test
