// Nodes, primitives, cameras and lamps of glTF.

#include <cmath>

#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

const Object& first_shape(const Description& description) {
  return only_in(*description.scene, "shape");
}
const Transform& placed(const Description& description) {
  return value<Transform>(first_shape(description), "to_world");
}
void expect_near(const Vec3f& a, const Vec3f& b) { EXPECT_LT(length(a - b), 1e-5f) << a << b; }

TEST(GltfNodes, TransformsFollowOneAnother) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const std::string meshes = R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])";
  // Scale, then a quarter turn about z, then the parent's translation.
  const Description description = parse_gltf_text(buffer.as_json(
      R"("scenes":[{"nodes":[1]}],"nodes":[{"mesh":0,"rotation":[0,0,0.7071067811865476,
         0.7071067811865476],"scale":[2,3,4]},{"children":[0],"translation":[10,0,0]}])" +
      meshes));
  expect_near(placed(description).point(Vec3f(1, 0, 0)), Vec3f(10, 2, 0));
  expect_near(placed(description).point(Vec3f(0, 1, 0)), Vec3f(7, 0, 0));
  // A matrix stands by columns.
  expect_near(
      placed(parse_gltf_text(buffer.as_json(
                 R"("nodes":[{"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,5,6,7,1]}])" + meshes)))
          .point(Vec3f(1, 0, 0)),
      Vec3f(5, 7, 7));
}

TEST(GltfNodes, OnlyTheSceneIsShown) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  const auto shapes = [&](const std::string& nodes) {
    const Description description = parse_gltf_text(
        buffer.as_json(nodes + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"));
    size_t meshes = 0;
    for (const Object* shape : objects_in(*description.scene, "shape"))
      meshes += shape->type == "mesh" ? 1 : 0;
    return meshes;
  };
  const std::string nodes = R"("nodes":[{"mesh":0},{"mesh":0},{"mesh":0,"children":[1]}])";
  EXPECT_EQ(shapes(nodes + R"(,"scenes":[{"nodes":[0]},{"nodes":[2]}])"), 1u);
  EXPECT_EQ(shapes(nodes + R"(,"scene":1,"scenes":[{"nodes":[0]},{"nodes":[2]}])"), 2u);
  EXPECT_EQ(shapes(nodes), 3u);  // without a scene all
  EXPECT_EQ(
      shapes(R"("nodes":[{"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}}])"), 0u);
}

TEST(GltfNodes, AreATree) {
  for (const std::string& nodes :
       {std::string(R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}])"),
        std::string(R"("scenes":[{"nodes":[0,1]}],"nodes":[{"children":[1]},{}])")}) {
    const auto problems =
        problems_of([&] { parse_gltf_text("{\"asset\":{\"version\":\"2.0\"}," + nodes + "}"); });
    EXPECT_NE(problems[0].message.find("two parents"), std::string::npos);
  }
}

TEST(GltfNodes, WhatIsSqueezedToNothingIsTold) {
  const Description description = parse_gltf_text(one_triangle("", "", ",\"scale\":[0,0,0]"));
  EXPECT_TRUE(has_deviation(description, DeviationKind::ignored, "less than a plane"));
}

