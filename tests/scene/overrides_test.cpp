#include "kaustik/scene/overrides.h"

#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

const std::string objects =
    "<integrator type=\"path\"><integer name=\"max_depth\" value=\"3\"/></integrator>"
    "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/>"
    "</film></sensor><bsdf type=\"diffuse\" id=\"white\"/>"
    "<shape type=\"sphere\" id=\"ball\"><ref id=\"white\"/></shape>"
    "<shape type=\"cube\"><bsdf type=\"diffuse\" id=\"shaded\">"
    "<texture type=\"checkerboard\" name=\"reflectance\"/></bsdf></shape>";

std::string refusal(const std::string& assignment) {
  Description description = description_of(objects);
  try {
    override_property(description, assignment);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return {};
}

TEST(Overrides, ReplaceWhatTheFileSays) {
  Description description = description_of(objects);
  override_property(description, "film.width=20");
  override_property(description, "film.height=10");
  override_property(description, "ball.radius=2.5");
  override_property(description, "ball.center=1, 2, 3");
  override_property(description, "sensor.fov=30");
  const auto scene = build_scene(description);
  EXPECT_EQ(scene->film().size, Vec2i(20, 10));
  EXPECT_NEAR(scene->camera().traits().horizontal_fov, 30, 1e-4);
  EXPECT_NEAR(scene->tracer().shape(0).bounds().max.x, 3.5f, 1e-5f);
}

TEST(Overrides, TheCropWindowOfTheFileStaysTheSamePart) {
  const std::string text =
      "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"400\"/>"
      "<integer name=\"height\" value=\"300\"/><integer name=\"crop_offset_x\" value=\"300\"/>"
      "<integer name=\"crop_width\" value=\"100\"/><integer name=\"crop_offset_y\" "
      "value=\"100\"/><integer name=\"crop_height\" value=\"150\"/></film></sensor>"
      "<shape type=\"sphere\"/>";
  const auto film = [&](std::initializer_list<const char*> settings) {
    Description description = description_of(text);
    for (const char* setting : settings) override_property(description, setting);
    return build_scene(description)->film();
  };
  const auto small = film({"film.width=80", "film.height=30"});
  EXPECT_EQ(small.crop_offset, Vec2i(60, 10));
  EXPECT_EQ(small.crop_size, Vec2i(20, 15));
  EXPECT_EQ(film({"film.width=200", "film.width=40"}).crop_offset.x, 30);
  // What is set stays as it is set.
  EXPECT_EQ(film({"film.crop_offset_x=1", "film.crop_width=7", "film.width=40"}).crop_size.x, 7);
}

TEST(Overrides, TheLastOneCounts) {
  Description description = description_of(objects);
  override_property(description, "film.width=20");
  override_property(description, "film.width=30");
  EXPECT_EQ(build_scene(description)->film().size.x, 30);
}

TEST(Overrides, SharedObjectsChangeEverywhere) {
  Description description = description_of(objects);
  override_property(description, "white.reflectance=0.25");
  const auto scene = build_scene(description);
  EXPECT_FLOAT_EQ(scene->surface(0).bsdf->albedo({}, {0, 0, 1}, Lobes::all)[1], 0.25f);
}

TEST(Overrides, AValueTakesTheTexturesPlace) {
  Description description = description_of(objects);
  override_property(description, "shaded.reflectance=0.1,0.2,0.3");
  const auto scene = build_scene(description);
  for (const float u : {0.1f, 0.6f}) {
    BsdfContext context;
    context.move_to({.uv = {u, 0.1f}}, {});
    EXPECT_FLOAT_EQ(scene->surface(1).bsdf->albedo(context, {0, 0, 1}, Lobes::all)[2], 0.3f);
  }
}

TEST(Overrides, WhatIsWrong) {
  EXPECT_NE(refusal("nonsense").find("object.parameter=value"), std::string::npos);
  EXPECT_NE(refusal(".x=1").find("cannot read"), std::string::npos);
  EXPECT_NE(refusal("film.=1").find("cannot read"), std::string::npos);
  EXPECT_NE(refusal("bal.radius=1").find("did you mean 'ball'?"), std::string::npos);
  EXPECT_NE(refusal("shape.radius=1").find("has 2 objects 'shape'"), std::string::npos);
  EXPECT_EQ(refusal("ball.radius=a=b"), "");  // the table will tell
}

TEST(Overrides, WrongValuesAreToldWithTheirOrigin) {
  Description description = description_of(objects);
  override_property(description, "ball.radius=-1");
  override_property(description, "film.width=many");
  try {
    build_scene(description);
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("setting ball.radius=-1: 'radius' is -1"), std::string::npos) << text;
    EXPECT_NE(text.find("setting film.width=many: 'width' has the wrong type"), std::string::npos)
        << text;
  }
}

