// Pictures of irradiance: closed forms, whatever the surface is made of.

#include "tests/integrator/media_scenes.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A picture of irradiance.
std::string meter(const std::string& origin, const std::string& target, double fov, int size = 8,
                  const std::string& up = "0, 1, 0") {
  std::string text = camera(origin, target, fov, size, up);
  return text.insert(text.find("<rfilter"), set("quantity", "irradiance"));
}

std::string thin_estimates(int photons) {
  return set("global_photons", photons) + set("caustic_photons", photons) +
         set("global_neighbors", 12) + set("caustic_neighbors", 12);
}

/// A picture of the square |x|, |y| < 0.4 of the plane z = 0, from above or below …
std::string meter_over_square(const char* z = "0.4") {
  return meter(fmt::format("0, 0, {}", z), "0, 0, 0", 90);
}
/// … and the mean of irradiance(squared distance from the axis) over it.
template <typename Irradiance>
double mean_over_square(const Irradiance& irradiance) {
  constexpr int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      sum += irradiance(std::pow(0.8 * ((i + 0.5) / n - 0.5), 2) +
                        std::pow(0.8 * ((j + 0.5) / n - 0.5), 2));
  return sum / (n * n);
}

const std::string bumped_matt =
    R"(<bsdf type="bumpmap"><texture type="waves"><float name="amplitude" value="0.05"/>
    <float name="wavelength" value="0.3"/></texture><bsdf type="diffuse"/></bsdf>)";

// ---------------------------------------------------------------- a black disk lamp over a floor

/// Of radius a and radiance L at height h; at distance d from the axis
/// E = πL/2 (1 − (d² + h² − a²)/√((d² + h² + a²)² − 4a²d²)).
class IrradianceUnderDisk : public testing::TestWithParam<const char*> {
 protected:
  static double expected() {
    constexpr double a = 0.5, h = 1, radiance = 4;
    return mean_over_square([&](double d_sq) {
      const double s = d_sq + h * h + a * a;
      return std::numbers::pi * radiance / 2 *
             (1 - (d_sq + h * h - a * a) / std::sqrt(s * s - 4 * a * a * d_sq));
    });
  }
  static TestScene scene(const std::string& floor) {
    return TestScene(meter_over_square() + flat("rectangle", scale("2, 2, 1"), floor) +
                     flat("disk",
                          scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1"),
                          diffuse("0, 0, 0") + area_light("4, 4, 4")));
  }
};

TEST_P(IrradianceUnderDisk, IsTheSameOnAnyFloor) {
  const std::string type = GetParam();
  std::vector<std::pair<const char*, std::string>> floors = {
      {"matt", diffuse("0.1, 0.2, 0.3")}, {"mirror", mirror()}, {"bumped", bumped_matt}};
  const bool is_slow = type == "lighttracer";
  if (!is_slow) floors.insert(floors.end(), {{"glass", glass()}, {"glossy", ggx(0.2)}});
  const std::string parameters = type == "photonmap" ? thin_estimates(500) : "";
  for (const auto& [name, floor] : floors) {
    const Passes passes = render(scene(floor), type, parameters, {is_slow ? 1500.0 : 32.0});
    expect_mean(type + " disk over " + name, passes.mean({""}), expected());
    EXPECT_EQ(passes.mean({"emission"}).mean(), 0);
    EXPECT_EQ(passes.mean({"specular"}).mean(), 0);
  }
}
INSTANTIATE_TEST_SUITE_P(All, IrradianceUnderDisk,
                         testing::Values("path", "photonmap", "lighttracer", "raytracing",
                                         "localphong", "ppm", "auto"));

/// A sphere of radius a and radiance L at height h, its centre over the point: E = πL a²/h².
TEST(IrradianceUnderSphere, OnTheAxis) {
  const TestScene scene(meter("0, 0.1, 0.3", "0, 0, 0", 1, 4) +
                        flat("rectangle", scale("2, 2, 1"), diffuse("0, 0, 0")) +
                        sphere("0, 0, 2", 0.5, diffuse("0, 0, 0") + area_light("3")));
  for (const char* type : {"path", "photonmap", "ppm", "auto"})
    expect_mean(std::string(type) + " sphere", render(scene, type, "", {64}).mean({""}),
                std::numbers::pi * 3 * 0.25 / 4);
}

// ---------------------------------------------------------------- furnace with mirrors