TEST(GltfPrimitives, StripsAndFansAreTriangles) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0}, "VEC3", 3);
  buffer.add<uint16_t>({4, 3, 2, 1}, "SCALAR", 1);
  const auto faces = [&](const std::string& more) {
    return floats_of(
        first_shape(parse_gltf_text(buffer.as_json(
            R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0})" + more +
            "}]}]"))),
        "faces");
  };
  EXPECT_EQ(faces(",\"mode\":5"), (std::vector<float>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(faces(",\"mode\":6"), (std::vector<float>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
  EXPECT_EQ(faces(",\"mode\":6,\"indices\":1"), (std::vector<float>{4, 3, 2, 4, 2, 1}));
  EXPECT_EQ(faces(",\"indices\":1"), (std::vector<float>{4, 3, 2}));  // what is left over is told
  EXPECT_EQ(faces(""), (std::vector<float>{0, 1, 2}));
}

TEST(GltfPrimitives, LinesAreTold) {
  EXPECT_TRUE(has_deviation(parse_gltf_text(one_triangle("", ",\"mode\":1")),
                            DeviationKind::ignored, "points or lines"));
}

TEST(GltfPrimitives, WithoutNormalsFacesAreFlat) {
  EXPECT_TRUE(value<bool>(first_shape(parse_gltf_text(one_triangle())), "face_normals"));
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  const Description description = parse_gltf_text(buffer.as_json(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1}}]}])"));
  EXPECT_EQ(floats_of(first_shape(description), "normals"),
            (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
}

TEST(GltfPrimitives, ColoursOfVerticesAreTexturesAndOpacities) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<uint8_t>({255, 0, 0, 255, 0, 255, 0, 51, 0, 0, 255, 255}, "VEC4", 4,
                      ",\"normalized\":true");
  const auto read = [&](const std::string& material) {
    return parse_gltf_text(buffer.as_json(
        R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1},
           "material":0}]}],"materials":[{)" +
        material + "}]"));
  };
  const Description opaque = read(R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1]})");
  const Object& shape = first_shape(opaque);
  EXPECT_EQ(floats_of(shape, "vertex_color"), (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(find_property(shape, "vertex_value"), nullptr);
  const Object& scale = child_named(core_of(shape), "base_color");
  EXPECT_EQ(scale.type, "scale");
  EXPECT_EQ(value<Rgb>(scale, "scale"), (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(value<std::string>(child_named(scale, "value"), "name"), "vertex_color");
  const Description clear = read(R"("alphaMode":"BLEND")");
  EXPECT_EQ(floats_of(first_shape(clear), "vertex_value"), (std::vector<float>{1, 0.2f, 1}));
  EXPECT_EQ(only_in(first_shape(clear), "bsdf").type, "mask");
}

TEST(GltfMeshes, ThoseThatAreThereOftenAreInstances) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  std::string nodes;
  for (int i = 0; i < 60; ++i)
    nodes +=
        std::string(i ? "," : "") + "{\"mesh\":0,\"translation\":[" + std::to_string(i) + ",0,0]}";
  const Description description = parse_gltf_text(buffer.as_json(
      "\"nodes\":[" + nodes + R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"));
  const auto shapes = objects_in(*description.scene, "shape");
  ASSERT_GE(shapes.size(), 60u);
  EXPECT_EQ(shapes[59]->type, "instance");
  EXPECT_EQ(value<Transform>(*shapes[59], "to_world").point(Vec3f(0, 0, 0)), Vec3f(59, 0, 0));
  EXPECT_EQ(shapes[0]->children[0].object, shapes[59]->children[0].object);
  EXPECT_EQ(shapes[0]->children[0].object->type, "shapegroup");
}

TEST(GltfMeshes, InstancesByAccessors) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<float>({1, 0, 0, 0, 2, 0}, "VEC3", 3);
  buffer.add<float>({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4);  // the second by half a turn about z
  const Description description = parse_gltf_text(buffer.as_json(
      R"("nodes":[{"mesh":0,"translation":[0,0,5],"extensions":{"EXT_mesh_gpu_instancing":
         {"attributes":{"TRANSLATION":1,"ROTATION":2}}}}],
         "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"));
  const auto shapes = objects_in(*description.scene, "shape");
  ASSERT_GE(shapes.size(), 2u);
  expect_near(value<Transform>(*shapes[0], "to_world").point(Vec3f(1, 0, 0)), Vec3f(2, 0, 5));
  expect_near(value<Transform>(*shapes[1], "to_world").point(Vec3f(1, 0, 0)), Vec3f(-1, 2, 5));
}

TEST(GltfMeshes, JointsAndTargetsMoveThem) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", 4);
  buffer.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0}, "VEC4", 4);
  buffer.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
  const Description skinned = parse_gltf_text(buffer.as_json(
      R"("nodes":[{"mesh":0,"skin":0,"translation":[100,0,0]},{"translation":[0,0,2]},
         {"translation":[0,0,4]}],"skins":[{"joints":[1,2]}],
         "meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}])"));
  // The node's own transform does not count.
  EXPECT_EQ(floats_of(first_shape(skinned), "positions"),
            (std::vector<float>{0, 0, 2, 1, 0, 4, 0, 1, 3}));
  EXPECT_EQ(find_property(first_shape(skinned), "to_world"), nullptr);
  const Description morphed = parse_gltf_text(buffer.as_json(
      R"("nodes":[{"mesh":0,"weights":[0.5]}],
         "meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":3}]}]}])"));
  EXPECT_EQ(floats_of(first_shape(morphed), "positions"),
            (std::vector<float>{0, 0, 0.5, 1, 0, 0.5, 0, 1, 0.5}));
}

