// Direct light by shadow photons: biased, and how the bias goes.

#include "kaustik/base/warp.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr double lamp_height = 2, lamp_half = 0.25, lamp_radiance = 10;
constexpr double blocker_height = 1, floor_albedo = 0.5;

/// A square lamp over a floor; a black sheet below it covers x < 0, so the floor has light, shadow
/// and between them a penumbra as wide as the lamp.
std::string half_covered_floor() {
  return camera("2.2, 0, 0.8", "0, 0, 0", 24, 12) +
         flat("rectangle", scale("8, 8, 1"), diffuse("0.5, 0.5, 0.5")) +
         flat("rectangle", scale("2, 4, 1") + translate("-2, 0, 1"), diffuse("0, 0, 0")) +
         flat("rectangle", scale("0.25, 0.25, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 2"),
              diffuse("0, 0, 0") + area_light("10, 10, 10"));
}

/// Form factor from a point to a parallel rectangle at distance 1 with one corner over the point
/// and the other at (x, y), odd in both [Howell, Mengüç, Daun and Siegel 2020, B-3].
double corner_form_factor(double x, double y) {
  const double a = std::sqrt(1 + x * x), b = std::sqrt(1 + y * y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * std::numbers::pi);
}

/// Radiance of the floor at (x, y): the part of the lamp that the sheet leaves.
double floor_radiance(double x, double y) {
  // Lines from (x, 0) that pass the sheet's edge meet the lamp's plane here.
  const double edge = x - x * lamp_height / blocker_height;
  const double begin = std::clamp(edge, -lamp_half, lamp_half);
  const auto f = [&](double to_x, double to_y) {
    return corner_form_factor((to_x - x) / lamp_height, (to_y - y) / lamp_height);
  };
  const double factor = f(lamp_half, lamp_half) - f(begin, lamp_half) - f(lamp_half, -lamp_half) +
                        f(begin, -lamp_half);
  return floor_albedo * lamp_radiance * factor;
}

/// Mean radiance of a pixel.
double pixel_radiance(const Scene& scene, int x, int y) {
  constexpr int steps = 16;
  double sum = 0;
  for (int i = 0; i < steps * steps; ++i) {
    const Vec2f raster(float(x) + (float(i % steps) + 0.5f) / steps,
                       float(y) + (float(i / steps) + 0.5f) / steps);
    const Ray ray = scene.camera().sample_ray(raster, Camera::middle_of_lens());
    const float t = -ray.origin.z / ray.direction.z;
    const Vec3f at = ray.origin + ray.direction * t;
    sum += floor_radiance(double(at.x), double(at.y));
  }
  return sum / (steps * steps);
}

class Penumbra : public testing::Test {
 protected:
  Penumbra() : scene_(half_covered_floor()) {
    const Vec2i size = scene_.scene().film().crop_size;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) expected_.push_back(pixel_radiance(scene_.scene(), x, y));
    width_ = size.x;
    brightest_ = *std::max_element(expected_.begin(), expected_.end());
  }
  double expected(int x, int y) const { return expected_[size_t(y * width_ + x)]; }
  bool in_penumbra(int x, int y) const {
    return expected(x, y) > 0.02 * brightest_ && expected(x, y) < 0.9 * brightest_;
  }
  double expected_mean(const PixelWeight& weight) const {
    double sum = 0, weights = 0;
    for (int i = 0; i < int(expected_.size()); ++i) {
      const double w = weight(i % width_, i / width_);
      sum += w * expected_[size_t(i)];
      weights += w;
    }
    return sum / weights;
  }
  Passes rendered(int photons, int accurate_levels, double samples, int neighbors = 50) const {
    return render(scene_, "photonmap",
                  set("components", "direct") + set("light_sampling", "all") +
                      set("shadow_photons", photons) + set("shadow_neighbors", neighbors) +
                      set("shadow_accurate_levels", accurate_levels),
                  {samples, 5});
  }
  /// Root mean square over pixels of the error of the mean of all passes, over the brightest pixel.
  double error_of(const Passes& passes) const {
    double sum = 0;
    for (int y = 0; y < width_; ++y)
      for (int x = 0; x < width_; ++x) {
        const auto one = [&](int px, int py) { return px == x && py == y ? 1.0 : 0.0; };
        sum += std::pow(passes.mean({"direct"}, one).mean() - expected(x, y), 2);
      }
    return std::sqrt(sum / double(expected_.size())) / brightest_;
  }

  TestScene scene_;
  std::vector<double> expected_;
  int width_ = 0;
  double brightest_ = 0;
};

/// The closed form is right, and so are shadow rays.
TEST_F(Penumbra, ByShadowRays) {
  const PixelWeight all = [](int, int) { return 1.0; };
  const PixelWeight penumbra = [&](int x, int y) { return in_penumbra(x, y) ? 1.0 : 0.0; };
  const Passes passes = rendered(0, 1, 64);
  expect_mean("shadow rays", passes.mean({"direct"}, all), expected_mean(all));
  expect_mean("shadow rays, penumbra", passes.mean({"direct"}, penumbra), expected_mean(penumbra));
}

