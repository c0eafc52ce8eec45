// Where something glossy is in view, photonmap with its irradiance cache and without finds what
// path finds, component by component. benchmarks/glossy_tool.cpp asks the same of larger pictures.

#include "tests/support/glossy_scenes.h"
#include "tests/support/measure.h"

namespace kaustik {
namespace {

using namespace test;

constexpr int size = 24;
/// What halves of the picture may be off by in these few passes of few photons.
constexpr double tolerance = 0.02;

std::string photons() { return set("global_photons", 60'000) + set("caustic_photons", 60'000); }

class GlossyScene : public testing::TestWithParam<size_t> {
 protected:
  GlossyScene() : text_(glossy_scenes(size)[GetParam()].second), scene_(text_) {}
  Passes passes(const std::string& integrator, const std::string& parameters = "") const {
    return render(scene_, integrator, parameters, {integrator == "path" ? 100.0 : 8.0});
  }

  std::string text_;
  TestScene scene_;
};

/// A component of the pictures, in their halves: what one is too bright the other may be too dark.
Comparison compare(const Passes& found, const Passes& referee, const std::string& component,
                   bool upper) {
  const PixelWeight half = [&](int, int y) { return (y < size / 2) == upper ? 1.0 : 0.0; };
  return {found.mean({component}, half), referee.mean({component}, half)};
}

TEST_P(GlossyScene, HasTheLightThatPathFindsLong) {
  const Passes path = passes("path");
  const double least = 0.002 * path.mean({""}).mean();
  const auto expect_agreement = [&](const char* name, const Passes& found) {
    for (const char* component : {"direct", "caustic", "indirect", "specular"})
      for (const bool upper : {false, true}) {
        const Comparison c = compare(found, path, component, upper);
        if (c.mean() < least) continue;
        EXPECT_GT(c.p_value_of_nearness(tolerance), nearness_level())
            << name << ", " << component << (upper ? ", above: " : ", below: ") << c.ratio()
            << " ± " << c.relative_error();
        if (slow_build || c.mean() < 10 * least) continue;
        EXPECT_LT(c.p_value_of_nearness(tolerance, c.ratio() > 1 ? 1.1 : 1 / 1.1), nearness_level())
            << name << ", " << component << ": an error of 10 % goes unseen";
      }
  };
  expect_agreement("with the cache", passes("photonmap", photons()));
  expect_agreement("without", passes("photonmap", photons() + set("irradiance_cache", false)));
}

INSTANTIATE_TEST_SUITE_P(Glossy, GlossyScene, testing::Values(1, 3, 4),
                         [](const auto& scene) { return glossy_scenes(size)[scene.param].first; });

/// The twin: records that all serve as far as those of blurred pixels once did.
TEST(GlossyScenes, TellRecordsThatReachTooFar) {
  if (slow_build) return;  // with few samples nothing so small is told
  const TestScene scene(glossy_scenes(size)[1].second);
  const RenderOptions options{4};
  const Passes far = render(scene, "photonmap",
                            photons() + set("components", "indirect") +
                                set("cache_minimum_spacing", 30) + set("cache_maximum_spacing", 60),
                            options);
  const Passes path = render(scene, "path", set("components", "indirect"), {100});
  double least = 1;
  for (const bool upper : {false, true})
    least = std::min(least, compare(far, path, "indirect", upper).p_value_of_nearness(tolerance));
  EXPECT_LT(least, nearness_level());
}

/// Disks of photons hang over the ends of a floor and of a wall; caustics there have the light that
/// falls on both all the same.
TEST(GlossyScenes, LoseNoCausticsAtTheEndsOfSurfacesLong) {
  const TestScene scene(glossy_scenes(size)[3].second);
  const std::string caustic = set("components", "caustic");
  const Comparison c(
      render(scene, "photonmap", caustic + set("caustic_photons", 120'000), {8}).mean({"caustic"}),
      render(scene, "path", caustic, {200}).mean({"caustic"}));
  EXPECT_GT(c.p_value_of_nearness(0.01), nearness_level()) << c.ratio();
  if (!slow_build) {
    EXPECT_LT(c.p_value_of_nearness(0.01, 0.96), nearness_level()) << c.ratio();
  }
}

}  // namespace
}  // namespace kaustik
