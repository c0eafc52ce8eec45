// The same room in metres, in about a millionth and a million of them: radiance does not depend on
// the unit of length. By powers of two floats are scaled without rounding, so that every bit of the
// picture is the same as long as no number on the way leaves the range of floats.

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"
#include "tests/support/scene_text.h"

namespace kaustik::test {
namespace {

constexpr double millionth = 1.0 / (1 << 20), million = 1 << 20;

/// A point or a factor, of so many units.
std::string scaled(const std::vector<double>& values, double unit) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + fmt::format("{}", value * unit);
  return text;
}

/// Two balls, of glass and of metal, in a matt room under a lamp.
std::string room(double unit, int size) {
  const auto at = [&](double x, double y, double z) { return scaled({x, y, z}, unit); };
  return "<scene version=\"3.0.0\">" + camera(at(0, -0.95, 0.1), at(0, 0, -0.2), 70, size) +
         flat("cube", scale(scaled({1}, unit)),
              diffuse("0.5") + R"(<boolean name="flip_normals" value="true"/>)") +
         flat("rectangle",
              scale(scaled({0.4}, unit)) + rotate("1, 0, 0", 180) + translate(at(0, 0, 0.98)),
              area_light("5")) +
         sphere(at(-0.4, 0.2, -0.6), 0.35 * unit, glass()) +
         sphere(at(0.45, 0.3, -0.65), 0.3 * unit, ggx(0.2)) + "</scene>";
}

class ScaledScenes : public ProgramTest, public testing::WithParamInterface<std::string> {
 protected:
  /// The picture's file; its pixels are finite, and it is not black.
  std::string rendered(double unit, int size, const std::vector<std::string>& settings) const {
    write("room.xml", room(unit, size));
    std::vector<std::string> arguments = {
        "render", "room.xml",  "-q", "--integrator", GetParam(), "--passes", "2", "--spp",
        "2",      "--threads", "1",  "-o",           "room.pfm"};
    for (const std::string& setting : settings)
      arguments.insert(arguments.end(), {"--set", "integrator." + setting});
    const RunResult result = run_well(arguments);
    EXPECT_FALSE(contains(result.err, "not finite")) << result.err;
    double sum = 0;
    const Image image = read_image(path("room.pfm"));
    for (int c = 0; c < image.channel_count(); ++c)
      for (const float value : image.channel(c)) sum += double(value);
    EXPECT_TRUE(sum > 0) << sum;
    return contents("room.pfm");
  }
};

TEST_P(ScaledScenes, HaveTheSamePicture) {
  std::vector<std::string> few_photons;
  if (GetParam() == "photonmap")
    few_photons = {"global_photons=2000", "caustic_photons=2000", "cache_samples=16"};
  const std::string metres = rendered(1, 16, few_photons);
  EXPECT_TRUE(rendered(millionth, 16, few_photons) == metres);
  EXPECT_TRUE(rendered(million, 16, few_photons) == metres);
  // Rounding by any other factor shows in the bits.
  EXPECT_FALSE(rendered(3, 16, few_photons) == metres);
}

INSTANTIATE_TEST_SUITE_P(, ScaledScenes,
                         testing::Values("auto", "vcm", "bdpt", "ppm", "path", "lighttracer",
                                         "photonmap"));

/// Many light paths merge in narrow disks, as in a picture of full size: there the densities of
/// merging, one over the area of a disk, are farthest from 1.
class ScaledDisks : public ScaledScenes {};

TEST_P(ScaledDisks, HaveTheSamePicture) {
  const auto picture = [&](double unit) {
    return rendered(unit, 12, {"light_paths=200", fmt::format("radius={}", 0.01 * unit)});
  };
  const std::string metres = picture(1);
  EXPECT_TRUE(picture(millionth) == metres);
  EXPECT_TRUE(picture(million) == metres);
}

INSTANTIATE_TEST_SUITE_P(, ScaledDisks, testing::Values("vcm", "ppm"));

}  // namespace
}  // namespace kaustik::test
