// Lamps with textures: every method finds the same light from them.

#include "kaustik/base/warp.h"
#include "kaustik/photon/emission/emission.h"
#include "kaustik/transport/direct_light.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Bright squares among black ones: black in the middle of the uv square's left half, say.
std::string checkered(double repeats, double radiance, bool two_sided = false) {
  return fmt::format(
             R"(<emitter type="area"><texture name="radiance" type="checkerboard">
      <rgb name="color0" value="0, 0, 0"/><rgb name="color1" value="1, 0.8, 0.3"/>
      <transform name="to_uv"><scale value="{}"/></transform></texture>)",
             repeats) +
         set("scale", radiance) + set("two_sided", two_sided) + "</emitter>";
}
const std::string black = diffuse("0");
constexpr uint32_t samples_of_a_replicate = slow_build ? 4096 : 16384;

/// A glossy floor in a room under a panel and a ball, both checkered.
std::string textured_room() {
  return camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 8) +
         flat("rectangle", scale("2, 2, 1"), phong(0.4, 0.3, 6)) +
         flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1.5, 0"), diffuse("0.6")) +
         flat("rectangle", scale("0.5, 0.3, 1") + rotate("1, 0, 0", 180) + translate("0, 0.4, 1.1"),
              black + checkered(2, 12)) +
         sphere("-0.5, 0, 0.35", 0.25, black + checkered(4, 6));
}

TEST(TexturedLights, EveryMethodFindsTheirLight) {
  const TestScene scene(textured_room());
  const RunningStatistics by_path = render(scene, "path", set("max_depth", 3), {600, 1}).mean({""});
  expect_equal_means("lighttracer",
                     render(scene, "lighttracer", set("max_depth", 3), {1000, 2}).mean({""}),
                     by_path);
  const RunningStatistics direct =
      render(scene, "path", set("components", "direct"), {560, 3}).mean({"direct"});
  for (const char* integrator : {"raytracing", "localphong"})
    expect_equal_means(
        integrator,
        render(scene, integrator, set("components", "direct"), {560, 4}).mean({"direct"}), direct);
}

/// Photon maps: what the lamps send out by emitted rays, gathered in a ball that is seen from
/// inside.
TEST(TexturedLights, PhotonsCarryTheirLightLong) {
  const TestScene scene(camera("0, -0.8, 0", "0, 1, -0.2", 75, 12) +
                        sphere("0, 0, 0", 1, diffuse("0.5"), true) +
                        flat("rectangle", scale("0.3, 0.3, 1") + translate("0, 0, 0.2"),
                             black + checkered(2, 10, true)) +
                        sphere("0.5, 0.2, -0.3", 0.2, black + checkered(4, 8)));
  const auto indirect = [&](const char* integrator, const std::string& more, double samples) {
    return render(scene, integrator, set("components", "indirect") + more, {samples, 5})
        .mean({"indirect"});
  };
  expect_near_means("photonmap, indirect",
                    indirect("photonmap",
                             set("global_photons", 30'000) + set("caustic_photons", 0) +
                                 set("global_neighbors", 12) + set("irradiance_cache", false),
                             48),
                    indirect("path", "", 192), 0.01);
}

/// What a cosine-weighted ray meets, and what sampling the lamps finds: irradiance on the floor.
TEST(TexturedLights, AreFoundWithAndWithoutLightSampling) {
  const TestScene test(textured_room());
  const Scene& scene = test.scene();
  const Ray down{{0.2f, 0.1f, 0.5f}, {0, 0, -1}};
  Hit hit;
  ASSERT_TRUE(scene.intersect(down, hit));
  const SurfaceVertex floor(scene, down, hit, TransportMode::radiance);
  RunningStatistics sampled, met;
  for (uint32_t replicate = 0; replicate < measured_passes; ++replicate) {
    double sampled_sum = 0, met_sum = 0;
    for (uint32_t i = 0; i < samples_of_a_replicate; ++i) {
      Sampler sampler(hash_mix(7, replicate), i);
      uint64_t rays = 0;
      sampled_sum += sample_direct_lights<double>(
          scene, floor, {LightChoice::all, 1}, sampler,
          [&](const DirectLight& light, ShadowAnswer& answer) {
            const Spectrum seen =
                trace_shadow_ray(scene, light, nullptr, {{}, sampler}, rays, answer);
            return double((light.radiance * seen)[0]) * std::max(0.0, double(light.wi.z));
          });
      const Ray ray = spawn_ray(floor.point(), square_to_cosine_hemisphere(sampler.next_2d()));
      if (!scene.intersect(ray, hit)) continue;
      const SurfaceVertex lamp(scene, ray, hit, TransportMode::radiance);
      if (lamp.light() < 0) continue;
      const Light& light = *scene.lights()[size_t(lamp.light())];
      met_sum += std::numbers::pi * double(light.emitted(lamp.point(), -ray.direction, {})[0]);
    }
    sampled.add(sampled_sum / samples_of_a_replicate);
    met.add(met_sum / samples_of_a_replicate);
  }
  expect_equal_means("light sampling over cosine-weighted rays", sampled, met);
}

/// What rays bring to the glass ball, shape 0, W: a value per replicate.
RunningStatistics flux_to_glass(const Scene& scene, const EmissionSampler& emission,
                                uint32_t count) {
  RunningStatistics result;
  for (uint32_t replicate = 0; replicate < measured_passes; ++replicate) {
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
      Sampler sampler(hash_mix(99, replicate), i);
      const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
      const EmittedRay ray = emission.sample(0, u_position, u_direction, sampler.next_1d(), {});
      Hit hit;
      if (!ray.flux.is_zero() && scene.intersect(ray.ray, hit) && hit.shape == 0)
        sum += double(ray.flux[0]);
    }
    result.add(sum / count);
  }
  return result;
}

/// Rays that are aimed bring what rays that are not do.
void expect_aimed_as_free(const std::string& name, const std::string& lamp) {
  const TestScene test(camera("0, -3, 2", "0, 0, 0", 40, 6) + sphere("0.1, 0, 0.7", 0.6, glass()) +
                       lamp);
  const Scene& scene = test.scene();
  constexpr uint32_t count = 8 * samples_of_a_replicate;
  const RunningStatistics free = flux_to_glass(scene, EmissionSampler(scene), 2 * count);
  for (const Aim aim : {Aim::boxes, Aim::projection_map}) {
    const EmissionSampler aimed(scene, Lobes::specular, default_target_budget, aim);
    expect_equal_means(name + (aim == Aim::boxes ? " by boxes" : " by projection map"),
                       Comparison(flux_to_glass(scene, aimed, count), free), 0.004);
  }
}

/// From lamps that are black where a few probes look, and from lamps with two sides.
TEST(TexturedLights, PanelsMayBeAimed) {
  expect_aimed_as_free(
      "panel",
      flat("rectangle", scale("0.6, 0.6, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 2"),
           black + checkered(4, 20)));
}
TEST(TexturedLights, BacksOfPanelsMayBeAimed) {
  expect_aimed_as_free(
      "back", flat("rectangle", scale("0.6, 0.6, 1") + rotate("1, 0, 0", 20) + translate("0, 0, 2"),
                   black + checkered(4, 20, true)));
}
TEST(TexturedLights, BallsMayBeAimed) {
  expect_aimed_as_free("ball", sphere("0, 0, 2.1", 0.7, black + checkered(2, 20)));
}
TEST(TexturedLights, BallsAroundMayBeAimed) {
  expect_aimed_as_free("ball around", sphere("0.1, 0, 0.7", 1.2, black + checkered(2, 20, true)));
}

}  // namespace
}  // namespace kaustik
