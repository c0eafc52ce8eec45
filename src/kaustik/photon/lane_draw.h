#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kaustik/base/spectrum.h"

namespace kaustik {

/// Draws one of many parts of a sum for each lane, in proportion to what the parts add there. What
/// is asked about that part alone then decides for the whole lane: in the mean that leaves of the
/// sum what all parts would have left for which it holds, and it is no noise where it holds for all
/// or for none. Parts have numbers below 2^31.
class LaneDraw {
 public:
  /// All lanes draw by the number `u` in [0, 1): most often they draw the same part.
  LaneDraw(const Spectrum& sum, float u)
      : left_(sum.lanes() > 0 ? (sum * u).lanes() : Register{-1, -1, -1, -1}),
        drawn_{none, none, none, none} {}

  /// The same by what the parts up to each of them add, the last of which is the sum: all of them
  /// were offered. At least one; sums don't fall.
  LaneDraw(std::span<const Spectrum> running_sums, float u) : LaneDraw(running_sums.back(), u) {
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const float at = left_[lane];
      const auto is_drawn = [&](size_t part) {
        return running_sums[part][lane] > at && (part == 0 || running_sums[part - 1][lane] <= at);
      };
      if (!(at >= 0)) continue;
      // Most often lanes draw the same part.
      if (lane > 0 && drawn_[lane - 1] != none && is_drawn(size_t(drawn_[lane - 1]))) {
        drawn_[lane] = drawn_[lane - 1];
        continue;
      }
      // u of a sum close to the least float may be rounded to all of it.
      const float below = std::min(at, std::nextafter(running_sums.back()[lane], 0.0f));
      const auto part =
          std::partition_point(running_sums.begin(), running_sums.end(),
                               [&](const Spectrum& sum) { return sum[lane] <= below; });
      drawn_[lane] = int32_t(part - running_sums.begin());
    }
    left_ = Register{-1, -1, -1, -1};
  }

  /// Whether what is offered further changes nothing.
  bool is_decided() const { return !any(left_ >= 0); }
  /// To be called for every part of the sum, in any order, until it is decided.
  void offer(size_t part, const Spectrum& value) {
    const Register of_part = value.lanes();
    const Integers takes = (of_part > 0) & (left_ >= 0);
    const auto number = int32_t(part);
    drawn_ = takes ? Integers{number, number, number, number} : drawn_;
    left_ = takes ? left_ - of_part : left_;
  }

  /// The same of several parts at once, `value` together and `part` one of them: false, and nothing
  /// is changed, if one of them may be drawn.
  bool pass_over(size_t part, const Spectrum& value) {
    if (any((left_ >= 0) & (left_ < value.lanes()))) return false;
    offer(part, value);
    return true;
  }
  /// `sum` in the lanes whose part holds(part). It is asked once where lanes drew the same.
  template <typename Holds>
  Spectrum remaining(Spectrum sum, const Holds& holds) const {
    int32_t asked = none;
    bool answer = false;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const int32_t part = drawn_[lane];
      if (part != none && part != asked) {
        answer = holds(size_t(part));
        asked = part;
      }
      if (part == none || !answer) sum.set(lane, 0);
    }
    return sum;
  }

 private:
  using Register = Spectrum::Register;
  using Integers = int32_t __attribute__((vector_size(16)));
  static constexpr int32_t none = -1;
  static bool any(Integers bits) { return (bits[0] | bits[1] | bits[2] | bits[3]) != 0; }

  Register left_;  ///< of what is drawn by; negative: decided
  Integers drawn_;
};

}  // namespace kaustik
