// OBJ files as scenes of their own.

#include "kaustik/loader/obj_scene.h"

#include <cmath>

#include "kaustik/loader/closed_mesh.h"
#include "kaustik/loader/scene_format.h"
#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

const std::string two_parts =
    "mtllib scene.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n"
    "usemtl wall\nf 1 2 3\nusemtl lamp\nf 1 2 4\nusemtl wall\nf 2 3 4\n";

class ObjScenes : public testing::Test {
 protected:
  Description load(const std::string& mtl, const std::string& obj = two_parts) {
    if (!mtl.empty()) folder_.write("scene.mtl", mtl);
    return load_scene(folder_.write("scene.obj", obj));
  }
  kaustik::TemporaryFolder folder_;
};

TEST_F(ObjScenes, HaveAShapeForEachMaterial) {
  const Description description =
      load("newmtl wall\nKd 0.8 0.1 0.2\nnewmtl lamp\nKd 0 0 0\nKe 3 2 1\n");
  const auto shapes = objects_in(*description.scene, "shape");
  ASSERT_EQ(shapes.size(), 2u);  // the lamp shines: no studio
  EXPECT_EQ(value<std::string>(*shapes[0], "material"), "wall");
  EXPECT_EQ(value<std::string>(*shapes[0], "filename"), folder_ / "scene.obj");
  EXPECT_EQ(only_in(*shapes[0], "bsdf").type, "twosided");
  EXPECT_EQ(value<Rgb>(core_of(*shapes[0]), "reflectance"), (Rgb{0.8, 0.1, 0.2}));
  EXPECT_EQ(value<Rgb>(only_in(*shapes[1], "emitter"), "radiance"), (Rgb{3, 2, 1}));
  EXPECT_EQ(only_in(*description.scene, "sensor").type, "perspective");
  EXPECT_EQ(description.sources,
            (std::vector<std::string>{folder_ / "scene.obj", folder_ / "scene.mtl"}));
  // Without normals of its own it is smooth but at creases.
  EXPECT_EQ(value<double>(*shapes[0], "max_smooth_angle"), 30);
  EXPECT_TRUE(has_deviation(description, DeviationKind::approximated, "normals"));
}

TEST_F(ObjScenes, WithoutALampGetAStudio) {
  const Description description = load("newmtl wall\nKd 1 1 1\n");
  EXPECT_EQ(only_in(*description.scene, "emitter").type, "constant");
  EXPECT_TRUE(has_deviation(description, DeviationKind::missing, "light"));
  EXPECT_TRUE(has_deviation(description, DeviationKind::missing, "material 'lamp'"));
}

TEST_F(ObjScenes, KeysOfPhysicalRenderingMakeOpenPbr) {
  const Description description = load(
      "newmtl wall\nKd 0.5 0.5 0.5\nPr 0.25\nPm 1\nPc 0.5\nPcr 0.1\nPs 0.3\naniso 0.2\nNi 1.45\n"
      "norm no.png\n");
  const Object& core = core_of(only_in(*description.scene, "shape"));
  EXPECT_EQ(core.type, "openpbr");
  EXPECT_EQ(value<Rgb>(core, "base_color"), (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(value<double>(core, "specular_roughness"), 0.25);
  EXPECT_EQ(value<double>(core, "base_metalness"), 1);
  EXPECT_EQ(value<double>(core, "coat_weight"), 0.5);
  EXPECT_EQ(value<double>(core, "coat_roughness"), 0.1);
  EXPECT_EQ(value<double>(core, "fuzz_weight"), 0.3);
  EXPECT_EQ(value<double>(core, "specular_roughness_anisotropy"), 0.2);
  EXPECT_EQ(value<double>(core, "specular_ior"), 1.45);
  EXPECT_TRUE(has_deviation(description, DeviationKind::missing, "no such picture"));
}

TEST_F(ObjScenes, MapsAreTextures) {
  folder_.write("n.png", "x");
  folder_.write("e.png", "x");
  const Description description = load(
      "newmtl wall\nmap_Kd no.png\nmap_Pr -imfchan g n.png\nnorm -bm 0.5 n.png\nd 0.5\n"
      "newmtl lamp\nKe 2 2 2\nmap_Ke e.png\n");
  const auto shapes = objects_in(*description.scene, "shape");
  const Object& mask = only_in(*shapes[0], "bsdf");
  EXPECT_EQ(mask.type, "mask");
  EXPECT_EQ(value<double>(mask, "opacity"), 0.5);
  const Object& relief = only_in(only_in(mask, "bsdf"), "bsdf");
  EXPECT_EQ(relief.type, "normalmap");
  EXPECT_EQ(value<double>(relief, "strength"), 0.5);
  const Object& core = core_of(*shapes[0]);
  EXPECT_EQ(child_named(core, "base_color").type, "checkerboard");
  EXPECT_EQ(value<std::string>(child_named(core, "specular_roughness"), "channel"), "g");
  const Object& scale = child_named(only_in(*shapes[1], "emitter"), "radiance");
  EXPECT_EQ(value<Rgb>(scale, "scale"), (Rgb{2, 2, 2}));
}

TEST_F(ObjScenes, WhatIsWrongIsTold) {
  EXPECT_TRUE(has_deviation(load(""), DeviationKind::missing, "file of materials 'scene.mtl'"));
  EXPECT_TRUE(has_deviation(load("newmtl wall\nKd red\n"), DeviationKind::ignored,
                            "does not hold the numbers"));
  const std::string path = folder_.write("empty.obj", "v 0 0 0\n");
  expect_problem(problems_of([&] { load_scene(path); }), path, "no faces", "polygons");
  LoadOptions options;
  options.definitions = {{"a", "b"}};
  const std::string scene_path = folder_.write("scene.obj", two_parts);
  EXPECT_NE(problems_of([&] { load_scene(scene_path, options); })[0].message.find("'a'"),
            std::string::npos);
}

TEST_F(ObjScenes, LinesAndPointsAreLeftOut) {
  const std::string path =
      folder_.write("l.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\np 1\n");
  const Description description = load_scene(path);
  EXPECT_TRUE(has_deviation(description, DeviationKind::ignored, "lines and points"));
  EXPECT_FALSE(has_deviation(load(""), DeviationKind::ignored, "lines and points"));
}

TEST(ObjScene, IsRecognisedByItsLines) {
  EXPECT_TRUE(is_obj("# by hand\nmtllib a.mtl\no thing\n"));
  EXPECT_TRUE(is_obj("v 1 2 3\nvn 0 0 1\nf 1 2 3\n"));
  EXPECT_FALSE(is_obj("# nothing else\n"));
  EXPECT_FALSE(is_obj("g\nWorldBegin\n"));
  EXPECT_FALSE(is_obj("v 1 2\n"));
  EXPECT_FALSE(is_obj("newmtl a\nKd 1 1 1\n"));
}

TEST(ClosedMesh, EveryEdgeHasTwoSides) {
  const auto positions = Array::of<float>({4, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const auto is = [&](std::vector<uint32_t> faces) {
    const size_t count = faces.size() / 3;
    return is_closed(*positions, *Array::of<uint32_t>({count, 3}, std::move(faces)));
  };
  EXPECT_TRUE(is({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  EXPECT_FALSE(is({0, 2, 1, 0, 1, 3, 0, 3, 2}));
  EXPECT_FALSE(is({0, 1, 2, 0, 1, 3, 0, 3, 2, 1, 2, 3}));  // one is turned over
  EXPECT_FALSE(is({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 9}));  // out of range
}

}  // namespace
}  // namespace kaustik::test
