// Textures that hold textures, and those of other programs.

#include <fstream>

#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vol_file.h"

namespace kaustik {
namespace {

using namespace test;

std::string covered_ball(const std::string& bsdf) {
  return any_camera + std::string("<shape type=\"sphere\">") + bsdf + "</shape>";
}

Spectrum albedo_at(const Scene& scene, float u, float v) {
  TextureCoordinates at;
  at.uv = {u, v};
  BsdfContext context;
  context.move_to(at, {});
  return scene.surface(0).bsdf->albedo(context, {0, 0, 1}, Lobes::all);
}

TEST(NestedTextures, AreLookedUpInOneAnother) {
  const auto scene = scene_of(covered_ball(R"(<bsdf type="diffuse">
    <texture type="checkerboard" name="reflectance"><rgb name="color0" value="0.1"/>
    <texture type="scale" name="color1"><float name="scale" value="0.5"/>
    <texture type="checkerboard" name="whatever"><rgb name="color0" value="0.8"/>
    <rgb name="color1" value="0.6"/><transform name="to_uv"><scale value="4"/></transform>
    </texture></texture></texture></bsdf>)"));
  EXPECT_FLOAT_EQ(albedo_at(*scene, 0.1f, 0.1f)[0], 0.1f);
  EXPECT_FLOAT_EQ(albedo_at(*scene, 0.6f, 0.1f)[0], 0.4f);
  EXPECT_FLOAT_EQ(albedo_at(*scene, 0.7f, 0.1f)[0], 0.3f);
}

TEST(NestedTextures, ThatFitNowhereAreTold) {
  expect_problem(
      covered_ball("\n<bsdf type=\"diffuse\"><texture type=\"noise\" name=\"reflectance\">"
                   "<texture type=\"bitmap\" name=\"color0\"/></texture></bsdf>"),
      "3:63", "texture 'noise' cannot hold a texture");
  expect_problem(covered_ball("\n<bsdf type=\"diffuse\"><texture type=\"checkerboard\" "
                              "name=\"reflectance\"><texture type=\"noise\" name=\"color2\"/>"
                              "</texture></bsdf>"),
                 "3:70", "takes no texture 'color2'", "did you mean 'color0'?");
  expect_problem(
      covered_ball("\n<bsdf type=\"diffuse\"><texture type=\"scale\" name=\"reflectance\"/>"
                   "</bsdf>"),
      "3:22", "nothing to multiply");
}

Spectrum albedo_of_place(const Scene& scene, const Vec3f& position) {
  TextureCoordinates at;
  at.position = position;
  BsdfContext context;
  context.move_to(at, {});
  return scene.surface(0).bsdf->albedo(context, {0, 0, 1}, Lobes::all);
}

/// In the world, whatever the surface's own place.
TEST(NestedTextures, ShowVolumes) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("grid.vol"), std::ios::binary) << vol_file({2, 1, 1}, {0.2f, 0.6f});
  const std::string volume =
      "<volume name=\"volume\" type=\"gridvolume\"><string "
      "name=\"filename\" value=\"" +
      folder.path("grid.vol") +
      "\"/><transform name=\"to_world\"><scale value=\"4\"/>"
      "</transform></volume>";
  const auto painted = [&](const std::string& texture) {
    return covered_ball("<bsdf type=\"diffuse\">" + texture + "</bsdf>");
  };
  const auto scene =
      scene_of(painted("<texture type=\"scale\" name=\"reflectance\"><float name=\"scale\" "
                       "value=\"0.5\"/><texture type=\"volume\">" +
                       volume + "</texture></texture>"));
  EXPECT_NEAR(albedo_of_place(*scene, {1, 9, 9})[0], 0.1f, 1e-6f);
  EXPECT_NEAR(albedo_of_place(*scene, {2, 0, 0})[0], 0.2f, 1e-6f);
  EXPECT_NEAR(albedo_of_place(*scene, {3, 0, 0})[0], 0.3f, 1e-6f);
  // By reference, and one value.
  const auto referring = scene_of(
      painted("<texture type=\"volume\" name=\"reflectance\"><ref name=\"volume\" id=\"v\"/>"
              "</texture>") +
      "<volume id=\"v\" type=\"constvolume\"><rgb name=\"value\" value=\"0.1, 0.2, 0.3\"/>"
      "</volume>");
  EXPECT_EQ(albedo_of_place(*referring, {1, 0, 0}), spectrum_from_rgb(0.1f, 0.2f, 0.3f));
  const auto plain = scene_of(painted("<texture type=\"volume\" name=\"reflectance\"/>"));
  EXPECT_FLOAT_EQ(albedo_of_place(*plain, {1, 0, 0})[0], 0.75f);

