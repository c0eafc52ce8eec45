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

/// A rectangle over the whole depth of that floor, from x = `from` to `to`.
std::string strip(double from, double to, double z, const std::string& bsdf) {
  return flat("rectangle",
              scale(fmt::format("{}, 0.6, 1", (to - from) / 2)) +
                  translate(fmt::format("{}, 0, {}", (from + to) / 2, z)),
              bsdf);
}
std::string floor_from(double from, double to) {
  return strip(from, to, 0, two_sided(diffuse("0.6, 0.6, 0.6")));
}
/// Thin, black and across: the camera sees next to nothing of it, and no light falls on it.
std::string wall_at(double x, double bottom = 0) {
  return flat("rectangle",
              scale(fmt::format("{}, 0.6, 1", 0.15 - bottom / 2)) + rotate("0, 1, 0", -90) +
                  translate(fmt::format("{}, 0, {}", x, 0.15 + bottom / 2)),
              two_sided(diffuse("0, 0, 0")));
}
/// Light from straight above, through a pane where there is one.
class LitFloor {
 public:
  explicit LitFloor(const std::string& shapes,
                    const std::string& above = strip(-0.7, 0.7, 1, glass()), double samples = 16)
      : scene_(camera("0, 0, 0.9", "0, 0, 0", 58.1, 16, "0, 1, 0") + shapes + above +
               directional_light("0, 0, -1", 1)),
        found_(test::render(scene_, "ppm", set("radius", 0.1) + set("light_paths", 25.0),
                            {samples, 16})) {}
  RunningStatistics mean(const PixelWeight& weight = {}) const {
    return found_.mean({"caustic"}, weight);
  }
  void expect_as_open(const std::string& what, const LitFloor& open,
                      const std::vector<int>& which) const {
    expect_near_means(what, Comparison(mean(columns(which)), open.mean()), 0.01, 0.005);
  }

 private:
  TestScene scene_;
  Passes found_;
};

/// The columns are 1/16 m wide, the middle lies between the columns 7 and 8, and disks reach over
/// one and a half of them.
TEST(MergingSeams, WallsAndGapsInEvenLightLong) {
  const LitFloor open(floor_from(-0.6, 0.6));
  LitFloor(floor_from(-0.6, 0.6) + wall_at(0)).expect_as_open("wall", open, {6, 7, 8, 9});
  LitFloor(floor_from(-0.6, 0)).expect_as_open("end of the floor", open, {6, 7});
  LitFloor(floor_from(-0.6, -0.0625) + floor_from(-0.04, 0.6))
      .expect_as_open("gap in the floor", open, {5, 6});
  LitFloor(floor_from(-0.6, -0.0625) + floor_from(0, 0.6) + wall_at(-0.03, -0.1))
      .expect_as_open("gap before a wall", open, {5, 6});
  // As wide as the rays that look for walls pass below it.
  LitFloor(floor_from(-0.6, 0.6) + wall_at(0, 0.03))
      .expect_as_open("gap below a wall", open, {6, 7, 8, 9});
}

/// Furrows have more surface than the disks over them.
TEST(MergingSeams, FurrowsInEvenLightLong) {
  constexpr double slope = 25 * std::numbers::pi / 180, width = 0.005;
  std::string furrows;
  for (int i = -120; i < 120; ++i)
    furrows += flat("rectangle",
                    scale(fmt::format("{:.6f}, 0.6, 1", width / 2 / std::cos(slope))) +
                        rotate("0, 1, 0", i % 2 == 0 ? 25 : -25) +
                        translate(fmt::format("{}, 0, 0", (i + 0.5) * width)),
                    two_sided(diffuse("0.6, 0.6, 0.6")));
  const double open = LitFloor(floor_from(-0.6, 0.6)).mean().mean();
  expect_near_means("furrows",
                    Comparison(LitFloor(furrows, strip(-0.7, 0.7, 1, glass()), 24).mean(),
                               open * std::cos(slope)),
                    0.01, 0.005);
}

/// Behind a thin wall it is dark, right up to the wall, and before it as bright as elsewhere.
TEST(MergingSeams, NoLightThroughThinWallsLong) {
  const LitFloor open(floor_from(-0.6, 0.6));
  // The sky ends just before the wall: no ray falls on its edge, where either side is right.
  constexpr double end = -0.0002;
  const std::string half_sky =
      strip(-0.7, end, 1, glass()) + strip(end, 0.7, 1, two_sided(diffuse("0, 0, 0")));
  const LitFloor parted(floor_from(-0.6, 0.6) + wall_at(0), half_sky);
  parted.expect_as_open("before the wall", open, {6, 7});
  EXPECT_EQ(parted.mean(columns({8, 9, 10})).mean(), 0);
  // Without the wall the light is blurred by disks that reach over its edge.
  EXPECT_GT(LitFloor(floor_from(-0.6, 0.6), half_sky).mean(columns({8})).mean(),
            0.05 * open.mean().mean());
}

/// A black lid hangs over the left half of the floor. The mean over samples of caustic light at
/// that point below it, by disks of `radius` in a picture of `size` pixels over 0.44 m.
double caustic_below_lid(double height, float x, double radius, int size) {
  const TestScene scene(camera("0.6, 0, 0.06", "0, 0, 0", 40, size) + floor_from(-0.6, 0.6) +
                        strip(-0.6, 0, height, two_sided(diffuse("0, 0, 0"))) +
                        strip(-0.7, 0.7, 1, glass()) + directional_light("0, 0, -1", 1));
  const auto integrator = scene.integrator(
      "ppm", set("radius", radius) + set("light_paths", 60'000.0 / (4 * size * size)));
  SplatBuffer splats(scene.scene().film(), integrator->traits().components);
  const auto state = integrator->prepare({1, 0, 4}, splats, {}, {});
  const Vec2f raster = scene.scene().camera().connect({x, 0, 0}, Camera::middle_of_lens()).raster;
  RunningStatistics light;
  for (uint32_t i = 0; i < 16; ++i) {
    Sampler sampler = Sampler::at(1, 0, Stream::camera, 0, i);
    SampleSink sink(integrator->traits().components);
    integrator->sample(*state, raster, sampler, sink);
    EXPECT_NEAR(sink.first_hit().depth, 0.6 - double(x), 0.01);
    light.add(double(sink.radiance(Component::caustic).sum()));
  }
  return light.mean();
}

/// What hangs low shades as sharply as that: disks are no wider than twice its height, but for half
/// a pixel.
TEST(MergingSeams, NoLightBelowWhatHangsLow) {
  constexpr double height = 0.01, radius = 0.25;
  EXPECT_EQ(caustic_below_lid(height, -0.022f, radius, 60), 0);
  EXPECT_GT(caustic_below_lid(height, -0.015f, radius, 60), 0);
  EXPECT_GT(caustic_below_lid(height, -0.022f, radius, 8), 0);
}

}  // namespace
}  // namespace kaustik
