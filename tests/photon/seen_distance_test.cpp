// How far away a picture's surfaces count as: what planned lengths of merging are measured by.

#include "kaustik/photon/coverage/seen_surfaces.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A ball on a floor, seen from that height straight down.
SeenSurfaces seen_from(const char* type, double height, double half_width) {
  const std::string view = fmt::format(
      R"(<sensor type="{}"><transform name="to_world"><scale x="{}" y="{}"/>
      <lookat origin="0, 0, {}" target="0, 0, 0" up="0, 1, 0"/></transform>
      <film type="hdrfilm">{}{}</film></sensor>)",
      type, half_width, half_width, height, set("width", 32), set("height", 24));
  const TestScene scene(view + flat("rectangle", scale("50, 50, 1"), diffuse("0.5")) +
                        sphere("0, 0, 1", 1, diffuse("0.5")));
  return SeenSurfaces(scene.scene());
}

// A camera that sees along parallel lines shows the same from wherever it stands; what is planned
// for it goes by how much it sees.
TEST(SeenDistance, OfParallelViewsIsThatOfWhatTheyShow) {
  const float near = seen_from("orthographic", 5, 2).mean_distance();
  EXPECT_EQ(seen_from("orthographic", 500, 2).mean_distance(), near);
  EXPECT_NEAR(seen_from("orthographic", 5, 6).mean_distance(), 3 * near, 1e-5f * near);
  // As of a camera with a field of view of 50° that sees as much of the floor.
  EXPECT_NEAR(near, 2 / std::tan(25 * pi / 180), 1e-4f);
}

// Others are as far away as they are.
TEST(SeenDistance, OfOtherViewsIsTheirDistance) {
  const float near = seen_from("perspective", 5, 1).mean_distance();
  EXPECT_GT(near, 3);
  EXPECT_LT(near, 6);
  EXPECT_GT(seen_from("perspective", 40, 1).mean_distance(), 38);
}

// Every pixel of a meter sees all that it sees: a single ray, which may miss, does not speak for
// it.
TEST(SeenDistance, MetersLookAround) {
  const TestScene scene(
      "<shape type=\"rectangle\"><bsdf type=\"null\"/><sensor type=\"irradiancemeter\">"
      "<film type=\"hdrfilm\">" +
      set("width", 1) + set("height", 1) + "</film></sensor></shape>" +
      // Seen in about half of all ways.
      flat("rectangle", rotate("1, 0, 0", 180) + scale("2, 2, 1") + translate("0, 0, 2"),
           diffuse("0.5")));
  const SeenSurfaces seen(scene.scene());
  for (const PixelProbe& probe : seen.probes()) {
    EXPECT_TRUE(probe.found);
    EXPECT_GT(probe.pixel_width, 0.01f);
    EXPECT_LT(probe.pixel_width, 0.06f);
  }
}

}  // namespace
}  // namespace kaustik
