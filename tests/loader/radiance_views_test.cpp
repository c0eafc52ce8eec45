// Views of Radiance, and rad's control files.
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

const double one_degree = std::numbers::pi / 180;

class RadianceViews : public testing::Test {
 protected:
  RadianceViews() {
    folder_.write("room.mat", grey);
    folder_.write("room.rad", square);
  }
  Description with_view(const std::string& view, const std::string& more = "") {
    return load_radiance(folder_.write(
        "room.rif", "materials= room.mat\nscene= room.rad\n" + more + "view= " + view + "\n"));
  }
  TemporaryFolder folder_;
};

TEST_F(RadianceViews, Perspective) {
  const auto scene =
      with_view("nice -vtv -vp 1 2 3 -vd 0 2 0 -vu 0 0 1 -vh 60 -vv 40 -vs .1 -vl -.2 -vo 1 -va 50",
                "RESOLUTION= 800\nEXPOSURE= +2\n");
  const Object& camera = sole_object(scene, "sensor");
  EXPECT_EQ(camera.type, "perspective");
  EXPECT_EQ(camera.id, "nice");
  EXPECT_EQ(*number_in(camera, "fov"), 60);
  EXPECT_EQ(*number_in(camera, "principal_point_offset_x"), .1);
  EXPECT_EQ(*number_in(camera, "principal_point_offset_y"), .2);
  EXPECT_EQ(*number_in(camera, "near_clip"), 1);
  EXPECT_EQ(*number_in(camera, "far_clip"), 50);
  const auto& placed = value<Transform>(camera, "to_world");
  EXPECT_NEAR((placed.point({0, 0, 0}) - Vec3f(1, 2, 3)).length(), 0, 1e-6);
  EXPECT_NEAR((placed.vector({0, 0, 1}) - Vec3f(0, 1, 0)).length(), 0, 1e-6);
  EXPECT_NEAR((placed.vector({1, 0, 0}) - Vec3f(-1, 0, 0)).length(), 0, 1e-6);  // to the left
  const Object& film = nested(camera, "film");
  EXPECT_EQ(value<int64_t>(film, "width"), 800);
  EXPECT_EQ(value<int64_t>(film, "height"),
            std::lround(800 * std::tan(20 * one_degree) / std::tan(30 * one_degree)));
  EXPECT_EQ(value<double>(film, "exposure"), 2);
  EXPECT_EQ(deviations_but_view(scene), 0u);
  EXPECT_EQ(scene.sources.size(), 3u);
}

TEST_F(RadianceViews, Parallel) {
  const auto scene =
      with_view("plan -vtl -vp 0 0 9 -vd 0 0 -1 -vu 0 1 0 -vh 8 -vv 4 -vs .5 -vl .25");
  const Object& camera = sole_object(scene, "sensor");
  EXPECT_EQ(camera.type, "orthographic");
  const auto& placed = value<Transform>(camera, "to_world");
  EXPECT_NEAR(placed.vector({1, 0, 0}).length(), 4, 1e-5);
  EXPECT_NEAR((placed.point({0, 0, 0}) - Vec3f(4, 1, 9)).length(), 0, 1e-5);
  EXPECT_EQ(value<int64_t>(nested(camera, "film"), "height"), 256);
}

TEST_F(RadianceViews, Fisheyes) {
  for (const auto& [letter, mapping] :
       {std::pair("a", "equidistant"), {"h", "hemispherical"}, {"s", "stereographic"}}) {
    const auto scene =
        with_view(std::string("-vt") + letter + " -vd 0 0 1 -vu 0 1 0 -vh 180 -vv 180");
    const Object& camera = sole_object(scene, "sensor");
    EXPECT_EQ(camera.type, "fisheye");
    EXPECT_EQ(value<std::string>(camera, "mapping"), mapping);
    EXPECT_EQ(*number_in(camera, "fov"), 180);
    EXPECT_EQ(value<int64_t>(nested(camera, "film"), "height"), 512);
  }
}

TEST_F(RadianceViews, Cylinder) {
  const auto scene = with_view("-vtc -vh 360 -vv 90", "RESOLUTION= 2000 1000\n");
  EXPECT_EQ(sole_object(scene, "sensor").type, "cylinder");
  EXPECT_EQ(value<int64_t>(nested(sole_object(scene, "sensor"), "film"), "height"),
            std::lround(2000 * 2 / (2 * std::numbers::pi)));
}