/// Two keys: after two seconds one unit further, and half a turn about z.
std::string animated(const std::string& interpolation, const std::string& path, int output) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<float>({1, 3}, "SCALAR", 1);
  buffer.add<float>({0, 0, 0, 8, 0, 0}, "VEC3", 3);
  buffer.add<float>({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4);
  // Cubic: flat tangents, but for the first one that leaves.
  buffer.add<float>({0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0}, "VEC3", 3);
  buffer.add<float>({0, 0.5}, "SCALAR", 1);
  return buffer.as_json(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},
         "targets":[{"POSITION":0}]}]}],"animations":[{"name":"rest"},{"name":"go","channels":[{
         "sampler":0,"target":{"node":0,"path":")" +
      path + R"("}}],"samplers":[{"input":1,"interpolation":")" + interpolation +
      "\",\"output\":" + std::to_string(output) + "}]}]");
}
Description at_time(const std::string& text, const std::string& time) {
  LoadOptions options;
  options.definitions = {{"gltf.animation", "go"}, {"gltf.time", time}};
  return parse_gltf_text(text, options);
}

TEST(GltfAnimations, StandAtATime) {
  const auto moved = [](const std::string& interpolation, int output, const std::string& time) {
    const Description description = at_time(animated(interpolation, "translation", output), time);
    const auto* to_world = value_in<Transform>(first_shape(description), "to_world");
    return to_world ? double(to_world->point(Vec3f(0, 0, 0)).x) : 0.0;
  };
  EXPECT_EQ(moved("LINEAR", 2, "0"), 0);
  EXPECT_NEAR(moved("LINEAR", 2, "1.5"), 2, 1e-6);
  EXPECT_EQ(moved("LINEAR", 2, "7"), 8);
  EXPECT_EQ(moved("STEP", 2, "2.9"), 0);
  EXPECT_EQ(moved("STEP", 2, "3"), 8);
  // Hermite's spline half way: (p0 + p1)/2 + seconds (m0 − m1)/8.
  EXPECT_NEAR(moved("CUBICSPLINE", 4, "2"), 4 + 2 * 4 / 8.0, 1e-6);
  expect_near(placed(at_time(animated("LINEAR", "rotation", 3), "2")).point(Vec3f(1, 0, 0)),
              Vec3f(0, 1, 0));
  EXPECT_EQ(floats_of(first_shape(at_time(animated("LINEAR", "weights", 5), "2")), "positions")[3],
            1.25f);
}

TEST(GltfAnimations, MustBeThere) {
  LoadOptions options;
  options.definitions = {{"gltf.animation", "goo"}};
  EXPECT_NE(
      problems_of([&] { parse_gltf_text(animated("LINEAR", "scale", 2), options); })[0].remedy.find(
          "go"),
      std::string::npos);
  options.definitions = {{"gltf.time", "1"}};
  EXPECT_NE(problems_of([&] { parse_gltf_text(one_triangle(), options); })[0].message.find(
                "no animations"),
            std::string::npos);
  EXPECT_NE(problems_of([&] { at_time(animated("LINEAR", "rotation", 2), "1"); })[0].message.find(
                "does not go with"),
            std::string::npos);
}

TEST(GltfCameras, LookAlongMinusZ) {
  const Description description = parse_gltf_text(one_triangle(
      R"("cameras":[{"type":"perspective","name":"lens","perspective":{"yfov":1,"aspectRatio":2,
         "znear":0.1}}])",
      "", ",\"camera\":0,\"translation\":[1,2,3]"));
  const Object& sensor = only_in(*description.scene, "sensor");
  EXPECT_EQ(sensor.id, "lens");
  EXPECT_EQ(sensor.type, "perspective");
  EXPECT_NEAR(value<double>(sensor, "fov"), 57.29577951308232, 1e-9);
  EXPECT_EQ(value<std::string>(sensor, "fov_axis"), "y");
  const auto& to_world = value<Transform>(sensor, "to_world");
  expect_near(to_world.point(Vec3f(0, 0, 0)), Vec3f(1, 2, 3));
  expect_near(to_world.vector(Vec3f(0, 0, 1)), Vec3f(0, 0, -1));
  expect_near(to_world.vector(Vec3f(0, 1, 0)), Vec3f(0, 1, 0));
  expect_near(to_world.vector(Vec3f(1, 0, 0)), Vec3f(-1, 0, 0));  // +x is left in the picture
  const Object& film = only_in(sensor, "film");
  EXPECT_EQ(value<int64_t>(film, "width"), 768);
  EXPECT_EQ(value<int64_t>(film, "height"), 384);
}

