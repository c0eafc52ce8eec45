// pbrt's lamps, and what is seen of them.

#include <cmath>
#include <numbers>

#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

using std::numbers::pi;

Object lamp_in(const std::string& lines) {
  return only(parse_scene_of_pbrt("WorldBegin\n" + lines), "emitter");
}

TEST(PbrtLights, Point) {
  const Object lamp = lamp_in(
      "Translate 1 0 0 LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 2 "
      "\"point3 from\" [0 5 0]");
  EXPECT_EQ(lamp.type, "point");
  expect_rgb(value<Rgb>(lamp, "intensity"), 2, 4, 6);
  expect_same(value<Transform>(lamp, "to_world"), Transform::translate({1, 5, 0}));
  // Lumens over all directions; of white light.
  EXPECT_NEAR(value<double>(lamp_in("LightSource \"point\" \"float power\" 100"), "intensity"),
              100 / (4 * pi), 1e-9);
  // An rgb light's own brightness multiplies its power.
  expect_rgb(value<Rgb>(lamp_in("LightSource \"point\" \"float power\" 100 \"rgb I\" [2 2 2]"),
                        "intensity"),
             50 / pi, 50 / pi, 50 / pi);
}

TEST(PbrtLights, SpotFallsByTheCosine) {
  const Object lamp = lamp_in(
      "LightSource \"spot\" \"point3 from\" [0 0 5] \"point3 to\" [0 0 0] \"float coneangle\" 40 "
      "\"float conedeltaangle\" 10 \"float power\" 50");
  EXPECT_EQ(value<double>(lamp, "cutoff_angle"), 40);
  EXPECT_EQ(value<double>(lamp, "beam_width"), 30);
  EXPECT_EQ(value<std::string>(lamp, "falloff"), "smooth");
  const Transform t = value<Transform>(lamp, "to_world");
  EXPECT_NEAR(t.point({0, 0, 0}).z, 5, 1e-6);
  EXPECT_NEAR(t.vector({0, 0, 1}).z, -1, 1e-6);
  // The flux of a smooth step in the cosine from 30° to 40°.
  const double a = std::cos(30 * pi / 180), b = std::cos(40 * pi / 180);
  EXPECT_NEAR(value<double>(lamp, "intensity") * 2 * pi * ((1 - a) + (a - b) / 2), 50, 1e-9);
}

TEST(PbrtLights, DistantLightGoesFromFromToTo) {
  const Object lamp = lamp_in(
      "Rotate 90 1 0 0 LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] "
      "\"float illuminance\" 700");
  EXPECT_EQ(value<double>(lamp, "irradiance"), 700);
  const Vec3d direction = value<Vec3d>(lamp, "direction");
  EXPECT_NEAR(direction.y, 1, 1e-6);  // −z turned about x
}

TEST(PbrtLights, InfiniteLight) {
  EXPECT_EQ(lamp_in("LightSource \"infinite\"").type, "constant");
  EXPECT_NEAR(
      value<double>(lamp_in("LightSource \"infinite\" \"float illuminance\" 10"), "radiance"),
      10 / pi, 1e-9);
  const TemporaryFolder folder;
  folder.write("sky.exr", "?");
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Rotate 90 0 0 1 LightSource \"infinite\" \"string filename\" \"sky.exr\" "
      "\"float scale\" 3",
      false, folder / "");
  const Object& sky = only(scene, "emitter");
  EXPECT_EQ(sky.type, "envmap");
  EXPECT_EQ(value<std::string>(sky, "projection"), "equalarea");
  EXPECT_EQ(value<double>(sky, "scale"), 3);
  // Its middle, +y of Kaustik's picture, is +z in pbrt.
  EXPECT_NEAR(value<Transform>(sky, "to_world").vector({0, 1, 0}).z, 1, 1e-6);
  const Description old = parse_scene_of_pbrt(
      "WorldBegin LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"rgb L\" [2 2 2]", false,
      folder / "");
  const Transform t = value<Transform>(only(old, "emitter"), "to_world");
  // The left edge of the picture, −z, is +x there; a quarter from the left, +x, is +y.
  EXPECT_NEAR(t.vector({0, 0, -1}).x, 1, 1e-6);
  EXPECT_NEAR(t.vector({1, 0, 0}).y, 1, 1e-6);
  EXPECT_NEAR(value<double>(only(old, "emitter"), "scale"), 2, 1e-5);
}

