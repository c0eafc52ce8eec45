// Bump-mapped water and lampshades: the photon map beside the unbiased integrators.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string bumped(const std::string& texture, const std::string& bsdf) {
  return fmt::format(R"(<bsdf type="bumpmap">{}{}</bsdf>)", texture, bsdf);
}
std::string waves(double amplitude, double wavelength) {
  return fmt::format(
      R"(<texture type="waves"><float name="amplitude" value="{}"/><float name="wavelength" value="{}"/>
      </texture>)",
      amplitude, wavelength);
}
std::string water() {
  return R"(<bsdf type="dielectric"><string name="int_ior" value="water"/></bsdf>)";
}

/// From under water down to a pool's floor, in light from a large lamp over the waves.
std::string pool(const std::string& floor, const std::string& surface, const std::string& lamp) {
  return camera("0, 0, 0.8", "0, 0, 0", 60, 16, "0, 1, 0") +
         flat("rectangle", scale("3, 3, 1"), floor) +
         flat("rectangle", scale("3, 3, 1") + translate("0, 0, 1"), surface) + lamp;
}
std::string large_lamp() {
  return flat("rectangle", scale("1.5, 1.5, 1") + rotate("1, 0, 0", 180) + translate("0.3, 0, 2.5"),
              diffuse("0, 0, 0") + area_light("5, 5, 5"));
}

std::string photons(int count) {
  return set("components", "caustic") + set("caustic_photons", int(count * sample_share())) +
         set("caustic_neighbors", 100'000) + set("caustic_radius", 0.03) +
         set("caustic_kernel", "constant");
}

void compare_caustics(const std::string& name, const TestScene& scene) {
  const std::string only = set("components", "caustic");
  const RunningStatistics path = render(scene, "path", only, {600, 1}).mean({"caustic"});
  const RunningStatistics light = render(scene, "lighttracer", only, {400, 2}).mean({"caustic"});
  const RunningStatistics map =
      render(scene, "photonmap", photons(80'000), {16, 3}).mean({"caustic"});
  EXPECT_GT(path.mean(), 0);
  // The path tracer finds the lamp by chance alone, which leaves 0.35 %.
  expect_equal_means(name + " lighttracer", Comparison(light, path), 0.004);
  expect_near_means(name + " photonmap", Comparison(map, path), 0.01, 0.004);
}

// Photons know the geometric normal only; what they bring must count by the bent one.
TEST(WaterOfBumps, CausticsOnABumpedFloorAreThoseOfPath) {
  compare_caustics("waves over a bumped floor",
                   TestScene(pool(bumped(waves(0.05, 2), diffuse("0.5, 0.5, 0.5")),
                                  bumped(waves(0.012, 0.6), water()), large_lamp())));
}
// What the comparison above is about: waves focus light, flat water does not.
TEST(WaterOfBumps, BumpsMakeACaustic) {
  const std::string floor = diffuse("0.5, 0.5, 0.5"), lamp = point_light("0.3, 0, 2.5", 50);
  const TestScene flat_water(pool(floor, water(), lamp));
  const TestScene bumps(pool(floor, bumped(waves(0.012, 0.6), water()), lamp));
  const auto spread = [](const TestScene& scene) {
    const Passes passes = render(scene, "photonmap", photons(60'000), {16, 3});
    RunningStatistics pixels;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        double sum = 0;
        for (const Image& image : passes.images())
          sum += double(image.at(x, y, image.find_channel("caustic.G")));
        pixels.add(sum);
      }
    return std::sqrt(pixels.variance()) / pixels.mean();
  };
  EXPECT_GT(spread(bumps), 2 * spread(flat_water));
}

/// A lamp in a shade of paper over a floor before a wall.
std::string lampshade(const std::string& paper) {
  return camera("0, -2.2, 0.9", "0, 0, 0.55", 45, 20) +
         flat("rectangle", scale("3, 3, 1"), diffuse("0.4, 0.4, 0.4")) +
         flat("rectangle", scale("3, 3, 1") + rotate("1, 0, 0", 90) + translate("0, 1, 0"),
              diffuse("0.5, 0.4, 0.3")) +
         sphere("0, 0, 0.7", 0.3, paper) +
         sphere("0, 0, 0.7", 0.1, diffuse("0, 0, 0") + area_light("10, 10, 10"));
}
std::string paper(double gloss_through) {
  return fmt::format(
      R"(<bsdf type="thinphong"><rgb name="diffuse_reflectance" value="0.4"/>
      <rgb name="diffuse_transmittance" value="0.35"/>
      <rgb name="specular_transmittance" value="{}"/><float name="exponent" value="10"/></bsdf>)",
      gloss_through);
}
double on_shade(int x, int y) { return std::hypot(x - 9.5, y - 7.5) < 3 ? 1 : 0; }

TEST(Lampshade, IsTheSameForAllIntegrators) {
  const TestScene scene(lampshade(paper(0)));
  const std::string wanted = set("components", "direct, caustic, indirect");
  const std::vector<std::string> layers = {"direct", "caustic", "indirect"};
  const Passes path = render(scene, "path", wanted, {80, 1});
  const Passes light = render(scene, "lighttracer", wanted, {128, 2});
  const Passes map =
      render(scene, "photonmap",
             set("global_photons", int(60'000 * sample_share())) + set("global_neighbors", 30) +
                 set("irradiance_cache", false) + wanted,
             {12, 3});
  for (const PixelWeight& weight : {PixelWeight(), PixelWeight(on_shade)}) {
    const std::string where = weight ? " on the shade" : " everywhere";
    expect_equal_means("lampshade lighttracer" + where, light.mean(layers, weight),
                       path.mean(layers, weight));
    expect_near_means("lampshade photonmap" + where, map.mean(layers, weight),
                      path.mean(layers, weight), 0.01);
  }
}
// The cache has records of its own for the far side.
TEST(Lampshade, IsTheSameWithTheCacheLong) {
  const TestScene scene(lampshade(paper(0)));
  const std::string wanted = set("components", "indirect");
  const Passes path = render(scene, "path", wanted, {300, 1});
  const Passes map =
      render(scene, "photonmap",
             set("global_photons", int(60'000 * sample_share())) + set("global_neighbors", 30) +
                 set("cache_minimum_spacing", 0.2) + set("cache_maximum_spacing", 4.0) +
                 set("cache_quality", 0.1) + wanted,
             {16, 3});
  expect_near_means("lampshade with the cache", map.mean({"indirect"}, on_shade),
                    path.mean({"indirect"}, on_shade), 0.01);
}
TEST(Lampshade, GlossyTransmissionIsTheSame) {
  const TestScene scene(lampshade(paper(0.2)));
  const std::vector<std::string> layers = {"direct", "caustic", "indirect"};
  const std::string wanted = set("components", "direct, caustic, indirect");
  const Passes path = render(scene, "path", wanted, {128, 1});
  const Passes map = render(scene, "photonmap",
                            set("global_photons", int(60'000 * sample_share())) +
                                set("caustic_photons", int(60'000 * sample_share())) +
                                set("caustic_neighbors", 20) + set("global_neighbors", 30) +
                                set("irradiance_cache", false) + wanted,
                            {8, 3});
  expect_near_means("frosted lampshade photonmap", map.mean(layers), path.mean(layers), 0.01);
}

}  // namespace
}  // namespace kaustik