/// Where photons mix, shadow rays are traced: the penumbra is right.
TEST_F(Penumbra, Accurate) {
  const PixelWeight all = [](int, int) { return 1.0; };
  const PixelWeight penumbra = [&](int x, int y) { return in_penumbra(x, y) ? 1.0 : 0.0; };
  const Passes passes = rendered(50'000, 1, 64);
  expect_near_means("accurate", {passes.mean({"direct"}, all), expected_mean(all)}, 0.005);
  expect_near_means("accurate, penumbra",
                    {passes.mean({"direct"}, penumbra), expected_mean(penumbra)}, 0.005);
  EXPECT_LT(error_of(passes), 0.02);
}

/// Without shadow rays the photons' shares take their place.
TEST_F(Penumbra, Approximate) {
  const PixelWeight all = [](int, int) { return 1.0; };
  const PixelWeight penumbra = [&](int x, int y) { return in_penumbra(x, y) ? 1.0 : 0.0; };
  const Passes passes = rendered(50'000, 0, 16);
  expect_near_means("approximate", {passes.mean({"direct"}, all), expected_mean(all)}, 0.01);
  expect_near_means("approximate, penumbra",
                    {passes.mean({"direct"}, penumbra), expected_mean(penumbra)}, 0.01);
}

// Slow builds take too few samples to tell.
#ifndef KAUSTIK_SLOW_BUILD
/// The more photons, the smaller the disk over which shadows are smeared. Few neighbours, so that
/// all of them may be lit, or shadowed, by chance: that is where the accurate solution errs.
TEST_F(Penumbra, ErrorFallsWithThePhotons) {
  std::vector<double> accurate, approximate;
  for (const int photons : {200, 2'000, 20'000}) {
    accurate.push_back(error_of(rendered(photons, 1, 160, 5)));
    approximate.push_back(error_of(rendered(photons, 0, 160, 5)));
    std::printf("  %6d photons: error of the accurate solution %.4f, of the approximate %.4f\n",
                photons, accurate.back(), approximate.back());
  }
  const double by_rays = error_of(rendered(0, 1, 160));
  std::printf("  shadow rays: %.4f\n", by_rays);
  for (size_t i = 1; i < 3; ++i) {
    EXPECT_LT(accurate[i], 0.7 * accurate[i - 1]);
    EXPECT_LT(approximate[i], 0.7 * approximate[i - 1]);
    EXPECT_LT(accurate[i], approximate[i]);
  }
}
#endif

/// Gather rays take the approximate solution; and one light for each sample asks the photons too.
TEST(ShadowPhotons, IndirectLightByGatherRays) {
  const TestScene scene(
      camera("0, -0.8, 0", "0, 1, -0.2", 75, 12) +
      sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
      sphere("0.1, 0.1, 0.6", 0.2, diffuse("0, 0, 0") + area_light("10, 10, 10")) +
      sphere("0.2, 0.1, 0", 0.25, diffuse("0.2, 0.2, 0.2")));
  const std::string common = set("components", "indirect") + set("global_photons", 20'000) +
                             set("global_neighbors", 12) + set("irradiance_cache", false);
  const auto indirect = [&](const std::string& more) {
    return render(scene, "photonmap", common + more, {2, 2}).values({"indirect"});
  };
  for (const char* sampling : {"one", "all"}) {
    const std::string choice = set("light_sampling", sampling);
    expect_near_means(
        std::string("indirect, lights sampled: ") + sampling,
        Comparison::same_seed(indirect(choice + set("shadow_photons", 30'000)), indirect(choice)),
        0.005);
  }
}

/// Where light or shadow is sure no shadow ray is traced.
TEST(ShadowPhotons, SaveShadowRays) {
  const TestScene scene(half_covered_floor());
  constexpr int samples = 256, photons = 2'000;
  const auto rays = [&](int shadow_photons) {
    const auto method = scene.integrator(
        "photonmap", set("components", "direct") + set("shadow_photons", shadow_photons));
    SessionSettings settings;
    settings.passes = 1;
    settings.samples_per_pixel = samples;
    return double(Session(scene.scene(), *method, settings).run().rays);
  };
  const double camera_rays = 12 * 12 * samples;
  const double without = rays(0) - camera_rays;
  EXPECT_GT(without, 0.9 * camera_rays);
  const double with = rays(photons) - camera_rays;  // those of the photons count as well
  std::printf("  %.0f shadow rays without shadow photons, %.0f with\n", without, with);
  EXPECT_LT(with, 0.6 * without);
}

}  // namespace
}  // namespace kaustik
