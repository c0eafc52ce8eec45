// Colours of meshes in scenes: each shape shows its own.

#include <fstream>

#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

class MeshAttributes : public testing::Test {
 protected:
  MeshAttributes() {
    write("red.obj", "1 0 0");
    write("green.obj", "0 1 0");
    std::ofstream(folder_.path("plain.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  }
  void write(const std::string& name, const std::string& colour) const {
    std::ofstream(folder_.path(name))
        << "v 0 0 0 " << colour << "\nv 1 0 0 " << colour << "\nv 0 1 0 0 0 0\nf 1 2 3\n";
  }
  std::string mesh(const std::string& name, const std::string& inside,
                   const std::string& type = "obj") const {
    return "\n<shape type=\"" + type + "\" id=\"" + name + "\"><string name=\"filename\" value=\"" +
           folder_.path(name + ".obj") + "\"/>" + inside + "</shape>";
  }
  static Spectrum albedo_at(const Scene& scene, uint32_t shape, const Vec3f& position) {
    TextureCoordinates at;
    at.position = position;
    BsdfContext context;
    context.move_to(at, {});
    return scene.surface(shape).bsdf->albedo(context, {0, 0, 1}, Lobes::all);
  }

  TemporaryFolder folder_;
};

const std::string colour_of_vertices =
    "<texture type=\"mesh_attribute\" name=\"reflectance\"><string name=\"name\" "
    "value=\"vertex_color\"/><float name=\"scale\" value=\"0.5\"/></texture>";
const std::string painted =
    any_camera + std::string("<bsdf type=\"twosided\" id=\"paint\"><bsdf type=\"diffuse\">") +
    colour_of_vertices + "</bsdf></bsdf>";

/// One bsdf, two meshes.
TEST_F(MeshAttributes, AreThoseOfTheShape) {
  const auto scene =
      scene_of(painted + mesh("red", "<ref id=\"paint\"/>") + mesh("green", "<ref id=\"paint\"/>"));
  for (const float y : {0.0f, 0.5f}) {
    const Spectrum red = albedo_at(*scene, 0, {0.1f, y, 0}),
                   green = albedo_at(*scene, 1, {0.1f, y, 0});
    EXPECT_NEAR(red[0], 0.5f * (1 - y), 1e-6f);
    EXPECT_EQ(red[1], 0);
    EXPECT_NEAR(green[1], 0.5f * (1 - y), 1e-6f);
    EXPECT_EQ(green[0], 0);
  }
  EXPECT_TRUE(scene->warnings().empty());
}

TEST_F(MeshAttributes, ThatAreMissingAreToldWithThoseThatAreThere) {
  const auto expect_told = [](const std::string& text, const std::string& message,
                              const std::string& remedy) {
    Description description = description_of(text);
    const auto scene = build_scene(description);
    ASSERT_EQ(scene->warnings().size(), 1u);
    const std::string& told = scene->warnings()[0];
    EXPECT_TRUE(told.starts_with("test.xml:2:133: ")) << told;
    EXPECT_NE(told.find(message), std::string::npos) << told;
    EXPECT_NE(told.find(remedy), std::string::npos) << told;
    // As in Mitsuba.
    EXPECT_EQ(albedo_at(*scene, 0, {0.1f, 0.1f, 0})[0], 0);
    description.is_strict = true;
    EXPECT_THROW(build_scene(description), Error);
  };
  expect_told(painted + mesh("plain", "<ref id=\"paint\"/>"),
              "the mesh of plain has no attribute 'vertex_color'", "none at all");
  std::string misspelt = painted;
  misspelt.replace(misspelt.find("vertex_color"), 12, "vertex_paint");
  expect_told(misspelt + mesh("red", "<ref id=\"paint\"/>"),
              "the mesh of red has no attribute 'vertex_paint'", "Valid: vertex_color");
  expect_told(painted + "<shape type=\"sphere\"><ref id=\"paint\"/></shape>", "is no mesh",
              "another texture");
  // Where no shape has it nothing is missing.
  EXPECT_NO_THROW(scene_of(painted + any_shape));
}

/// A lamp that is as bright as its vertices.
TEST_F(MeshAttributes, ShineOnLamps) {
  std::string lamp = "<emitter type=\"area\">" + colour_of_vertices +
                     "<float name=\"scale\" value=\"10\"/></emitter>";
  lamp.replace(lamp.find("reflectance"), 11, "radiance");
  const auto scene = scene_of(any_camera + mesh("red", lamp));
  const Light& light = *scene->lights().at(0);
  const Ray ray{{0.25f, 0.25f, 1}, {0, 0, -1}};
  Hit hit;
  ASSERT_TRUE(scene->intersect(ray, hit));
  const Spectrum seen = light.emitted(scene->tracer().surface_point(ray, hit), {0, 0, 1}, {});
  EXPECT_NEAR(seen[0], 10 * 0.5f * 0.75f, 1e-5f);
  EXPECT_EQ(seen[1], 0);
  // Two thirds of the full colour in the mean, over half a square metre.
  EXPECT_NEAR(light.traits().power[0], pi * 0.5f * 10 * 0.5f * 2 / 3, 0.02f);
}

TEST_F(MeshAttributes, AreOfNoUseToLampsWithoutAMesh) {
  Description description =
      description_of(any_camera + std::string("<shape type=\"sphere\"><emitter type=\"area\">"
                                              "<texture type=\"mesh_attribute\" name=\"radiance\">"
                                              "<string name=\"name\" value=\"vertex_color\"/>"
                                              "</texture></emitter></shape>"));
  const auto scene = build_scene(description);
  ASSERT_FALSE(scene->warnings().empty());
  EXPECT_NE(scene->warnings()[0].find("is no mesh"), std::string::npos) << scene->warnings()[0];
  EXPECT_EQ(scene->lights()[0]->traits().power[1], 0);
  description.is_strict = true;
  EXPECT_THROW(build_scene(description), Error);
}

/// Two meshes with one bsdf; the second is moved.
Description painted_meshes(double offset) {
  const auto object = [](std::string family, std::string type, std::vector<Property> properties,
                         std::vector<Child> children) {
    return std::make_shared<Object>(Object{std::move(family), std::move(type), "",
                                           std::move(properties), std::move(children),
                                           place_in("program")});
  };
  const Value positions(Array::of<float>({3, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0})),
      faces(Array::of<int32_t>({1, 3}, {0, 1, 2})),
      colours(Array::of<float>({3, 3}, {0, 1, 0, 0, 1, 0, 0, 0, 0}));
  const auto texture =
      object("texture", "mesh_attribute", {{"name", std::string("vertex_color"), {}}}, {});
  const auto paint = object("bsdf", "diffuse", {}, {{"reflectance", texture}});
  Description description = description_of(any_camera);
  for (const double x : {0.0, offset})
    description.scene->children.push_back(
        {"", object("shape", "mesh",
                    {{"positions", positions, {}},
                     {"faces", faces, {}},
                     {"vertex_color", colours, {}},
                     {"to_world", Transform::translate({x, 0, 0}), {}}},
                    {{"", paint}})});
  return description;
}

/// Only what has to do with the mesh that has changed is made anew.
TEST_F(MeshAttributes, AreSharedByTheNextScene) {
  const auto first = build_scene(painted_meshes(1));
  EXPECT_EQ(first->build_counts().textures, 2);
  EXPECT_EQ(first->build_counts().bsdfs, 2);
  const auto same = build_scene(painted_meshes(1), first);
  EXPECT_EQ(same->build_counts().textures, 0);
  EXPECT_EQ(same->build_counts().bsdfs, 0);
  const auto moved = build_scene(painted_meshes(2), same);
  EXPECT_EQ(moved->build_counts().shapes, 1);
  EXPECT_EQ(moved->build_counts().textures, 1);
  EXPECT_EQ(moved->build_counts().bsdfs, 1);
  EXPECT_NEAR(albedo_at(*moved, 0, {0.1f, 0, 0})[1], 1, 1e-6f);
  EXPECT_NEAR(albedo_at(*moved, 1, {2.1f, 0.5f, 0})[1], 0.5f, 1e-6f);
}

}  // namespace
}  // namespace kaustik