  expect_problem(painted("\n<texture type=\"volume\" name=\"reflectance\"><volume "
                         "name=\"value\" type=\"constvolume\"/></texture>"),
                 "3:43", "takes no volume 'value'", "did you mean 'volume'?");
  expect_problem(painted("\n<texture type=\"checkerboard\" name=\"reflectance\"><volume "
                         "name=\"color0\" type=\"constvolume\"/></texture>"),
                 "3:49", "cannot hold a volume");
}

/// Each board shows the one before it twice: answers would take twice as long at each level.
TEST(NestedTextures, AreNoMoreThanCanBeAsked) {
  std::string text = "<texture type=\"checkerboard\" id=\"t0\"/>";
  for (int i = 1; i < 20; ++i) {
    const std::string before = "<ref id=\"t" + std::to_string(i - 1) + "\" name=\"color";
    text += "\n<texture type=\"checkerboard\" id=\"t" + std::to_string(i) + "\">" + before +
            "0\"/>" + before + "1\"/></texture>";
  }
  const auto problems = problems_of(text + any_camera + any_shape);
  ASSERT_FALSE(problems.empty());
  EXPECT_NE(problems[0].message.find("nests"), std::string::npos) << problems[0].message;
  EXPECT_FALSE(problems[0].remedy.empty());
}

/// The parameter has its default then.
TEST(NestedTextures, OfOtherProgramsAreLeftOut) {
  const std::string foreign = "<texture type=\"curvature\" name=\"reflectance\"/>";
  const std::string text = "<scene version=\"3.0.0\">" + std::string(any_camera) +
                           "\n<shape type=\"sphere\"><bsdf type=\"diffuse\">" + foreign +
                           "</bsdf></shape><shape type=\"sphere\"><bsdf type=\"diffuse\">" +
                           foreign + "</bsdf></shape></scene>";
  Description description = parse_mitsuba_xml(text, "t.xml", "");
  const auto scene = build_scene(description);
  EXPECT_EQ(scene->warnings(),
            std::vector<std::string>{
                "t.xml:2:43: there is no texture 'curvature' here yet: it is left out, and 1 more "
                "like it"});
  EXPECT_FLOAT_EQ(albedo_at(*scene, 0, 0)[0], 0.5f);
  description.is_strict = true;
  EXPECT_THROW(build_scene(description), Error);
}

TEST(NestedTextures, OfOtherProgramsAreToldOnceHoweverOftenTheyAreMeant) {
  const auto scene = scene_of(
      "<texture type=\"curvature\" id=\"c\"/>" +
      covered_ball(
          "<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">"
          "<ref id=\"c\" name=\"color0\"/><ref id=\"c\" name=\"color1\"/></texture></bsdf>"));
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_EQ(scene->warnings()[0].find("more like it"), std::string::npos) << scene->warnings()[0];
  EXPECT_FLOAT_EQ(albedo_at(*scene, 0.1f, 0.1f)[0], 0.4f);
}

/// What looks like one of ours was meant to be one, and what nothing can stand for must be there.
TEST(NestedTextures, ThatAreMeantAreErrors) {
  expect_problem(covered_ball("\n<bsdf type=\"diffuse\"><texture type=\"chekerboard\" "
                              "name=\"reflectance\"/></bsdf>"),
                 "3:22", "unknown texture type 'chekerboard'", "did you mean 'checkerboard'?");
}

}  // namespace
}  // namespace kaustik
