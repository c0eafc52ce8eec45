// Textures on lamps: what is taken and what is refused.

#include "kaustik/image/image_io.h"
#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

const std::string checkerboard =
    R"(<texture name="radiance" type="checkerboard"><rgb name="color0" value="0.9"/>
    <rgb name="color1" value="0.1"/></texture>)";

std::string lamp(const std::string& inside) {
  return any_camera + std::string("<shape type=\"rectangle\">\n<emitter type=\"area\">") + inside +
         "</emitter></shape>";
}

TEST(TexturedLights, HaveThePowerOfTheirTexture) {
  const auto scene = scene_of(lamp(checkerboard + R"(<float name="scale" value="10"/>)"));
  EXPECT_NEAR(scene->lights()[0]->traits().power[1], std::numbers::pi * 4 * 5, 1e-2);
  EXPECT_EQ(scene->lights()[0]->traits().power[3], 0);
}

/// A picture of two pixels over a rectangle: the left one dark.
TEST(TexturedLights, ShowTheirPicture) {
  const TemporaryFolder folder;
  Image image(2, 1, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) image.channel(c)[1] = float(4 + c);
  write_image(image, folder.path("screen.exr"));
  const auto scene = scene_of(lamp(R"(<texture name="radiance" type="bitmap">
      <string name="filter_type" value="nearest"/><string name="filename" value=")" +
                                   folder.path("screen.exr") + "\"/></texture>"));
  const Light& light = *scene->lights()[0];
  for (const float x : {-0.5f, 0.5f}) {
    const Ray ray{{x, 0.2f, 1}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(scene->intersect(ray, hit));
    const Spectrum seen = light.emitted(scene->tracer().surface_point(ray, hit), {0, 0, 1}, {});
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(seen[c], x < 0 ? 0.0f : float(4 + c));
    EXPECT_TRUE(light.emitted(scene->tracer().surface_point(ray, hit), {0, 0, -1}, {}).is_zero());
  }
  EXPECT_NEAR(light.traits().power[2], 2 * 6 * std::numbers::pi, 0.05);
}

TEST(TexturedLights, MayBeShared) {
  std::string texture = checkerboard;
  texture.replace(texture.find("name=\"radiance\""), 15, "id=\"tiles\"");
  const auto scene = scene_of(texture + any_camera +
                              R"(<shape type="disk"><emitter type="area">
                              <ref id="tiles" name="radiance"/></emitter>
                              <bsdf type="diffuse"><ref id="tiles" name="reflectance"/></bsdf>
                              </shape>)");
  EXPECT_GT(scene->lights()[0]->traits().power[1], 0);
}

TEST(TexturedLights, RefuseWhatMakesNoSense) {
  expect_problem(lamp(R"(<texture name="radiant" type="checkerboard"/>)"), "3:22",
                 "emitter 'area' takes no texture 'radiant'", "did you mean 'radiance'?");
  expect_problem(lamp(R"(<texture name="radiance" type="bitmap"/>)"), "3:22", "filename");
  expect_problem(lamp(checkerboard + R"(<float name="scale" value="-1"/>)"), "4:47", "scale");
}

/// As a file cannot have it, but what is set afterwards may.
TEST(TexturedLights, AreNotOfOneColorAsWell) {
  const Description description = description_of(lamp(checkerboard));
  Object& emitter = *description.scene->children[1].object->children[0].object;
  emitter.properties.push_back({"radiance", Value(1.0), {}});
  try {
    build_scene(description);
    FAIL();
  } catch (const Error& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_NE(error.problems()[0].message.find("both as a value and as a texture"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace kaustik
