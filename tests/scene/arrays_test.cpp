// Buffers in descriptions: scenes made of them are those that files make, and so are their errors.

#include <random>

#include "kaustik/base/file.h"
#include "kaustik/image/image_io.h"
#include "kaustik/image/photometry.h"
#include "kaustik/scene/description_digest.h"
#include "kaustik/scene/mesh_memory.h"
#include "kaustik/scene/type_tables.h"
#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::test {
namespace {

std::shared_ptr<Object> object(std::string family, std::string type,
                               std::vector<Property> properties = {},
                               std::vector<Child> children = {}) {
  for (Property& property : properties) property.place = place_in(property.name);
  return std::make_shared<Object>(Object{std::move(family), std::move(type), "",
                                         std::move(properties), std::move(children),
                                         place_in("program")});
}

Description described(std::vector<std::shared_ptr<Object>> objects) {
  std::vector<Child> children = {{"", object("sensor", "perspective")}};
  for (auto& part : objects) children.push_back({"", std::move(part)});
  return {object("scene", "", {}, std::move(children))};
}

std::vector<uint8_t> some_bytes(size_t count) {
  std::mt19937 random(5);
  std::vector<uint8_t> bytes(count);
  for (uint8_t& byte : bytes) byte = uint8_t(random());
  return bytes;
}

/// What a ball with this picture reflects here and there.
std::vector<Spectrum> albedos(const std::shared_ptr<Object>& texture) {
  const auto scene = build_scene(described({object(
      "shape", "sphere", {}, {{"", object("bsdf", "diffuse", {}, {{"reflectance", texture}})}})}));
  std::vector<Spectrum> values;
  for (float u = -0.3f; u < 1.4f; u += 0.07f)
    for (const float width : {0.0f, 0.3f}) {
      BsdfContext context;
      TextureCoordinates at;
      at.uv = {u, u * u};
      at.uv_width = {width, width};
      context.move_to(at, {});
      values.push_back(scene->surface(0).bsdf->albedo(context, {0, 0, 1}, Lobes::all));
    }
  return values;
}

TEST(Arrays, ABitmapIsThatOfTheSameFile) {
  const TemporaryFolder folder;
  constexpr int width = 17, height = 9;
  const std::vector<uint8_t> bytes = some_bytes(width * height * 3);
  Image image(width, height, {"R", "G", "B"});
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (int c = 0; c < 3; ++c)
      image.channel(c)[i] = linear_from_srgb(bytes[3 * i + size_t(c)] / 255.0f);
  const std::string png = folder.path("a.png");
  write_shown_image(image, png);
  const Value array(Array::of<uint8_t>({height, width, 3}, bytes));
  for (const bool raw : {false, true})
    for (const char* filter : {"bilinear", "nearest"}) {
      const auto with = [&](const std::string& name, const Value& value) {
        return albedos(object("texture", "bitmap",
                              {{name, value, {}},
                               {"raw", Value(raw), {}},
                               {"wrap_mode", Value(std::string("mirror")), {}},
                               {"filter_type", Value(std::string(filter)), {}}}));
      };
      const auto of_file = with("filename", Value(png)), of_array = with("data", array);
      ASSERT_EQ(of_file.size(), of_array.size());
      for (size_t i = 0; i < of_file.size(); ++i)
        for (int lane = 0; lane < 4; ++lane) EXPECT_EQ(of_file[i][lane], of_array[i][lane]);
    }
}

TEST(Arrays, ABitmapMayBeTheBytesOfAFile) {
  const TemporaryFolder folder;
  Image image(5, 3, {"R", "G", "B"});
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (int c = 0; c < 3; ++c) image.channel(c)[i] = float(i + size_t(c)) / 20;
  const std::string png = folder.path("a.png");
  write_shown_image(image, png);
  const std::vector<uint8_t> bytes = read_file(png);
  const auto seen = [&](const std::string& name, const Value& value, const std::string& channel) {
    return albedos(
        object("texture", "bitmap", {{name, value, {}}, {"channel", Value(channel), {}}}));
  };
  const Value encoded(Array::of<uint8_t>({bytes.size()}, bytes));
  for (const char* channel : {"", "g"}) {
    const auto of_file = seen("filename", Value(png), channel);
    const auto of_bytes = seen("data", encoded, channel);
    for (size_t i = 0; i < of_file.size(); ++i) EXPECT_EQ(of_file[i], of_bytes[i]);
  }
  // A picture without opacity is opaque.
  for (const Spectrum& value : seen("data", encoded, "a")) EXPECT_EQ(value[0], 1);
  std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + 40);
  const size_t size = cut.size();
  EXPECT_THROW(seen("data", Value(Array::of<uint8_t>({size}, std::move(cut))), ""), Error);
}