TEST(PbrtLights, AreaLightsBelongToShapes) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    AreaLightSource "diffuse" "rgb L" [1 2 3] "float scale" 2 "bool twosided" true
    Shape "sphere"
    Shape "disk"
    AreaLightSource "diffuse" "float power" 100
    Scale 2 2 2
    Shape "sphere" "float radius" .5
    Shape "disk"
    Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0]
    Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0] "integer indices" [0 1 2 0 2 3]
    Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0]
    Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 1 1 0 0 3 0] "integer indices" [0 1 2 0 2 3]
    AreaLightSource ""
    Shape "sphere")");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 9u);
  const Object& lamp = only(*shapes[0], "emitter");
  expect_rgb(value<Rgb>(lamp, "radiance"), 2, 4, 6);
  EXPECT_TRUE(value<bool>(lamp, "two_sided"));
  EXPECT_EQ(&lamp, &only(*shapes[1], "emitter"));
  // L = Φ / (π · area).
  const auto radiance = [&](size_t i) {
    return value<double>(only(*shapes[i], "emitter"), "radiance");
  };
  EXPECT_NEAR(radiance(2), 100 / (pi * 4 * pi), 1e-6);
  EXPECT_NEAR(radiance(3), 100 / (pi * 4 * pi), 1e-6);
  EXPECT_NEAR(radiance(4), 100 / (pi * 2), 1e-6);
  // Each triangle of a mesh has that power, and each patch.
  EXPECT_NEAR(radiance(5), 100 / (pi * 2), 1e-6);
  EXPECT_NEAR(radiance(6), 100 / (pi * 4), 1e-6);
  EXPECT_NEAR(radiance(7), 200 / (pi * 8), 1e-6);
  EXPECT_TRUE(is_approximated(scene, "area light", "unlike areas"));
  EXPECT_EQ(shapes[8]->children.size(), 1u);
}

TEST(PbrtLights, PowersOfStretchedBodiesAreUnknown) {
  for (const char* shape : {"Scale 1 1 3 Shape \"sphere\"", "Scale 1 2 1 Shape \"cylinder\""}) {
    const Description scene = parse_scene_of_pbrt(
        "WorldBegin AreaLightSource \"diffuse\" \"float power\" 100 \"float wat\" 3 " +
        std::string(shape));
    EXPECT_EQ(value<double>(only(only(scene, "shape"), "emitter"), "radiance"), 1) << shape;
    EXPECT_TRUE(is_approximated(scene, "area light", "'power' has no effect"));
    EXPECT_TRUE(is_ignored(scene, "area light", "'wat' has no effect"));
  }
  // A cylinder that is longer is round still: 2 π r · 2 · 3.
  const Object body =
      only(parse_scene_of_pbrt("WorldBegin AreaLightSource \"diffuse\" \"float power\" 100 "
                               "Scale 1 1 3 Shape \"cylinder\""),
           "shape");
  EXPECT_NEAR(value<double>(only(body, "emitter"), "radiance"), 100 / (pi * 12 * pi), 1e-9);
}

TEST(PbrtLights, OneSkyWithTwoPortalsIsOne) {
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 2 3] \"point3 portal\" ";
  const Description scene = parse_scene_of_pbrt("WorldBegin " + sky + "[0 0 0 1 0 0 1 1 0 0 1 0] " +
                                                sky + "[0 0 5 1 0 5 1 1 5 0 1 5] Rotate 90 0 0 1 " +
                                                sky + "[0 0 5 1 0 5 1 1 5 0 1 5]");
  EXPECT_EQ(objects_of(scene, "emitter").size(), 2u);
  EXPECT_TRUE(is_approximated(scene, "'infinite'", "the first counts"));
}

