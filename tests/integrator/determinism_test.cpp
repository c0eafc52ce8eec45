// The same seed makes the same bits, whatever the number of threads; other seeds and other
// replicates are independent of it.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Something of everything: area lamp, delta, glossy and diffuse surfaces.
TestScene small_scene() {
  return TestScene(
      camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 40) + flat("rectangle", "", phong(0.4, 0.3, 20)) +
      flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), diffuse("0.5, 0.3, 0.2")) +
      flat("rectangle", scale("0.2, 0.2, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.4"),
           diffuse("0, 0, 0") + area_light("10, 9, 8")) +
      sphere("-0.45, 0.3, 0.401", 0.4, mirror()) + sphere("0.45, -0.05, 0.401", 0.4, glass()));
}

const std::string few_photons = set("global_photons", 5000) + set("caustic_photons", 5000);

struct Method {
  std::string type, parameters;
};
std::vector<Method> methods() {
  return {{"path", ""},
          {"lighttracer", ""},
          {"photonmap", few_photons},
          {"photonmap", few_photons + set("irradiance_cache", false) + set("reradiate", true)}};
}

bool same_bits(const Passes& a, const Passes& b) {
  for (size_t i = 0; i < a.images().size(); ++i)
    for (int c = 0; c < a.images()[i].channel_count(); ++c) {
      const auto x = a.images()[i].channel(c), y = b.images()[i].channel(c);
      if (std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
    }
  return true;
}

TEST(Determinism, AnyNumberOfThreads) {
  const TestScene scene = small_scene();
  for (const Method& m : methods()) {
    const Passes one = render(scene, m.type, m.parameters, {4, 1, 2, 1});
    const Passes two = render(scene, m.type, m.parameters, {4, 1, 2, 2});
    EXPECT_TRUE(same_bits(one, two)) << m.type;
    EXPECT_GT(one.mean({""}).mean(), 0) << m.type;
  }
}

TEST(Determinism, OneIntegratorRendersAgainAndOtherPassesBefore) {
  const TestScene scene = small_scene();
  for (const Method& m : methods()) {
    const auto integrator = scene.integrator(m.type, m.parameters);
    const Passes first = render(scene, *integrator, {4, 1, 2});
    render(scene, *integrator, {4, 9, 1});
    EXPECT_TRUE(same_bits(first, render(scene, *integrator, {4, 1, 2}))) << m.type;
  }
}

TEST(Determinism, OtherSeedsDiffer) {
  const TestScene scene = small_scene();
  for (const Method& m : methods())
    EXPECT_FALSE(same_bits(render(scene, m.type, m.parameters, {4, 1, 1}),
                           render(scene, m.type, m.parameters, {4, 2, 1})))
        << m.type;
}

/// Passes by pixel: in the mean over many pixels the products of deviations of two different
/// passes vanish. Pixels of one pass may share photons, so blocks of them make one value.
TEST(Determinism, ReplicatesAreIndependent) {
  const TestScene scene = small_scene();
  for (const Method& m : methods()) {
    const Passes passes = render(scene, m.type, m.parameters, {4 / sample_share, 3, 16});
    const auto value = [&](size_t pass, size_t block) {
      const Image& image = passes.images()[pass];
      return Passes::mean_of(image, {""}, [&](int x, int y) {
        return size_t(y / 8 * 5 + x / 8) == block ? 1.0 : 0.0;
      });
    };
    // Correlation of pass i with pass i + 1 over the blocks, each block's own mean taken off.
    RunningStatistics products;
    for (size_t block = 0; block < 25; ++block) {
      RunningStatistics all;
      for (size_t i = 0; i < 16; ++i) all.add(value(i, block));
      if (!(all.variance() > 0)) continue;
      for (size_t i = 0; i < 16; i += 2)
        products.add((value(i, block) - all.mean()) * (value(i + 1, block) - all.mean()) /
                     all.variance());
    }
    // Taking off the mean of 16 itself makes −1/16.
    EXPECT_NEAR(products.mean(), -1.0 / 16, 4 * products.standard_error()) << m.type;
    EXPECT_LT(products.standard_error(), 0.15) << m.type;
  }
}

}  // namespace
}  // namespace kaustik
