#include "kaustik/photon/lane_draw.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace kaustik {
namespace {

const std::vector<Spectrum> parts = {Spectrum(1, 0, 3, 0), Spectrum(2, 4, 0, 0),
                                     Spectrum(0, 1, 0, 0), Spectrum(5, 5, 1, 0)};

Spectrum sum_of(const std::vector<Spectrum>& of) {
  Spectrum sum;
  for (const Spectrum& part : of) sum += part;
  return sum;
}

LaneDraw drawn(float u) {
  LaneDraw draw(sum_of(parts), u);
  for (size_t i = 0; i < parts.size(); ++i) draw.offer(i, parts[i]);
  return draw;
}

/// In the mean over even numbers every part remains as often as its share of the lane is.
TEST(LaneDraw, LeavesWhatHoldsInTheMean) {
  constexpr int count = 100'000;
  const Spectrum sum = sum_of(parts);
  for (size_t only = 0; only < parts.size(); ++only) {
    std::array<double, Spectrum::lane_count> mean{};
    for (int i = 0; i < count; ++i) {
      const float u = (float(i) + 0.5f) / float(count);
      const Spectrum left = drawn(u).remaining(sum, [&](size_t part) { return part == only; });
      for (int lane = 0; lane < Spectrum::lane_count; ++lane)
        mean[size_t(lane)] += double(left[lane]) / count;
    }
    // Each part is drawn over one interval, with two ends.
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      EXPECT_NEAR(mean[size_t(lane)], double(parts[only][lane]), 2.0 * double(sum[lane]) / count)
          << only << " " << lane;
  }
}

TEST(LaneDraw, AllOrNothingIsNoNoise) {
  const Spectrum sum = sum_of(parts);
  for (const float u : {0.0f, 0.3f, 0.6f, 0x1.fffffep-1f}) {
    int asked = 0;
    const auto all = [&](size_t) { return ++asked > 0; };
    EXPECT_EQ(drawn(u).remaining(sum, all), sum) << u;
    EXPECT_LE(asked, 3) << u;
    EXPECT_TRUE(drawn(u).remaining(sum, [](size_t) { return false; }).is_zero()) << u;
  }
}

TEST(LaneDraw, ByRunningSums) {
  std::vector<Spectrum> running_sums;
  Spectrum sum;
  for (const Spectrum& part : parts) running_sums.push_back(sum += part);
  for (int i = 0; i <= 1000; ++i) {
    const float u = i < 1000 ? (float(i) + 0.5f) / 1000 : 0x1.fffffep-1f;
    for (size_t only = 0; only < parts.size(); ++only) {
      const auto holds = [&](size_t part) { return part == only; };
      EXPECT_EQ(LaneDraw(running_sums, u).remaining(sum, holds), drawn(u).remaining(sum, holds))
          << u << " " << only;
    }
  }
}

/// Where u of the sum is rounded to all of it.
TEST(LaneDraw, OfTheLeastFloats) {
  const std::vector<Spectrum> running_sums = {Spectrum(0.0f), Spectrum(1e-45f), Spectrum(1e-45f)};
  const Spectrum sum = running_sums.back();
  for (const float u : {0.0f, 0.9f, 0x1.fffffep-1f})
    EXPECT_EQ(LaneDraw(running_sums, u).remaining(sum, [](size_t part) { return part == 1; }), sum);
}

/// Parts that are passed over together change nothing.
TEST(LaneDraw, PassesOverManyAtOnce) {
  const Spectrum sum = sum_of(parts);
  int passed = 0;
  for (int i = 0; i < 1000; ++i) {
    const float u = (float(i) + 0.5f) / 1000;
    LaneDraw draw(sum, u);
    if (draw.pass_over(0, parts[0] + parts[1])) {
      ++passed;
    } else {
      draw.offer(0, parts[0]);
      draw.offer(1, parts[1]);
    }
    if (!draw.is_decided()) draw.offer(2, parts[2]);
    if (!draw.is_decided()) draw.offer(3, parts[3]);
    for (size_t only = 0; only < parts.size(); ++only) {
      const auto holds = [&](size_t part) { return part == only; };
      EXPECT_EQ(draw.remaining(sum, holds), drawn(u).remaining(sum, holds)) << u << " " << only;
    }
  }
  // Until the third lane, of which the first part has 3 of 4, is decided there.
  EXPECT_GT(passed, 200);
}

}  // namespace
}  // namespace kaustik