/// In a closed sphere that emits 1 and reflects ρ, radiance is 1/(1 − ρ) from everywhere, also by
/// perfect mirrors, and irradiance π/(1 − ρ): direct light, caustics (by the other mirror) and
/// indirect light together.
class IrradianceInFurnace : public testing::Test {
 protected:
  static constexpr double rho = 0.5;
  static TestScene scene(const std::string& mirrors) {
    return TestScene(meter("-0.05, 0, 0.4", "-0.05, 0, 0", 90) +
                     sphere("0, 0, 0", 1.5, diffuse("0.5, 0.5, 0.5") + area_light("1"), true) +
                     flat("rectangle", scale("0.6, 0.6, 1"), mirrors) +
                     flat("rectangle",
                          scale("0.6, 0.6, 1") + rotate("0, 1, 0", -90) + translate("0.6, 0, 0.6"),
                          mirrors));
  }
  static void check(const std::string& type, const Passes& passes) {
    expect_mean(type + " furnace", passes.mean({""}), std::numbers::pi / (1 - rho));
    EXPECT_GT(passes.mean({"caustic"}).mean(), 0.1) << type;
  }
};

TEST_F(IrradianceInFurnace, Path) { check("path", render(scene(mirror()), "path", "", {64})); }
TEST_F(IrradianceInFurnace, LightTracer) {
  check("lighttracer", render(scene(mirror()), "lighttracer", "", {5000}));
}
TEST_F(IrradianceInFurnace, PhotonMap) {
  check("photonmap",
        render(scene(mirror()), "photonmap", thin_estimates(40'000), {16, 1, 2 * measured_passes}));
}
TEST_F(IrradianceInFurnace, PhotonMapWithoutCache) {
  check("photonmap without cache",
        render(scene(mirror()), "photonmap",
               thin_estimates(40'000) + set("irradiance_cache", false), {16}));
}

TEST_F(IrradianceInFurnace, PpmLong) {
  check("ppm",
        render(scene(mirror()), "ppm", set("light_paths", 16.0) + set("radius", 0.1), {100}));
}
TEST_F(IrradianceInFurnace, Auto) { check("auto", render(scene(mirror()), "auto", "", {64})); }

/// Where the picture shows nothing there is no surface, and what is beyond the scene is not on any.
TEST(Irradiance, IsZeroBeyondTheScene) {
  const TestScene scene(meter("0, 0, 0", "0, 0, 1", 40) + far_shape + constant_light(1));
  for (const char* type : {"path", "photonmap", "ppm", "auto"})
    EXPECT_EQ(render(scene, type).mean({""}).mean(), 0) << type;
}

/// From the back a surface shows the irradiance of its back.
TEST(Irradiance, IsThatOfTheSideWhichIsSeen) {
  const auto from = [](const char* z) {
    return TestScene(meter_over_square(z) +
                     flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) +
                     point_light("0, 0, -2", 6));
  };
  const double expected =
      mean_over_square([](double d_sq) { return 6 * 2 / std::pow(d_sq + 4, 1.5); });
  for (const std::string type : {"path", "photonmap", "lighttracer", "ppm", "auto"}) {
    EXPECT_EQ(render(from("0.4"), type).mean({""}).mean(), 0) << type;
    const double samples = type == "lighttracer" ? 400 : 16;
    expect_mean(type + " back", render(from("-0.4"), type, "", {samples}).mean({""}), expected);
  }
}

// ---------------------------------------------------------------- media

/// In an absorbing medium light loses its share on its way to the surface, and nothing on the
/// camera's: E = I h/d³ exp(−σ d).
TEST(Irradiance, OfWhatMediaLetThroughLong) {
  const std::string water = medium("", "0.2, 0.2, 0.2", "0, 0, 0");
  std::string lamp = point_light("0, 0, 2", 5);
  lamp.insert(lamp.find("<point"), water);
  const TestScene scene(camera_in(water, meter_over_square()) +
                        flat("rectangle", scale("2, 2, 1"), diffuse("0.5, 0.5, 0.5")) + lamp);
  const double expected = mean_over_square([](double d_sq) {
    const double d = std::sqrt(d_sq + 4);
    return 5 * 2 / (d * d * d) * std::exp(-0.2 * d);
  });
  for (const std::string type : {"path", "photonmap", "lighttracer", "ppm", "auto"}) {
    const double samples = type == "lighttracer" ? 6000 : 16;
    const Passes passes = render(scene, type, "", {samples});
    expect_mean(type + " in water", passes.mean({""}), expected);
    EXPECT_EQ(passes.mean({"volume"}).mean(), 0) << type;
  }
}

}  // namespace
}  // namespace kaustik