TEST(Overrides, SceneWithoutIntegratorGetsTheDefault) {
  Description without = description_of(std::string(any_camera) + any_shape);
  EXPECT_EQ(find_integrator(without), nullptr);
  override_property(without, "integrator.max_depth=5");
  ASSERT_NE(find_integrator(without), nullptr);
  EXPECT_EQ(find_integrator(without)->type, default_integrator);
  EXPECT_EQ(find_integrator(without)->properties.size(), 1u);
}

// A camera that has neither: the film of points takes its size from them, and says so.
TEST(Overrides, CamerasWithoutFilmOrSamplerGetThem) {
  Description without = description_of(std::string(any_camera) + any_shape);
  override_property(without, "film.width=7");
  override_property(without, "film.height=5");
  override_property(without, "sampler.sample_count=3");
  const auto scene = build_scene(without);
  EXPECT_EQ(scene->film().size, Vec2i(7, 5));
  EXPECT_EQ(scene->film().sample_count, 3);
  Description points =
      description_of("<sensor type=\"irradiancepoints\"/>" + std::string(any_shape));
  override_property(points, "film.width=7");
  const auto measured = build_scene(points);
  EXPECT_EQ(measured->film().size, Vec2i(1, 1));
  ASSERT_EQ(measured->warnings().size(), 1u);
  EXPECT_EQ(measured->warnings()[0], "without effect here: 'width' of the film of such a sensor");
  Description none = description_of(any_shape);
  EXPECT_THROW(override_property(none, "film.width=7"), Error);
}

/// What is said of the scene's integrator leaves a shape alone that refers to it.
TEST(Overrides, IntegratorsOfShapesStay) {
  Description description = description_of(
      "<integrator type=\"localphong\" id=\"plain\"><float name=\"ambient\" value=\"0.5\"/>"
      "</integrator>" +
      std::string(any_camera) + "<shape type=\"sphere\"><ref id=\"plain\"/></shape>");
  const auto of_shape = [&] { return build_scene(description)->surface(0).illumination; };
  override_property(description, "integrator.light_samples=3");
  EXPECT_EQ(find_integrator(description)->properties.size(), 2u);
  EXPECT_EQ(of_shape()->properties.size(), 1u);
  override_property(description, "plain.shadows=false");  // by its id: the shape's
  EXPECT_EQ(find_integrator(description)->properties.size(), 2u);
  EXPECT_EQ(of_shape()->properties.size(), 2u);
}

// The first, or the one that is asked for; and "sensor" is a name for it then.
TEST(Overrides, OneOfSeveralCameras) {
  const std::string text = "<scene version=\"3.0.0\">" + std::string(any_shape) +
                           R"(<sensor type="perspective" id="front"/>
                           <sensor type="orthographic" id="plan"/><sensor type="perspective"/>)"
                           "</scene>";
  const auto types_with = [&](const std::string& name, const std::string& told) {
    Description description = parse_mitsuba_xml(text, "t.xml", "");
    EXPECT_EQ(choose_camera(description, name), told);
    std::string types;
    for (const Child& child : description.scene->children)
      if (child.object->family == "sensor") types += child.object->type + " ";
    return types;
  };
  EXPECT_EQ(types_with("",
                       "the scene has 3 cameras: 'front' is used, the others are left out: "
                       "'plan', the one at t.xml:2:67"),
            "perspective ");
  EXPECT_EQ(types_with("plan", ""), "orthographic ");
  Description description = parse_mitsuba_xml(text, "t.xml", "");
  EXPECT_THROW(choose_camera(description, "planet"), Error);
  choose_camera(description, "front");
  override_property(description, "sensor.fov=20");
  EXPECT_NEAR(build_scene(description)->camera().traits().horizontal_fov, 20, 1e-3);
}

}  // namespace
}  // namespace kaustik