TEST(Arrays, AnEnvironmentIsThatOfTheSameFile) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (const uint8_t byte : some_bytes(8 * 5 * 3)) values.push_back(float(byte) / 7);
  Image image(8, 5, {"R", "G", "B"});
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (int c = 0; c < 3; ++c) image.channel(c)[i] = values[3 * i + size_t(c)];
  write_image(image, folder.path("sky.pfm"));
  const auto of_file = build_scene(
      described({object("emitter", "envmap", {{"filename", Value(folder.path("sky.pfm")), {}}})}));
  const auto of_array = build_scene(described(
      {object("emitter", "envmap", {{"data", Value(Array::of<float>({5, 8, 3}, values)), {}}})}));
  const Light &a = *of_file->lights()[0], &b = *of_array->lights()[0];
  EXPECT_EQ(a.traits().power[1], b.traits().power[1]);
  for (float x = -1; x < 1; x += 0.13f)
    for (float y = -1; y < 1; y += 0.17f) {
      const Vec3f direction = normalize({x, y, 0.3f});
      EXPECT_EQ(a.distant().background(direction, {})[0], b.distant().background(direction, {})[0]);
      EXPECT_EQ(a.pdf_toward({}, direction), b.pdf_toward({}, direction));
    }
}

std::shared_ptr<Object> mesh(std::vector<float> positions) {
  return object("shape", "mesh",
                {{"positions", Value(Array::of<float>({3, 3}, std::move(positions))), {}},
                 {"faces", Value(Array::of<uint8_t>({1, 3}, {0, 1, 2})), {}}});
}

TEST(Arrays, CountInTheDigestByTheirContents) {
  const auto digest = [](std::vector<float> positions) {
    return description_digest(described({mesh(std::move(positions))}), scene_types());
  };
  const DescriptionDigest first = digest({0, 0, 0, 1, 0, 0, 0, 1, 0});
  EXPECT_EQ(digest({0, 0, 0, 1, 0, 0, 0, 1, 0}), first);  // another buffer
  EXPECT_NE(digest({0, 0, 0, 1, 0, 0, 0, 1, 1e-30f}).scene, first.scene);
}

TEST(Arrays, CountAsMemoryOfMeshes) {
  const auto shape = mesh({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const uint64_t bytes = expected_mesh_memory(described({shape}));
  EXPECT_GE(bytes, 36u + 3u);
  EXPECT_EQ(expected_mesh_memory(described({shape, shape})), bytes);
}

std::vector<Problem> problems_of(const Description& description) {
  try {
    build_scene(description);
  } catch (const Error& error) {
    return error.problems();
  }
  return {};
}

TEST(Arrays, MistakesAreToldAtTheirBuffer) {
  const auto expect = [](const std::shared_ptr<Object>& part, const std::string& place,
                         const std::string& message) {
    const auto problems = problems_of(described({part}));
    ASSERT_EQ(problems.size(), 1u) << message;
    EXPECT_EQ(*problems[0].place.file, place);
    EXPECT_NE(problems[0].message.find(message), std::string::npos) << problems[0].message;
    EXPECT_FALSE(problems[0].remedy.empty());
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect(mesh({0, 0, 0, 1, 0, 0, nan, 1, 0}), "positions", "vertex 2 is not finite");
  expect(mesh({0, 0, 0, 1, 0, 0, 2e18f, 1, 0}), "positions", "vertex 2 is too far away");
  const Value dot(Array::of<float>({1, 1, 2}, {1, 1})), dark(Array::of<float>({1, 1}, {0}));
  expect(object("texture", "bitmap", {{"data", dot, {}}}), "data", "extents [1, 1, 2]");
  expect(object("texture", "bitmap"), "program", "needs 'filename'");
  expect(object("texture", "bitmap",
                {{"data", dark, {}}, {"filename", Value(std::string("/dev/null")), {}}}),
         "data", "both 'data' and 'filename'");
  expect(object("emitter", "envmap", {{"data", dark, {}}}), "data", "'data' is black");
}

TEST(Arrays, ValuesThatNoLightHasAreRepairedAndTold) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto scene = build_scene(described({object(
      "emitter", "envmap", {{"data", Value(Array::of<float>({1, 3}, {1, nan, -2})), {}}})}));
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_NE(scene->warnings()[0].find("picture 'data': 2 of its 3 pixels"), std::string::npos)
      << scene->warnings()[0];
}

}  // namespace
}  // namespace kaustik::test
