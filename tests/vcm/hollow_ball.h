#pragma once
// A matt ball seen from within, with a bare lamp in its middle. What light does there is known on
// paper: from any point of the wall it is scattered evenly over the whole wall, so light arrives
// evenly after any number of events, and so do the vertices of light paths.

#include <algorithm>
#include <cmath>

#include "kaustik/vcm/light_pass.h"
#include "kaustik/vcm/plan/plans.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik::test {

class HollowBall {
 public:
  static constexpr double albedo = 0.6;
  static constexpr double wall = 4 * double(pi);  ///< m²: the radius is 1 m
  static constexpr int pixels = 24;               ///< on a side

  /// `fov`: of the picture, degrees; of `side` pixels on a side.
  explicit HollowBall(double fov = 100, int side = pixels)
      : scene_(camera("0.2, -0.75, 0.1", "0, 1, 0.1", fov, side) +
               sphere("0, 0, 0", 1, diffuse("0.6, 0.6, 0.6"), true) + point_light("0, 0, 0", 1)),
        emission_(scene_.scene()) {}

  const TestScene& test_scene() const { return scene_; }
  const Scene& scene() const { return scene_.scene(); }
  const LightPathEmission& emission() const { return emission_; }

  /// What any point of the wall sends to the camera after so many events, W/(sr·m²), the sum over
  /// three lanes …
  static double radiance(int events) { return 3 / double(pi) * std::pow(albedo, events); }
  /// … and after so many and more.
  static double radiance_from(int events) { return radiance(events) / (1 - albedo); }
  /// Density of paths by area, with which light goes from one point of the wall to another.
  static double density() { return 1 / wall; }
  /// Vertices of a light path that may merge, on average, where paths have so many events at most:
  /// of its second one and those after it. Roulette leaves the fraction `albedo` after each event.
  static double mergeable(int most_events) {
    double sum = 0;
    for (int events = 1; events < most_events; ++events) sum += std::pow(albedo, events);
    return sum;
  }

  LightVertices trace(const PathWeights& weights, uint32_t paths, uint32_t pass, int most_events,
                      SplatBuffer& splats, const PixelPlans& plans = {},
                      float camera_samples = 1) const {
    PassReport report;
    return trace_light_vertices({.scene = scene(),
                                 .emission = emission_,
                                 .weights = weights,
                                 .components = ComponentSet::all(),
                                 .maximum_events = most_events,
                                 .light_paths = paths,
                                 .camera_samples = camera_samples,
                                 .plans = plans,
                                 .shrinkage = 1,
                                 .remembered_paths = paths},
                                Pass{1, pass, 1}, Stream::light_path, splats, {}, {}, report);
  }
  LightVertices trace(const PathWeights& weights, uint32_t paths, uint32_t pass,
                      int most_events) const {
    SplatBuffer nowhere(scene().film(), ComponentSet());
    return trace(weights, paths, pass, most_events, nowhere);
  }

 private:
  TestScene scene_;
  LightPathEmission emission_;
};

/// Merging beside all that camera paths find, of so many light paths in disks of that radius, m.
inline PathWeights merging_weights(uint32_t light_paths, float radius) {
  PathWeights::Settings settings;
  settings.techniques.merging = true;
  settings.light_paths = float(light_paths);
  settings.merge_area = pi * sqr(radius);
  settings.accepted_area = 0.01f;
  return PathWeights(settings);
}

/// Level of the checks below, each of which says how far off a value is that it would find; what
/// rounding may do is no difference.
inline constexpr double analytic_level = 1e-4, analytic_rounding = 1e-4;

/// The mean of independent values is what is known, by Student's t; one that is off by the part
/// `found` of it would fail.
inline void expect_known_mean(const std::string& what, const RunningStatistics& values,
                              double known, double found) {
  std::printf("  %-44s %.5g ± %.2g, known %.5g\n", what.c_str(), values.mean(),
              values.standard_error(), known);
  const double rounding = analytic_rounding * known;
  const double nearest = std::clamp(values.mean(), known - rounding, known + rounding);
  EXPECT_GT(t_test_p_value(values, nearest), analytic_level) << what;
  if (slow_build) return;
  const double twin = known * (values.mean() > known ? 1 - found : 1 + found);
  EXPECT_LT(t_test_p_value(values, twin), analytic_level) << what << " is too noisy to tell";
}

}  // namespace kaustik::test