TEST(GltfCameras, OrthographicOnesAreAsWideAsTheySay) {
  const Description description = parse_gltf_text(one_triangle(
      R"("cameras":[{"type":"orthographic","orthographic":{"xmag":3,"ymag":1.5,"zfar":9,"znear":1}}])",
      "", ",\"camera\":0"));
  const Object& sensor = only_in(*description.scene, "sensor");
  EXPECT_EQ(sensor.type, "orthographic");
  expect_near(value<Transform>(sensor, "to_world").vector(Vec3f(1, 0, 0)), Vec3f(-3, 0, 0));
  EXPECT_EQ(value<int64_t>(only_in(sensor, "film"), "height"), 384);
}

TEST(GltfCameras, AMissingOneSeesAll) {
  const Description description = parse_gltf_text(one_triangle());
  const Object& sensor = only_in(*description.scene, "sensor");
  EXPECT_TRUE(has_deviation(description, DeviationKind::missing, "camera"));
  const auto& to_world = value<Transform>(sensor, "to_world");
  EXPECT_GT(to_world.point(Vec3f(0, 0, 0)).z, 0);
}

std::string with_lamp(const std::string& lamp, const std::string& node = "") {
  return one_triangle("\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[" + lamp + "]}}", "",
                      ",\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}" + node);
}

TEST(GltfLamps, CandelaAndLuxBecomeWatts) {
  const auto lamp_of = [](const std::string& text, const LoadOptions& options = {}) {
    const Description description = parse_gltf_text(text, options);
    EXPECT_EQ(objects_in(*description.scene, "emitter").size(), 1u);  // no studio
    return only_in(*description.scene, "emitter");
  };
  const Object point = lamp_of(with_lamp(R"({"type":"point","intensity":358,"color":[1,0.5,0]})",
                                         ",\"translation\":[1,2,3]"));
  EXPECT_EQ(point.type, "point");
  EXPECT_EQ(value<Rgb>(point, "intensity"), (Rgb{2, 1, 0}));
  EXPECT_EQ(value<Vec3d>(point, "position"), Vec3d(1, 2, 3));
  const Object sun = lamp_of(with_lamp(R"({"type":"directional","intensity":179})",
                                       ",\"rotation\":[1,0,0,0]"));  // half a turn about x
  EXPECT_EQ(value<Rgb>(sun, "irradiance"), (Rgb{1, 1, 1}));
  EXPECT_LT((value<Vec3d>(sun, "direction") - Vec3d(0, 0, 1)).length(), 1e-12);
  const Object spot = lamp_of(with_lamp(
      R"({"type":"spot","intensity":179,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}})"));
  EXPECT_EQ(value<std::string>(spot, "falloff"), "square");
  EXPECT_NEAR(value<double>(spot, "cutoff_angle"), 11.459155902616464, 1e-9);
  EXPECT_NEAR(value<double>(spot, "beam_width"), 5.729577951308232, 1e-9);
  expect_near(value<Transform>(spot, "to_world").vector(Vec3f(0, 0, 1)), Vec3f(0, 0, -1));
  LoadOptions blender;
  blender.definitions = {{"gltf.lamp_efficacy", "683"}};
  EXPECT_EQ(
      value<Rgb>(lamp_of(with_lamp(R"({"type":"point","intensity":683})"), blender), "intensity"),
      (Rgb{1, 1, 1}));
}

TEST(GltfLamps, WithoutAnyThereIsAStudio) {
  const Description description = parse_gltf_text(one_triangle());
  EXPECT_TRUE(has_deviation(description, DeviationKind::missing, "light"));
  EXPECT_EQ(only_in(*description.scene, "emitter").type, "constant");
  EXPECT_EQ(objects_in(*description.scene, "shape")[1]->type, "rectangle");
}

TEST(GltfLamps, RangesAndAnimationsAreTold) {
  EXPECT_TRUE(has_deviation(parse_gltf_text(with_lamp(R"({"type":"point","range":3})")),
                            DeviationKind::ignored, "range"));
  EXPECT_TRUE(has_deviation(parse_gltf_text(one_triangle(R"("animations":[{"name":"walk"}])")),
                            DeviationKind::ignored, "animation 'walk'"));
}

}  // namespace
}  // namespace kaustik::test