TEST(PbrtLights, ProjectionsStandUpright) {
  const TemporaryFolder folder;
  folder.write("slide.png", "?");
  const Description scene =
      parse_scene_of_pbrt("WorldBegin LightSource \"projection\" \"string filename\" \"slide.png\"",
                          false, folder / "");
  // Of Kaustik's picture, u is mirrored, since +x is on the left of its camera; v is kept.
  const Object& slide = only(only(scene, "emitter"), "texture");
  expect_same(value<Transform>(slide, "to_uv"),
              Transform::translate({1, 0, 0}) * Transform::scale({-1, 1, 1}));
}

TEST(PbrtLights, InvisibleAndForbiddenLamps) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    AreaLightSource "diffuse" Shape "sphere" "float alpha" 0
    Material "interface" Shape "sphere"
    AreaLightSource "" Shape "sphere" "float alpha" 0)");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 2u);  // what is nowhere and dark is left out
  EXPECT_EQ(only(*shapes[0], "bsdf").type, "null");
  EXPECT_FALSE(value<bool>(only(*shapes[0], "emitter"), "visible"));
  EXPECT_TRUE(is_approximated(scene, "area light", "mirrors show it"));
  EXPECT_TRUE(is_ignored(scene, "area light", "without a material"));
}

TEST(PbrtLights, AlphaMakesHoles) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Texture "t" "float" "checkerboard"
    Shape "sphere" "texture alpha" "t"
    Shape "sphere" "float alpha" .25
    Shape "sphere" "float alpha" 1)");
  const auto shapes = objects_of(scene, "shape");
  EXPECT_EQ(child(only(*shapes[0], "bsdf"), "opacity").type, "checkerboard");
  EXPECT_EQ(value<double>(only(*shapes[1], "bsdf"), "opacity"), .25);
  EXPECT_EQ(only(*shapes[2], "bsdf").type, "twosided");
}

TEST(PbrtLights, GoniometricOnesKeepTheirPicture) {
  const TemporaryFolder folder;
  folder.write("g.pfm", "Pf\n1 1\n-1\n" + std::string(4, '\0'));
  const auto emitter_of = [&](const std::string& text) {
    return only(parse_scene_of_pbrt("WorldBegin " + text, false, folder / ""), "emitter");
  };
  const Object light =
      emitter_of("LightSource \"goniometric\" \"string filename\" \"g.pfm\" \"float power\" 5");
  EXPECT_EQ(light.type, "goniometric");
  EXPECT_EQ(value<std::string>(light, "filename"), folder / "g.pfm");
  EXPECT_EQ(value<std::string>(light, "projection"), "equalarea");
  EXPECT_EQ(value<double>(light, "power"), 5);
  // +y of its picture, the upper edge, is z of the lamp.
  const auto& to_world = value<Transform>(light, "to_world");
  EXPECT_EQ(to_world.vector(Vec3f(0, 1, 0)), Vec3f(0, 0, 1));
  EXPECT_EQ(emitter_of("LightSource \"goniometric\" \"float power\" 5").type, "point");
}

TEST(PbrtLights, TheOthersAreTold) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    LightSource "goniometric" "string filename" "x.exr"
    LightSource "projection" "string filename" "x.exr"
    LightSource "infinite" "string filename" "x.exr" "point3 portal" [0 0 0 1 0 0 1 1 0 0 1 0]
    LightSource "lava")");
  EXPECT_TRUE(is_missing(scene, "'goniometric'", "alike in all directions"));
  EXPECT_TRUE(is_approximated(scene, "'projection'", "edges"));
  EXPECT_TRUE(is_missing(scene, "'projection'", "not there"));
  EXPECT_TRUE(is_approximated(scene, "'infinite'", "portal"));
  EXPECT_TRUE(is_missing(scene, "'infinite'", "not there"));
  EXPECT_TRUE(is_ignored(scene, "'lava'", "no light"));
  EXPECT_EQ(objects_of(scene, "emitter").size(), 3u);
}

}  // namespace
}  // namespace kaustik::pbrt
