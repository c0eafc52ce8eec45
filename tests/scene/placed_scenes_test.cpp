// Scenes in scenes: instances of groups that hold instances, lamps, whole files.

#include "kaustik/scene/placed_scenes.h"

#include <filesystem>
#include <fstream>
#include <random>

#include "kaustik/loader/scene_format.h"
#include "tests/scene/scene_support.h"

namespace kaustik {
namespace {

using namespace test;

std::string shape(const std::string& type, const std::string& transform,
                  const std::string& inside = "") {
  return "<shape type=\"" + type + "\"><transform name=\"to_world\">" + transform + "</transform>" +
         inside + "</shape>";
}
std::string instance(const std::string& group, const std::string& transform) {
  return shape("instance", transform, "<ref id=\"" + group + "\"/>");
}
std::string group(const std::string& id, const std::string& inside) {
  return "<shape type=\"shapegroup\" id=\"" + id + "\">" + inside + "</shape>";
}
const std::string turned = "<rotate value=\"1, 2, 3\" angle=\"40\"/>";
const std::string stretched = "<scale value=\"0.5, 1, 1.5\"/>";
const std::string left = "<translate value=\"-2, 0.5, 0\"/>",
                  right = "<translate value=\"2, 0, 1\"/>";
const std::string small = "<scale value=\"0.4\"/>";

/// A cube and a disk, placed twice beside a disk, all that placed twice; and the same written out.
const std::string nested = any_camera +
                           group("inner", shape("cube", stretched) + shape("disk", left)) +
                           group("outer", shape("disk", small) + instance("inner", turned + left) +
                                              instance("inner", small + right)) +
                           instance("outer", turned) + instance("outer", stretched + right);
std::string written_out() {
  std::string text = any_camera;
  for (const std::string& top : {turned, stretched + right}) {
    text += shape("disk", small + top);
    for (const std::string& inner : {turned + left, small + right})
      text += shape("cube", stretched + inner + top) + shape("disk", left + inner + top);
  }
  return text;
}

TEST(PlacedScenes, NestedInstancesAreWhereTheirTransformsPutThem) {
  const auto placed = scene_of(nested), flat = scene_of(written_out());
  EXPECT_EQ(placed->surface_count(), 3u);  // shared by all placements
  EXPECT_EQ(flat->surface_count(), 10u);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  int hits = 0, different = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3f from = normalize(Vec3f(uniform(random), uniform(random), uniform(random))) * 8.0f;
    const Vec3f to = Vec3f(uniform(random), uniform(random), uniform(random)) * 3.0f;
    const Ray ray{from, normalize(to - from)};
    Hit a, b;
    const bool in_placed = placed->intersect(ray, a), in_flat = flat->intersect(ray, b);
    if (in_placed != in_flat || (in_placed && std::fabs(a.t - b.t) > 1e-4f)) {
      ++different;  // at edges rounding decides
      continue;
    }
    if (!in_placed) continue;
    ++hits;
    const SurfacePoint p = placed->tracer().surface_point(ray, a);
    const SurfacePoint q = flat->tracer().surface_point(ray, b);
    EXPECT_LT(length(p.position - q.position), 1e-4f);
    EXPECT_GT(dot(p.ng, q.ng), 0.9999f);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LE(different, 2);
  const Bounds3f a = placed->tracer().bounds(), b = flat->tracer().bounds();
  EXPECT_LE(a.min.x, b.min.x + 1e-4f);  // of boxes, not of shapes
  EXPECT_GE(a.max.z, b.max.z - 1e-4f);
}

TEST(PlacedScenes, BringTheirLamps) {
  const std::string inside =
      shape("disk", small, "<emitter type=\"area\"/>") +
      "<emitter type=\"point\"><point name=\"position\" value=\"1, 2, 3\"/></emitter>"
      "<emitter type=\"spot\"><transform name=\"to_world\"><translate value=\"0, 1, 0\"/>"
      "</transform></emitter>";
  const std::string twice = "<scale value=\"2\"/>" + left;
  const auto placed = scene_of(any_camera + group("lamps", inside) +
                               group("house", instance("lamps", right) + shape("cube", small)) +
                               instance("house", twice) + instance("lamps", turned));
  const auto flat = scene_of(any_camera + shape("cube", small + twice) +
                             shape("disk", small + right + twice, "<emitter type=\"area\"/>") +
                             shape("disk", small + turned, "<emitter type=\"area\"/>") + [&] {
                               std::string emitters;
                               for (const std::string& place : {right + twice, turned})
                                 emitters +=
                                     "<emitter type=\"point\"><transform name=\"to_world\">"
                                     "<translate value=\"1, 2, 3\"/>" +
                                     place +
                                     "</transform></emitter>"
                                     "<emitter type=\"spot\"><transform name=\"to_world\">"
                                     "<translate value=\"0, 1, 0\"/>" +
                                     place + "</transform></emitter>";
                               return emitters;
                             }());
  ASSERT_EQ(placed->lights().size(), 6u);
  ASSERT_EQ(flat->lights().size(), 6u);
  for (const auto& light : placed->lights()) {
    const LightBounds here = light->traits().bounds;
    const bool found = std::any_of(flat->lights().begin(), flat->lights().end(), [&](auto& other) {
      const LightBounds there = other->traits().bounds;
      return length(here.position.min - there.position.min) < 1e-4f &&
             length(here.position.max - there.position.max) < 1e-4f &&
             dot(here.axis, there.axis) > 0.9999f &&
             std::fabs(light->traits().power[1] / other->traits().power[1] - 1) < 1e-5f;
    });
    EXPECT_TRUE(found) << here.position.min.x << " " << here.position.min.y;
  }
  for (const auto& light : placed->lights())
    if (light->traits().shape >= 0) {
      EXPECT_GE(placed->surface(uint32_t(light->traits().shape)).light, 0);
    }
}

/// Of suns the direction is turned, whether their type has a transform beside it or not.
TEST(PlacedScenes, DirectionsTurnWithTheirScene) {
  const std::string quarter = "<rotate x=\"1\" angle=\"30\"/>";
  for (const std::string& sun :
       {std::string("<emitter type=\"directional\"><vector name=\"direction\" value=\"0, 1, 2\"/>"
                    "</emitter>"),
        std::string("<emitter type=\"sun\"><vector name=\"sun_direction\" value=\"0, 1, 2\"/>"
                    "</emitter>")}) {
    const auto placed = scene_of(any_camera + group("g", sun) + instance("g", quarter));
    const auto plain = scene_of(any_camera + sun);
    ASSERT_EQ(placed->lights().size(), 1u);
    const auto toward = [](const Scene& scene) {
      return scene.lights()[0]->sample_toward({}, {0.5f, 0.5f}).direction;
    };
    const Vec3f expected = Transform::rotate({1, 0, 0}, 30).vector(toward(*plain));
    EXPECT_LT(length(toward(*placed) - expected), 0.02f) << sun;  // the sun's own width
  }
}

TEST(PlacedScenes, GroupsWithoutScenesStayWhatTheyAre) {
  const Description before =
      description_of(any_camera + group("g", shape("cube", small)) + instance("g", left));
  std::vector<std::string> warnings;
  const Description after = flatten_placed_scenes(before, warnings);
  ASSERT_EQ(after.scene->children.size(), before.scene->children.size());
  for (size_t i = 0; i < after.scene->children.size(); ++i)
    EXPECT_EQ(after.scene->children[i].object, before.scene->children[i].object);
  EXPECT_TRUE(warnings.empty());
}

TEST(PlacedScenes, Mistakes) {
  expect_problem(any_camera + group("g", "\n<emitter type=\"constant\"/>") + instance("g", left),
                 "3:1", "lights the whole world", "top of the scene");
  std::string towers = any_camera + group("g0", shape("cube", small));
  for (int i = 1; i <= 20; ++i) {
    const std::string below = "g" + std::to_string(i - 1);
    towers += group("g" + std::to_string(i), instance(below, left) + instance(below, right));
  }
  EXPECT_NE(problems_of(towers + instance("g20", left))[0].message.find("more than 1000000"),
            std::string::npos);
  expect_problem(any_camera + group("g", "\n<shape type=\"instance\"/>" + shape("cube", small)) +
                     instance("g", left),
                 "3:1", "an instance needs exactly one shape group", "of type 'shapegroup'");
  // No loader lets a group hold itself.
  Description endless =
      description_of(any_camera + group("g", shape("cube", small)) + instance("g", left));
  const auto& children = endless.scene->children;
  children[1].object->children.push_back(children[2]);
  try {
    build_scene(endless);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("more than 64 levels"), std::string::npos);
  }
  children[1].object->children.pop_back();
}

/// A file may be the content of a group.
class SceneFiles : public testing::Test {
 protected:
  SceneFiles() : folder_(std::filesystem::path(testing::TempDir()) / "placed_scenes") {
    std::filesystem::create_directories(folder_);
  }
  ~SceneFiles() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& objects) const {
    std::ofstream(folder_ / name) << "<scene version=\"3.0.0\">" << objects << "</scene>";
    return (folder_ / name).string();
  }
  static std::string include(const std::string& file) {
    return "<include filename=\"" + file + "\"/>";
  }
  std::filesystem::path folder_;
};
TEST_F(SceneFiles, ASceneOfItsOwnIsPlaced) {
  write("chair.xml", shape("cube", small) + any_camera);
  write("room.xml", group("chair", include("chair.xml")) + instance("chair", left) +
                        instance("chair", right) + "<integrator type=\"path\"/>" +
                        "<emitter type=\"point\"/>");
  const std::string house =
      write("house.xml", any_camera + group("room", include("room.xml")) + instance("room", left) +
                             instance("room", right));
  const auto scene = build_scene(load_scene(house));
  EXPECT_EQ(scene->surface_count(), 1u);
  EXPECT_EQ(scene->tracer().geometry().instances.size(), 4u);
  EXPECT_EQ(scene->lights().size(), 2u);
  ASSERT_EQ(scene->warnings().size(), 2u);
  EXPECT_NE(scene->warnings()[0].find("of a placed scene has no effect"), std::string::npos);
}
TEST_F(SceneFiles, NoFileHoldsItself) {
  const std::string house =
      write("house.xml", any_camera + group("room", include("house.xml")) + instance("room", left));
  try {
    load_scene(house);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("circular <include>"), std::string::npos);
  }
}

TEST(PlacedScenes, CopiesOfLampsAreCounted) {
  std::string lamps, places;
  for (int i = 0; i < 400; ++i) {
    lamps += "<emitter type=\"point\"/>";
    places += "<shape type=\"instance\"><ref id=\"lamps\"/></shape>";
  }
  const std::string text = std::string(any_camera) + group("lamps", lamps) + places;
  const std::vector<Problem> problems = problems_of(text);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("more than 100000 lamps"), std::string::npos);
  std::vector<std::string> warnings;
  const std::string fewer =
      std::string(any_camera) + group("lamps", lamps) + places.substr(0, places.size() / 4);
  EXPECT_EQ(flatten_placed_scenes(description_of(fewer), warnings).scene->children.size(),
            2u + 100 * 400);  // the camera and the group itself
}

}  // namespace
}  // namespace kaustik
