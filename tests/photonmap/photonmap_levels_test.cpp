// Recursion levels of the camera's path: how far they reach, against series by hand, and what
// falls with them.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A sphere seen from inside whose wall of reflectance 1/2 shines with radiance 1 everywhere: light
/// of n bounces has the radiance 2⁻ⁿ. The camera sees it directly, or through a thin shell of
/// nothing (a boundary without refraction), which is one specular event.
std::string furnace(bool through_shell, int size = 4) {
  return camera("0, 0, 0", "0, 1, 0", 60, size) +
         sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5") + area_light("1, 1, 1"), true) +
         (through_shell ? sphere("0, 0, 0", 0.01, glass(1)) : "");
}
std::string light_paths_of(int max_light_level) {
  return set("max_light_level", max_light_level) + set("precompute_stride", 0) +
         set("global_photons", int(50'000 * sample_share())) + set("global_neighbors", 100) +
         set("caustic_neighbors", 0) + set("importance_floor", 1.0) +
         set("irradiance_cache", false) + set("diffuse_samples", 2);
}
/// Photons of one bounce: in the global map the light has the radiance 1/2 before it is reflected.
std::string one_bounce(int max_eye_level, bool count_specular) {
  return light_paths_of(1) + set("max_eye_level", max_eye_level) +
         set("count_specular_levels", count_specular);
}
constexpr double ground = 1 + 1 / 2.0;  // what shines, and direct light

/// The map knows light of one bounce, and every level of gathering adds one more: 2⁻² + 2⁻³ + ….
TEST(PhotonMapLevels, GatherRaysGatherAgain) {
  const TestScene scene(furnace(false));
  double expected = 1 / 4.0;
  for (int level = 1; level <= 3; ++level) {
    expected += std::pow(0.5, level + 2);
    expect_mean(fmt::format("{} levels of gathering", level),
                render(scene, "photonmap", one_bounce(level, level > 1), {4}).mean({"indirect"}),
                expected);
  }
}
/// Photons of two bounces bring one more term.
TEST(PhotonMapLevels, LightPathsEndAtTheirLimit) {
  const TestScene scene(furnace(false));
  double expected = 1 / 4.0 + 1 / 8.0;
  for (int level = 1; level <= 3; ++level, expected += std::pow(0.5, level + 2))
    expect_mean(fmt::format("light paths of {} events", level),
                render(scene, "photonmap", light_paths_of(level), {4}).mean({"indirect"}),
                expected);
}
/// With no level at all, what the camera sees is gathered all the same.
TEST(PhotonMapLevels, TheFirstSurfaceIsNeverApproximated) {
  const TestScene scene(furnace(false));
  expect_mean("max_eye_level = 0",
              render(scene, "photonmap", one_bounce(0, true), {4}).mean({"indirect"}), 3 / 8.0);
}
/// Unless nothing is gathered: then the map is shown there, too, with its light of one bounce.
TEST(PhotonMapLevels, WithoutGatheringTheFirstSurfaceShowsTheMap) {
  // All of the sphere, for the map's noise.
  const std::string all_around =
      "<sensor type=\"spherical\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"24\"/>"
      "<integer name=\"height\" value=\"12\"/><rfilter type=\"box\"/></film></sensor>";
  const std::string inside = furnace(false);
  const TestScene scene(all_around + inside.substr(inside.find("<shape")));
  const std::string parameters = one_bounce(1, false) + set("gather", false);
  expect_mean("gather = false", render(scene, "photonmap", parameters, {1}).mean({"indirect"}),
              1 / 4.0);
}
/// Through the shell the wall is at the second level.
TEST(PhotonMapLevels, AtTheLimitTheGlobalMapIsShown) {
  const TestScene scene(furnace(true));
  const auto specular = [&](int level, bool count_specular) {
    return render(scene, "photonmap", one_bounce(level, count_specular), {4}).mean({"specular"});
  };
  expect_mean("estimate at level 1", specular(1, true), ground + 1 / 4.0);
  expect_mean("gathering at level 1", specular(2, true), ground + 3 / 8.0);
  expect_mean("specular events that do not count", specular(1, false), ground + 3 / 8.0);
  expect_mean("no levels, but specular events do not count", specular(0, false), ground + 1 / 4.0);
  EXPECT_EQ(specular(0, true).mean(), 0);  // specular light is left out there
}
TEST(PhotonMapLevels, ThesisPresetCountsAllEvents) {
  const TestScene scene(furnace(true));
  const std::string thesis = set("preset", "thesis") + set("specular_sampling", "perfect") +
                             set("specular_samples", 1) + set("max_light_level", 1) +
                             set("minimum_radiance", 0.0) + set("global_neighbors", 100);
  expect_mean("thesis, estimate at level 1",
              render(scene, "photonmap", thesis, {16}).mean({"specular"}), ground + 1 / 4.0);
}

/// What is seen through the shell with half the counts is to the bit what half the counts give.
class LevelOfDetailTest : public testing::Test {
 protected:
  explicit LevelOfDetailTest(const std::string& objects = "")
      : scene_(camera("0, -0.4, 0", "0, 1, -0.2", 75, 8) + sphere("0, -0.4, 0", 1e-4, glass(1)) +
               sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
               sphere("0.1, 0.1, 0.6", 0.2, diffuse("0, 0, 0") + area_light("10, 10, 10")) +
               objects) {}

  struct Counts {
    int lights, caustic, gathers, global;
  };
  Image picture(const Counts& c, const std::string& detail) const {
    return render(scene_, "photonmap",
                  set("light_samples", c.lights) + set("caustic_neighbors", c.caustic) +
                      set("diffuse_samples", c.gathers) + set("global_neighbors", c.global) +
                      set("global_photons", 2000) + set("caustic_photons", 20000) +
                      set("caustic_radius", 0.5) + set("global_radius", 0.2) +
                      set("irradiance_cache", false) + set("precompute_stride", 0) + detail,
                  {4, 1, 1})
        .images()[0];
  }
  static double difference(const Image& a, const Image& b) {
    double sum = 0;
    const int channel = a.find_channel("specular.G");
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x)
        sum += std::fabs(double(a.at(x, y, channel)) - double(b.at(x, y, channel)));
    return sum;
  }
  TestScene scene_;
};

/// With a mirror ball behind the camera.
class LevelOfDetailOfCaustics : public LevelOfDetailTest {
 protected:
  LevelOfDetailOfCaustics() : LevelOfDetailTest(sphere("0, -0.75, 0", 0.15, mirror())) {}
  void expect_scaled(const std::string& detail) const {
    // Without gather rays: they end at the level behind, where a quarter is left.
    const Counts full{8, 40, 8, 0}, half{4, 20, 8, 0};
    EXPECT_EQ(difference(picture(full, detail), picture(half, "")), 0);
    EXPECT_NE(difference(picture(full, detail), picture(full, "")), 0);
    // Each of the two has its effect.
    for (const Counts& one : {Counts{8, 20, 8, 0}, Counts{4, 40, 8, 0}})
      EXPECT_NE(difference(picture(full, detail), picture(one, "")), 0);
  }
};
TEST_F(LevelOfDetailOfCaustics, LightSamplesAndCausticPhotons) {
  expect_scaled(set("level_of_detail", "exponential") + set("level_factor", 0.5));
  expect_scaled(set("level_of_detail", "linear") + set("level_factor", 0.5));
}
/// Gather rays from the wall, at the second level, end at the third: there a quarter of the photons
/// is found, or by the linear factor of 1/4 half of them, where three quarters of the rays were
/// sent.
TEST_F(LevelOfDetailTest, GatherRaysAndGlobalPhotons) {
  const auto check = [&](const std::string& detail, const Counts& scaled) {
    const Counts full{1, 0, 8, 40};
    EXPECT_EQ(difference(picture(full, detail), picture(scaled, "")), 0) << detail;
    EXPECT_NE(difference(picture(full, detail), picture({1, 0, 8, scaled.global}, "")), 0);
    EXPECT_NE(difference(picture(full, detail), picture({1, 0, scaled.gathers, 40}, "")), 0);
  };
  check(set("level_of_detail", "exponential") + set("level_factor", 0.5), {1, 0, 4, 10});
  check(set("level_of_detail", "linear") + set("level_factor", 0.25), {1, 0, 6, 20});
}

/// Rays that the cache costs where all its points are at the second level.
uint64_t cache_rays(const TestScene& scene, const std::string& parameters) {
  const auto integrator = scene.integrator("photonmap", parameters);
  SplatBuffer splats(scene.scene().film(), ComponentSet());
  return integrator->prepare({1, 0, 1}, splats, {}, {})->report.rays;
}
/// Each level adds as many rays as the first, whatever their number; GatherRaysGatherAgain tells
/// that the mean stays.
TEST(PhotonMapLevels, GatherRaysDoNotMultiply) {
  const TestScene scene(furnace(false));
  const auto rays = [&](int level) {
    const std::string parameters = set("max_eye_level", level) + set("global_photons", 1000) +
                                   set("caustic_photons", 0) + set("cache_samples", 16) +
                                   set("cache_minimum_spacing", 2.0) +
                                   set("cache_maximum_spacing", 2.0);
    return double(cache_rays(scene, parameters) -
                  cache_rays(scene, parameters + set("irradiance_cache", false)));  // the photons'
  };
  EXPECT_GT(rays(2), 1.3 * rays(1));
  EXPECT_LT(rays(6), 8 * rays(1));
}
TEST(LevelOfDetail, QualityOfTheIrradianceCache) {
  const std::string room =
      flat("rectangle", scale("1, 1, 1"), diffuse("0.5, 0.5, 0.5")) +
      flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), diffuse("0.5, 0.5, 0.5")) +
      sphere("0.2, 0.2, 0.3", 0.2, diffuse("0.5, 0.5, 0.5")) + point_light("0, -0.5, 1.5", 3);
  const std::string camera_here = camera("0, -2, 1", "0, 0.3, 0.4", 50, 32);
  const std::string parameters = set("global_photons", 1000) + set("caustic_photons", 0) +
                                 set("cache_samples", 16) + set("cache_quality", 0.1) +
                                 set("cache_minimum_spacing", 0.1) +
                                 set("global_neighbors", 2);  // as few as at any level
  const TestScene direct(camera_here + room);
  const TestScene through_shell(camera_here + room + sphere("0, -2, 1", 1e-3, glass(1)));
  for (const char* detail : {"exponential", "linear"}) {
    const std::string halved = set("level_of_detail", detail) + set("level_factor", 0.5);
    const auto rays = [&](const TestScene& scene, const std::string& more) {
      return double(cache_rays(scene, parameters + more));
    };
    EXPECT_EQ(rays(direct, halved), rays(direct, "")) << detail;
    EXPECT_LT(rays(through_shell, halved), 0.8 * rays(through_shell, "")) << detail;
  }
}

}  // namespace
}  // namespace kaustik
