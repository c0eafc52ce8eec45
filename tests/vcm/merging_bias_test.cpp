// The bias of merging is estimated well, and not too low.

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

/// A pass's bias, and what it is estimated to be, as if it grew by the radius, W/(sr·m²).
double bias_of(double within) {
  return albedo / std::numbers::pi * (merged(within) - irradiance(0));
}
double estimated_bias_of(double within) {
  return albedo / std::numbers::pi * 2 * (merged(within) - merged(within / 2));
}

TEST(MergingBias, IsEstimatedAsIfItGrewByTheRadiusLong) {
  const TestScene scene = floor_below_a_lamp();
  // One sample in four tells of the bias: in fours, and as many for every pixel, it is one of them
  // and not by chance two or none, which would be most of the noise.
  const Passes found =
      render(scene, "ppm",
             set("radius", radius) + set("light_paths", 500.0) + set("adaptive", false), {96, 4});
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
  // It grows by the area here: 3/2, and a little less since not quite.
  EXPECT_NEAR(mean_estimate / mean_bias, 1.4, 0.1);
  // Both to a few percent of the bias, so that an estimate which is off by a factor fails.
  for (const RunningStatistics* off : {&true_bias, &estimate}) {
    EXPECT_NEAR(off->mean() / mean_bias, 0, slow_build ? 0.1 : 0.02);
    EXPECT_LT(off->standard_error(), (slow_build ? 0.03 : 0.01) * std::fabs(mean_bias));
  }
}

/// A mirror throws light on the floor; the camera sees an edge of that. At a step merging is off by
/// up to half of the light, and the error must tell of it though signs differ on the two sides.
TEST(MergingBias, EdgesOfLightAreInTheError) {
  constexpr int size = 24;
  constexpr double lamp_z = 0.2, mirror_size = 0.25, view = 0.3;
  constexpr double height = 2 - lamp_z;  // of the lamp's mirror image
  constexpr double edge = mirror_size * height / (height - 1);
  const TestScene scene(camera(fmt::format("{}, 0, 0.4", edge), fmt::format("{}, 0, 0", edge),
                               2 * std::atan(view / 2 / 0.4) * 180 / std::numbers::pi, size,
                               "0, 1, 0") +
                        flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) +
                        flat("rectangle", scale("0.25, 0.25, 1") + translate("0, 0, 1"), mirror()) +
                        point_light("0, 0, 0.2", 1));
  const auto integrator = scene.integrator(
      "ppm", set("radius", 0.06) + set("light_paths", 50.0) + set("components", "caustic"));
  SessionSettings settings;
  settings.passes = replicate_count;
  settings.samples_per_pass = slow_build ? 1 : 4;
  Session session(scene.scene(), *integrator, settings);
  session.run();
  const Image image = session.film().image();
  const int light = image.find_channel("G"), error = image.find_channel("error.G");
  double true_sq = 0, told_sq = 0;
  int count = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double at_x = edge + view * ((x + 0.5) / size - 0.5),
                   at_y = view * (0.5 - (y + 0.5) / size);
      if (std::fabs(at_x - edge) > 0.05) continue;
      const double lit =
          at_x < edge ? height * std::pow(height * height + at_x * at_x + at_y * at_y, -1.5) : 0;
      true_sq += std::pow(double(image.at(x, y, light)) - albedo / std::numbers::pi * lit, 2);
      told_sq += std::pow(double(image.at(x, y, error)), 2);
      ++count;
    }
  const double true_rms = std::sqrt(true_sq / count), told_rms = std::sqrt(told_sq / count);
  std::printf("  error at the edge %.4f, told %.4f\n", true_rms, told_rms);
  EXPECT_GT(told_rms, 0.3 * true_rms);
  EXPECT_LT(told_rms, 1.5 * true_rms);
}

}  // namespace
}  // namespace kaustik
