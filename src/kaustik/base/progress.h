#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>

namespace kaustik {

/// Told what share of a piece of work is done, 0 to 1; often, from any thread, not always in order.
/// May be empty.
using ProgressFunction = std::function<void(double)>;

/// Progress of part `i` of `count` parts that are alike. `whole` must outlive it.
inline ProgressFunction part_of(const ProgressFunction& whole, uint32_t i, uint32_t count) {
  if (!whole) return {};
  return [&whole, i, count](double share) { whole((i + share) / count); };
}

/// Counts work that many threads do.
class WorkCounter {
 public:
  /// `listener` must outlive this.
  WorkCounter(uint64_t total, const ProgressFunction& listener)
      : total_(total), listener_(listener) {}
  void add(uint64_t work) {
    const uint64_t done = done_ += work;
    if (listener_ && total_ > 0) listener_(std::min(1.0, double(done) / double(total_)));
  }

 private:
  const uint64_t total_;
  const ProgressFunction& listener_;
  std::atomic<uint64_t> done_{0};
};

}  // namespace kaustik
