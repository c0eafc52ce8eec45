// No light comes from behind what is opaque: rooms without light beside bright ones, whose walls
// stand within the disks of merging.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

const std::string grey = diffuse("0.7, 0.7, 0.7");

/// Two rooms of 2 m under one ceiling, with a lamp in the left one; seen from the right one along
/// the wall between them, where disks of some pixels are decimetres long.
class Rooms {
 public:
  /// `wall` stands at x = 0. `inside`: more in the rooms.
  Rooms(const std::string& wall, const std::string& floor, int pixels,
        const std::string& inside = "")
      : scene_(camera("1.9, -0.9, 0.2", "0, -0.2, 0.6", 60, pixels, "0, 0, 1") +
               flat("cube", scale("2, 1, 1"), set("flip_normals", true) + floor) + wall + lamp() +
               inside) {}

  /// Mean radiance of the picture.
  double light(const std::string& type, const std::string& parameters = "") const {
    RenderOptions options;
    options.samples = 4;
    options.passes = 2;
    return render(scene_, type, parameters, options).mean({""}).mean();
  }

 private:
  static std::string lamp() {
    return flat("rectangle",
                scale("0.3, 0.3, 1") + rotate("1, 0, 0", 180) + translate("-1, 0, 0.99"),
                diffuse("0, 0, 0") + area_light("50, 50, 50"));
  }
  TestScene scene_;
};

/// As high as the rooms but for `gap`.
std::string slab(double thickness, double gap = 0) {
  return flat("cube",
              scale(fmt::format("{}, 1, {}", thickness / 2, 1 - gap / 2)) +
                  translate(fmt::format("0, 0, {}", -gap / 2)),
              grey);
}

constexpr const char* merging[] = {"auto", "vcm", "ppm", "photonmap"};

/// Few photons, whose disks are wide.
std::string parameters_of(const std::string& type) {
  return type == "photonmap" ? set("global_photons", 10000) + set("caustic_photons", 2000) +
                                   set("volume_photons", 10000)
                             : "";
}

void expect_dark(const std::string& what, const Rooms& rooms) {
  for (const char* type : merging)
    EXPECT_EQ(rooms.light(type, parameters_of(type)), 0) << what << " by " << type;
}

TEST(LightLeaks, WallsOfAnyThickness) {
  for (const double thickness : {0.001, 0.01, 0.04, 0.2})
    expect_dark(fmt::format("{} m", thickness), Rooms(slab(thickness), grey, 48));
}

/// Caustics of balls in the bright room, beside the wall.
TEST(LightLeaks, CausticsLong) {
  const std::string balls =
      sphere("-0.4, 0, -0.6", 0.35, glass()) + sphere("-0.4, -0.6, -0.7", 0.25, mirror());
  for (const double thickness : {0.001, 0.01})
    for (const int pixels : {16, 48, 128})
      expect_dark(fmt::format("{} m, {} pixels", thickness, pixels),
                  Rooms(slab(thickness), grey, pixels, balls));
  EXPECT_GT(Rooms(slab(0.001), grey, 48, balls)
                .light("photonmap", parameters_of("photonmap") + set("components", "caustic") +
                                        set("visibility", false)),
            0);
}

/// Disks of few pixels are the widest.
TEST(LightLeaks, PicturesOfAnySizeLong) {
  for (const int pixels : {16, 64, 128})
    expect_dark(fmt::format("{} pixels", pixels), Rooms(slab(0.01), grey, pixels));
}

TEST(LightLeaks, GlossyAndRoundWallsLong) {
  const std::string shiny = phong(0.3, 0.5, 20), rough = ggx(0.3);
  expect_dark("glossy floor", Rooms(slab(0.01), shiny, 48));
  expect_dark("rough metal", Rooms(slab(0.01), rough, 48));
  // A drum over the whole width, whose lower side comes close to the floor by and by.
  expect_dark("drum", Rooms(cylinder("0, -1.01, 0", "0, 1.01, 0", 1.001, grey), grey, 48));
}

/// What light is let through nowhere is no hole.
TEST(LightLeaks, WallsOfClosedMasks) {
  expect_dark("mask", Rooms(flat("cube", scale("0.005, 1, 1"),
                                 R"(<bsdf type="mask"><float name="opacity" value="1"/>)" + grey +
                                     "</bsdf>"),
                            grey, 48));
}

/// A lit cavity of 5 cm below a thin floor, which is as near as disks are thick.
TEST(LightLeaks, FloorsOverLight) {
  const auto level = [](double z) {
    return flat("rectangle", scale("2, 1, 1") + translate(fmt::format("0, 0, {}", z)),
                R"(<bsdf type="twosided">)" + grey + "</bsdf>");
  };
  const TestScene scene(camera("1.9, -0.9, 0.9", "0, -0.2, 0", 60, 48, "0, 0, 1") +
                        flat("cube", scale("2, 1, 1"), set("flip_normals", true) + grey) +
                        level(0) + level(-0.01) + level(-0.06) +
                        sphere("0, 0, -0.03", 0.01, grey + area_light("500, 500, 500")));
  RenderOptions options;
  options.samples = 4;
  options.passes = 2;
  for (const char* type : merging)
    EXPECT_EQ(render(scene, type, parameters_of(type), options).mean({""}).mean(), 0) << type;
}

/// Fog on both sides of a wall.
TEST(LightLeaks, FogBehindAWall) {
  const std::string fog =
      R"(<medium type="homogeneous" name="interior"><float name="sigma_t" value="0.5"/>
      <rgb name="albedo" value="0.8, 0.8, 0.8"/></medium>)";
  const auto room = [&](double x) {
    return flat("cube", scale("0.98, 0.98, 0.98") + translate(fmt::format("{}, 0, 0", x)),
                R"(<bsdf type="null"/>)" + fog);
  };
  const TestScene scene(
      camera("1.99, -0.9, 0.2", "0, -0.2, 0.6", 60, 24, "0, 0, 1") +
      flat("cube", scale("2, 1, 1"), set("flip_normals", true) + grey) + slab(0.01) + room(-1) +
      room(1) +
      flat("rectangle", scale("0.3, 0.3, 1") + rotate("1, 0, 0", 180) + translate("-1, 0, 0.99"),
           diffuse("0, 0, 0") + area_light("50, 50, 50")));
  RenderOptions options;
  options.samples = 4;
  options.passes = 2;
  for (const char* type : {"vcm", "ppm", "photonmap"}) {
    const auto light = [&](const std::string& parameters) {
      return render(scene, type, parameters_of(type) + parameters, options).mean({""}).mean();
    };
    EXPECT_EQ(light(""), 0) << type;
    EXPECT_GT(light(set("visibility", false)), 0) << type;
  }
}

/// What the tests above would see without that, where disks have the light and no cache …
TEST(LightLeaks, DisksReachThroughWalls) {
  for (const std::string type : {"vcm", "ppm", "photonmap"})
    for (const double thickness : {0.001, 0.04})
      EXPECT_GT(Rooms(slab(thickness), grey, 48)
                    .light(type, parameters_of(type) + set("visibility", false) +
                                     (type == "ppm" ? set("indirect_cache", "never") : "")),
                0)
          << type << " " << thickness;
}

/// … and if there were a way for light.
TEST(LightLeaks, AGapIsSeen) {
  for (const char* type : merging)
    EXPECT_GT(Rooms(slab(0.01, 0.02), grey, 48).light(type, parameters_of(type)), 0) << type;
}

}  // namespace
}  // namespace kaustik
