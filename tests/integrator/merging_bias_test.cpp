// The bias of merging is what it is estimated to be.

#include "kaustik/photon/photon_map.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double radius = 0.6, albedo = 0.5, half_view = 0.003;

/// A floor 1 m below a lamp, whose light comes through a pane that does not bend it.
TestScene floor_below_a_lamp() {
  return TestScene(camera("0, 0, 0.4", "0, 0, 0",
                          2 * std::atan(half_view / 0.4) * 180 / std::numbers::pi, 8, "0, 1, 0") +
                   flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) +
                   flat("rectangle", scale("9, 9, 1") + translate("0, 0, 0.5"), glass(1.00001)) +
                   point_light("0, 0, 1", 1));
}

double irradiance(double distance_sq) { return std::pow(1 + distance_sq, -1.5); }

/// What merging within this radius sees at the foot of the lamp: the mean by 2/π (1 − ρ²).
double merged(double within) {
  constexpr int n = 2000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double share = (i + 0.5) / n;  // of the area
    sum += 2 * (1 - share) * irradiance(share * within * within) / n;
  }
  return sum;
}

/// A pass's bias, and what it is estimated to be if it grows by the area, W/(sr·m²).
double bias_of(double within) {
  return albedo / std::numbers::pi * (merged(within) - irradiance(0));
}
double estimated_bias_of(double within) {
  return albedo / std::numbers::pi * 2 * (merged(within) - merged(within * std::sqrt(0.5)));
}

TEST(MergingBias, IsWhatItIsEstimatedToBe) {
  const TestScene scene = floor_below_a_lamp();
  const Passes found =
      render(scene, "ppm", set("radius", radius) + set("light_paths", 400.0), {4, 5});
  const std::vector<double> light = found.values({"caustic"}), bias = found.values({"bias"});
  const double lamp = albedo / std::numbers::pi * irradiance(0);
  RunningStatistics true_bias, estimate;  // less what they should be
  double mean_bias = 0, mean_estimate = 0;
  for (uint32_t pass = 0; pass < light.size(); ++pass) {
    const double within = double(pass_radius(float(radius), pass));
    mean_bias += bias_of(within) / double(light.size());
    mean_estimate += estimated_bias_of(within) / double(light.size());
    true_bias.add((light[pass] - lamp) - bias_of(within));
    estimate.add(bias[pass] - estimated_bias_of(within));
  }
  // As a light that is merged is darker than the lamp's foot, both are negative.
  std::printf(
      "  bias over light %.4f, off by %.4f ± %.4f of it; estimate %.4f, off by %.4f ± %.4f\n",
      mean_bias / lamp, true_bias.mean() / mean_bias,
      true_bias.standard_error() / std::fabs(mean_bias), mean_estimate / lamp,
      estimate.mean() / mean_bias, estimate.standard_error() / std::fabs(mean_bias));
  EXPECT_LT(mean_bias, -0.05 * lamp);
  EXPECT_NEAR(mean_estimate / mean_bias, 1, 0.2);
  // Both to a few percent of the bias, so that an estimate which is off by a factor fails.
  for (const RunningStatistics* off : {&true_bias, &estimate}) {
    EXPECT_NEAR(off->mean() / mean_bias, 0, slow_build ? 0.1 : 0.02);
    EXPECT_LT(off->standard_error(), 0.01 * std::fabs(mean_bias));
  }
}

}  // namespace
}  // namespace kaustik
