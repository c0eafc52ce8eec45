#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

#include "kaustik/base/spectrum.h"

namespace kaustik {

/// Draws one of many parts of a sum for each lane, in proportion to what the parts add there. What
/// is asked about that part alone then decides for the whole lane: in the mean that leaves of the
/// sum what all parts would have left for which it holds, and it is no noise where it holds for all
/// or for none.
class LaneDraw {
 public:
  /// All lanes draw by the number `u` in [0, 1): most often they draw the same part.
  LaneDraw(const Spectrum& sum, float u) {
    for (size_t lane = 0; lane < lanes; ++lane)
      left_[lane] = sum[int(lane)] > 0 ? u * sum[int(lane)] : -1.0f;
    drawn_.fill(none);
  }

  /// Whether what is offered further changes nothing.
  bool is_decided() const {
    return std::all_of(left_.begin(), left_.end(), [](float left) { return left < 0; });
  }
  /// To be called for every part of the sum, in any order, until it is decided.
  void offer(size_t part, const Spectrum& value) {
    for (size_t lane = 0; lane < lanes; ++lane) {
      const float of_lane = value[int(lane)];
      if (!(of_lane > 0) || !(left_[lane] >= 0)) continue;
      left_[lane] -= of_lane;
      drawn_[lane] = part;
    }
  }

  /// The same of several parts at once, `value` together and `part` one of them: false, and nothing
  /// is changed, if one of them may be drawn.
  bool pass_over(size_t part, const Spectrum& value) {
    for (size_t lane = 0; lane < lanes; ++lane)
      if (left_[lane] >= 0 && left_[lane] < value[int(lane)]) return false;
    offer(part, value);
    return true;
  }
  /// `sum` in the lanes whose part holds(part). It is asked once where lanes drew the same.
  template <typename Holds>
  Spectrum remaining(Spectrum sum, const Holds& holds) const {
    size_t asked = none;
    bool answer = false;
    for (size_t lane = 0; lane < lanes; ++lane) {
      const size_t part = drawn_[lane];
      if (part != none && part != asked) {
        answer = holds(part);
        asked = part;
      }
      if (part == none || !answer) sum.set(int(lane), 0);
    }
    return sum;
  }

 private:
  static constexpr size_t lanes = size_t(Spectrum::lane_count), none = ~size_t(0);
  std::array<float, lanes> left_{};
  std::array<size_t, lanes> drawn_{};
};

}  // namespace kaustik
