// Containers, buffers and accessors of glTF: where bytes are, and what numbers they become.

#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

const std::string one_mesh =
    R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])";

GltfBuffer triangle_buffer() {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  return buffer;
}
const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

const Object& shape_in(const Description& description) {
  return only_in(*description.scene, "shape");
}

TEST(GltfContainer, BinaryFilesAndDataUrisAndFilesAreTheSame) {
  const GltfBuffer buffer = triangle_buffer();
  EXPECT_EQ(floats_of(shape_in(parse_gltf_text(buffer.as_json(one_mesh))), "positions"), triangle);
  EXPECT_EQ(floats_of(shape_in(parse_gltf_text(buffer.as_glb(one_mesh))), "positions"), triangle);

  const kaustik::TemporaryFolder folder;
  folder.write("a b.bin", buffer.bytes());
  const std::string path = folder.write("scene.gltf", "{\"asset\":{\"version\":\"2.0\"}," +
                                                          buffer.members("\"uri\":\"a%20b.bin\",") +
                                                          "," + one_mesh + "}");
  const Description description = load_gltf(path);
  EXPECT_EQ(floats_of(shape_in(description), "positions"), triangle);
  EXPECT_EQ(description.sources, (std::vector<std::string>{path, folder / "a b.bin"}));
}

TEST(GltfContainer, FilesThatAreCutOffAreRefused) {
  const std::string glb = triangle_buffer().as_glb(one_mesh);
  for (size_t size = 4; size < glb.size(); ++size) {
    SCOPED_TRACE(size);
    const std::vector<Problem> problems =
        problems_of([&] { parse_gltf_text(glb.substr(0, size)); });
    EXPECT_EQ(*problems[0].place.file, "test.gltf");
    EXPECT_FALSE(problems[0].remedy.empty());
  }
}

TEST(GltfContainer, ErrorsNameThePlace) {
  expect_problem(problems_of([] { parse_gltf_text("{\"asset\":{\"version\":\"2.0\"},\n oops}"); }),
                 "test.gltf:2:2", "no JSON", "export");
  expect_problem(problems_of([] { parse_gltf_text("{\"asset\":{\"version\":\"1.0\"}}"); }),
                 "test.gltf:1:10", "glTF 1.0", "2.0");
  expect_problem(
      problems_of([] {
        parse_gltf_text("{\"asset\":{\"version\":\"2.0\"},\n\"scenes\":[{\"nodes\":[7]}]}");
      }),
      "test.gltf:2:21", "node 7 is named", "export");
  const std::string deep = "{\"asset\":" + std::string(200, '[');
  expect_problem(problems_of([&] { parse_gltf_text(deep); }), "test.gltf:1:109", "100 levels",
                 "export");
}

TEST(GltfContainer, ABufferThatIsNotThereLeavesABox) {
  const Description description = parse_gltf_text(
      R"({"asset":{"version":"2.0"},"buffers":[{"uri":"no.bin","byteLength":36}],
          "bufferViews":[{"buffer":0,"byteLength":36}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                        "min":[-1,0,2],"max":[1,4,4]}],)" +
      one_mesh + "}");
  const Object& box = shape_in(description);
  EXPECT_EQ(box.type, "cube");
  const auto& to_world = value<Transform>(box, "to_world");
  EXPECT_EQ(to_world.point(Vec3f(1, 1, 1)), Vec3f(1, 4, 4));
  EXPECT_EQ(to_world.point(Vec3f(-1, -1, -1)), Vec3f(-1, 0, 2));
  EXPECT_TRUE(has_deviation(description, DeviationKind::missing, "no file 'no.bin'"));
}

TEST(GltfContainer, WhatABufferLacksIsRefused) {
  const std::string start = R"({"asset":{"version":"2.0"},"buffers":[{"uri":"data:;base64,AAAA",
      "byteLength":3}],)";
  expect_problem(problems_of([&] {
                   parse_gltf_text(start + R"("bufferViews":[{"buffer":0,"byteLength":36}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)" +
                                   one_mesh + "}");
                 }),
                 "test.gltf:2:39", "bufferView 0 takes 36 bytes", "cut off");
  expect_problem(problems_of([&] {
                   parse_gltf_text(start + R"("bufferViews":[{"buffer":0,"byteLength":3}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)" +
                                   one_mesh + "}");
                 }),
                 "test.gltf:3:20", "accessor 0 takes 36 bytes", "cut off");
}

TEST(GltfContainer, HugeAccessorsOfZerosAreRefused) {
  const std::string text =
      R"({"asset":{"version":"2.0"},
      "accessors":[{"componentType":5126,"count":100000000000,"type":"VEC3"}],)" +
      one_mesh + "}";
  EXPECT_NE(problems_of([&] { parse_gltf_text(text); })[0].message.find("out of proportion"),
            std::string::npos);
}

TEST(GltfAccessors, IntegersMayStandForFractions) {
  GltfBuffer buffer;
  buffer.add<int16_t>({0, 0, 0, 0, 32767, -32768, 16384, 0, 0, 32767, 0, 0}, "VEC3", 3,
                      ",\"normalized\":true");
  buffer.add<uint8_t>({0, 0, 255, 0, 0, 51, 255, 255}, "VEC2", 2, ",\"normalized\":true");
  const Description description = parse_gltf_text(buffer.as_json(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,
         "TEXCOORD_0":1},"mode":5}]}])"));
  const Object& shape = shape_in(description);
  const std::vector<float> positions = floats_of(shape, "positions");
  EXPECT_EQ(positions[4], 1.0f);
  EXPECT_EQ(positions[5], -1.0f);
  EXPECT_NEAR(positions[6], 0.5, 1e-4);
  EXPECT_EQ(floats_of(shape, "uv"), (std::vector<float>{0, 0, 1, 0, 0, 0.2f, 1, 1}));
}

