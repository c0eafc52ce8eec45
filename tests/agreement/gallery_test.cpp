// A scene for each type: what Kaustik makes of it today is what it made when its reference was
// made.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "kaustik/base/statistics.h"
#include "kaustik/integrator/description_types.h"
#include "tests/agreement/gallery.h"
#include "tests/agreement/sign_flips.h"

namespace kaustik::agreement {
namespace {

/// What the page of the gallery shows.
const std::set<std::string>& shown_families() {
  static const std::set<std::string> families = {"bsdf",  "texture", "emitter", "sensor",
                                                 "shape", "volume",  "medium",  "phase"};
  return families;
}

/// Types without a scene of their own: programs make them.
const std::set<std::string>& types_without_scene() {
  static const std::set<std::string> types = {"shape_mesh", "sensor_irradiancepoints",
                                              "sensor_radiancerays"};
  return types;
}

TEST(Gallery, ShowsEveryType) {
  const std::vector<std::string> scenes = gallery_scenes();
  const std::set<std::string> shown(scenes.begin(), scenes.end());
  for (const TypeInfo* info : description_types().all()) {
    const std::string name = info->family + "_" + info->name;
    if (!shown_families().contains(info->family) || types_without_scene().contains(name)) continue;
    EXPECT_TRUE(shown.contains(name)) << "there is no docs/gallery/" << name << ".xml";
  }
}

/// Chance that any of so many scenes fails where all is right.
double level() { return sidak_level(0.01, int(gallery_scenes().size())); }

/// A bias of the whole picture that is not found in a scene tells that the scene tells nothing.
constexpr double bias_to_find = 0.25;

void check(const std::string& scene, const std::string& integrator) {
  const Components reference = read_blocks(gallery_path(scene));
  const Components tested = render_blocks(gallery_render(scene, integrator));
  const Replicates &of_test = tested.at(whole_picture), &right = reference.at(whole_picture);
  const Verdict verdict = compare(of_test, right);
  const double smallest = smallest_bias_found(of_test, right, level());
  std::printf(
      "  %-28s %-5s mean %+.2f ± %.2f %%, p of mean %.2g, of all blocks %.2g, of the worst "
      "%.2g; finds a bias of %.1f %%\n",
      scene.c_str(), integrator.c_str(), 100 * verdict.mean_difference,
      100 * verdict.mean_difference_error, verdict.p_mean, verdict.p_blocks, verdict.p_worst,
      100 * smallest);
  EXPECT_FALSE(verdict.rejects(level())) << "worst block " << verdict.worst_block;
  EXPECT_LE(smallest, bias_to_find) << "too noisy to tell";
}

class GalleryScene : public testing::TestWithParam<std::string> {};

TEST_P(GalleryScene, LooksAsItDid) {
#ifdef KAUSTIK_SLOW_BUILD
  GTEST_SKIP() << "in slow builds types are tested by themselves";
#endif
  check(GetParam(), "path");
}

// Paths from both ends know the densities of lights, cameras and materials.
TEST_P(GalleryScene, LooksTheSameFromBothEndsLong) { check(GetParam(), "bdpt"); }

INSTANTIATE_TEST_SUITE_P(All, GalleryScene, testing::ValuesIn(gallery_scenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace kaustik::agreement
