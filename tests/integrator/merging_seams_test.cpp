// Merging leaves no seams where surfaces meet.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string two_sided(const std::string& bsdf) {
  return R"(<bsdf type="twosided">)" + bsdf + "</bsdf>";
}

/// A floor of 1.2 m, 1 m of it in 16 pixels, in two parts that meet in the middle; even light falls
/// on it through a pane. `half` puts the right part in place.
const std::string half = scale("0.3, 0.6, 1") + translate("0.3, 0, 0");
TestScene floor_with(const std::string& right) {
  return TestScene(camera("0, 0, 0.9", "0, 0, 0", 58.1, 16, "0, 1, 0") +
                   flat("rectangle", scale("0.3, 0.6, 1") + translate("-0.3, 0, 0"),
                        two_sided(diffuse("0.6, 0.6, 0.6"))) +
                   right + flat("rectangle", scale("0.7, 0.7, 1") + translate("0, 0, 1"), glass()) +
                   directional_light("0, 0, -1", 1));
}

/// The columns of pixels that have the seam in reach are as bright as those beside them.
void expect_no_seam(const std::string& what, const TestScene& scene, const PixelWeight& at_seam,
                    const PixelWeight& beside) {
  const Passes found =
      render(scene, "ppm", set("radius", 0.06) + set("light_paths", 100.0), {4, 8});
  const std::vector<std::string> light = {"caustic"};
  expect_near_means(
      what, Comparison::same_seed(found.values(light, at_seam), found.values(light, beside)), 0.03,
      0.01);
}

PixelWeight columns(std::vector<int> which) {
  return [which](int x, int) {
    return std::find(which.begin(), which.end(), x) != which.end() ? 1.0 : 0.0;
  };
}

TEST(MergingSeams, ATurnedNeighbour) {
  expect_no_seam("turned",
                 floor_with(flat("rectangle", rotate("1, 0, 0", 180) + half,
                                 two_sided(diffuse("0.6, 0.6, 0.6")))),
                 columns({7, 8}), columns({5, 6, 9, 10}));
}

/// No light merges on a mirror: what lies beside it must not take it for dark floor.
TEST(MergingSeams, AMirror) {
  expect_no_seam("mirror", floor_with(flat("rectangle", half, mirror())), columns({7}),
                 columns({5, 6}));
}

}  // namespace
}  // namespace kaustik