TEST(GltfAccessors, ElementsMayLieApartAndBeReplaced) {
  GltfBuffer buffer;
  const float interleaved[] = {0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9};
  const int view =
      buffer.add_view({reinterpret_cast<const char*>(interleaved), 48}, ",\"byteStride\":16");
  const uint16_t places[] = {2};
  const float values[] = {0, 5, 0};
  const int index_view = buffer.add_view({reinterpret_cast<const char*>(places), 2});
  const int value_view = buffer.add_view({reinterpret_cast<const char*>(values), 12});
  buffer.add_accessor("\"bufferView\":" + std::to_string(view) +
                      R"(,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
      "indices":{"bufferView":)" +
                      std::to_string(index_view) +
                      R"(,"componentType":5123},"values":{"bufferView":)" +
                      std::to_string(value_view) + "}}");
  EXPECT_EQ(floats_of(shape_in(parse_gltf_text(buffer.as_json(one_mesh))), "positions"),
            (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 5, 0}));
}

TEST(GltfAccessors, MeshesShareTheBuffersMemory) {
  GltfBuffer buffer = triangle_buffer();
  buffer.add<uint32_t>({0, 1, 2}, "SCALAR", 1);
  const Description description = parse_gltf_text(buffer.as_glb(
      R"("nodes":[{"mesh":0},{"mesh":0,"translation":[1,0,0]}],
         "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"));
  const auto shapes = objects_in(*description.scene, "shape");
  ASSERT_GE(shapes.size(), 2u);
  using Buffer = std::shared_ptr<const Array>;
  EXPECT_EQ(value<Buffer>(*shapes[0], "positions"), value<Buffer>(*shapes[1], "positions"));
  // Of one and the same memory: the indices follow the positions.
  EXPECT_EQ(value<Buffer>(*shapes[0], "positions")->bytes().data() + 36,
            value<Buffer>(*shapes[0], "faces")->bytes().data());
}

TEST(GltfAccessors, AttributesMustGoTogether) {
  GltfBuffer buffer = triangle_buffer();
  buffer.add<float>({0, 0, 1, 0, 0, 1}, "VEC3", 3);
  const auto problems = problems_of([&] {
    parse_gltf_text(buffer.as_json(
        R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1}}]}])"));
  });
  EXPECT_NE(problems[0].message.find("NORMAL has 2 elements"), std::string::npos);
}

TEST(GltfExtensions, ThoseThatAreRequiredAndUnknownAreErrors) {
  const std::string rest = ",\"extensionsUsed\":[\"VENDOR_x\"]";
  EXPECT_TRUE(has_deviation(parse_gltf_text(triangle_buffer().as_json(one_mesh + rest)),
                            DeviationKind::ignored, "VENDOR_x"));
  const auto problems = problems_of([&] {
    parse_gltf_text(triangle_buffer().as_json(one_mesh + ",\"extensionsRequired\":[\"VENDOR_x\"]"));
  });
  EXPECT_NE(problems[0].message.find("VENDOR_x"), std::string::npos);
  EXPECT_FALSE(problems[0].remedy.empty());
}

TEST(GltfExtensions, MeshesWhosePackedDataAreMissingAreBoxes) {
  const Description description = parse_gltf_text(
      R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],
      "buffers":[{"byteLength":8,"uri":"no.bin"}],"bufferViews":[{"buffer":0,"byteLength":8}],
      "accessors":[{"componentType":5126,"count":100,"type":"VEC3","min":[0,0,0],"max":[2,4,6]},
      {"componentType":5125,"count":300,"type":"SCALAR"}],"nodes":[{"mesh":0,"translation":[1,0,0]}],
      "meshes":[{"name":"vase","primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":
      {"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}]})");
  const Object& box = shape_in(description);
  EXPECT_EQ(box.type, "cube");
  EXPECT_EQ(value<Transform>(box, "to_world").point(Vec3f(1, 1, 1)), Vec3f(3, 4, 6));
  EXPECT_TRUE(
      has_deviation(description, DeviationKind::missing, "mesh 'vase': there is no file 'no.bin'"));
}

TEST(GltfExtensions, StrictReadingRefusesDeviations) {
  LoadOptions strict;
  strict.is_strict = true;
  const auto problems =
      problems_of([&] { parse_gltf_text(triangle_buffer().as_json(one_mesh), strict); });
  EXPECT_EQ(problems.size(), 2u);  // camera and light
}

TEST(GltfOptions, UnknownDefinitionsAreErrors) {
  LoadOptions options;
  options.definitions = {{"gltf.glas", "solid"}};
  const auto problems = problems_of([&] { parse_gltf_text(one_triangle(), options); });
  EXPECT_NE(problems[0].message.find("gltf.glas"), std::string::npos);
  EXPECT_NE(problems[0].remedy.find("gltf.glass"), std::string::npos);
  options.definitions = {{"gltf.glass", "thick"}};
  EXPECT_NE(problems_of([&] { parse_gltf_text(one_triangle(), options); })[0].message.find("thick"),
            std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
