// The irradiance cache where something glossy is in view: what is seen through it or in it,
// blurred, must not coarsen what is seen sharply, nor be taken from records that lie too far away.
// benchmarks/glossy_tool.cpp asks the same of larger pictures.

#include "tests/support/glossy_scenes.h"
#include "tests/support/measure.h"

namespace kaustik {
namespace {

using namespace test;

/// With the cache and without, from the same photons, in the halves of the picture: what one of
/// them is too bright the other may be too dark.
TEST(GlossyCache, FindsWhatGatheringFinds) {
  constexpr int size = 32;
  const std::string parameters =
      set("components", "indirect") + set("global_photons", 50'000) + set("caustic_photons", 0);
  for (const auto& [name, text] : glossy_scenes(size)) {
    const TestScene scene(text);
    const RenderOptions options{4, 1, slow_build ? 4u : 6u};
    const Passes cached = render(scene, "photonmap", parameters, options);
    const Passes gathered =
        render(scene, "photonmap", parameters + set("irradiance_cache", false), options);
    for (const bool upper : {false, true}) {
      const PixelWeight half = [&](int, int y) { return (y < size / 2) == upper ? 1.0 : 0.0; };
      const Comparison c = Comparison::same_seed(cached.values({"indirect"}, half),
                                                 gathered.values({"indirect"}, half));
      EXPECT_GT(c.p_value_of_nearness(0.03), nearness_level())
          << name << (upper ? ", above: " : ", below: ") << c.ratio();
      // What the cache was wrong by while blurred points set the reach of records.
      if (!slow_build) {
        EXPECT_LT(c.p_value_of_nearness(0.03, c.ratio() > 1 ? 1.15 : 1 / 1.15), nearness_level())
            << name;
      }
    }
  }
}

}  // namespace
}  // namespace kaustik