TEST_F(RadianceViews, SeveralAndFromFiles) {
  folder_.write("eye.vf", "rvu -vtv -vp 0 0 1 -vd 0 1 0\n");
  const auto scene = with_view("one -vtv -vh 30\nview= two -vf eye.vf -vh 20");
  const auto cameras = rad_objects(scene, "sensor");
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[1]->id, "two");
  EXPECT_EQ(*number_in(*cameras[1], "fov"), 20);
}

TEST_F(RadianceViews, FilesThatAreNotThereAreTold) {
  const auto scene = with_view("one -vtv -vh 30\nview= two -vf no.vf");
  EXPECT_EQ(sole_object(scene, "sensor").id, "one");
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "view 'no.vf'", "no such file"));
}

TEST_F(RadianceViews, AViewFileShowsTheSceneBesideIt) {
  with_view("one -vtv");
  const auto scene = load_radiance(folder_.write("eye.vf", "rvu -vtv -vp 0 0 7 -vd 0 1 0\n"));
  const auto cameras = rad_objects(scene, "sensor");
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0]->id, "eye");
  EXPECT_EQ(value<Transform>(*cameras[0], "to_world").point({0, 0, 0}).z, 7);
}

TEST_F(RadianceViews, ScenesWithoutAViewShowAllFromAbove) {
  const auto scene = parse_rad(grey + square);
  const Object& camera = sole_object(scene, "sensor");
  EXPECT_EQ(camera.type, "perspective");
  const auto& placed = value<Transform>(camera, "to_world");
  EXPECT_GT(placed.point({0, 0, 0}).z, 0.1);
  EXPECT_LT(placed.vector({0, 0, 1}).z, 0);
  EXPECT_GT(placed.vector({0, 1, 0}).z, 0.5);
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "camera"));
}

TEST_F(RadianceViews, ScenesWithoutLightGetSomeFromAbove) {
  const auto scene = parse_rad(grey + square);
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "light"));
  for (const Child& child : scene.scene->children)
    if (child.object->type == "rectangle") {
      EXPECT_GT(value<Transform>(*child.object, "to_world").point({0, 0, 0}).z, 1);
    }
  EXPECT_FALSE(tells(parse_rad(grey + square +
                               "void light l 0 0 3 1 1 1\n"
                               "l sphere s 0 0 4 0 0 5 1\n"),
                     DeviationKind::missing, "light"));
}

TEST_F(RadianceViews, MistakesHaveAPlaceAndARemedy) {
  const auto wrong = [&](const std::string& text, const std::string& place,
                         const std::string& message, const std::string& remedy) {
    const std::string path =
        folder_.write("w.rif", "materials= room.mat\nscene= room.rad\n" + text);
    expect_problem(problems_of([&] { load_radiance(path); }), path + place, message, remedy);
  };
  wrong("QUALTY= high\n", ":3:1", "no variable 'QUALTY'", "did you mean 'QUALITY'");
  wrong("RESOLUTION= many\n", ":3:1", "no size", "pixels");
  wrong("view= a -vp 0 0\n", ":3:1", "'-vp' lacks a number", "-vtv -vp");
  wrong("view= a -vd 0 0 1\n", ":3:1", "parallel", "-vu");
  wrong("view= a -vtx -vp 0 0 0\n", ":3:1", "no view of type '-vtx'", "-vtv");
  // Nothing of the scene is there.
  const std::string path = folder_.write("e.rif", "materials= no.mat\nscene= none.rad\n");
  expect_problem(problems_of([&] { load_radiance(path); }), path + ":1:1", "no file 'no.mat'",
                 "relative");
}

TEST_F(RadianceViews, APartThatIsMissingIsLeftOut) {
  const Description scene =
      load_radiance(folder_.write("p.rif", "materials= no.mat\nscene= room.rad none.rad\n"));
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "file no.mat", "no such file"));
  EXPECT_TRUE(tells(scene, DeviationKind::missing, "file none.rad", "no such file"));
  EXPECT_FALSE(rad_objects(scene, "shape").empty());
}

}  // namespace
}  // namespace kaustik::radiance_test
