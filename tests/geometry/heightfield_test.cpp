// Height fields: heights and normals in closed form, and what is no height field.

#include <functional>

#include "geometry_support.h"

namespace kaustik::test {
namespace {

std::shared_ptr<const Shape> field_of(size_t columns, size_t rows,
                                      const std::function<double(double x, double y)>& height,
                                      std::vector<Property> more = {}) {
  std::vector<double> heights;
  for (size_t y = 0; y < rows; ++y)
    for (size_t x = 0; x < columns; ++x)
      heights.push_back(height(2.0 * double(x) / double(columns - 1) - 1,
                               2.0 * double(y) / double(rows - 1) - 1));
  more.push_back({"heights", Value(Array::of<double>({rows, columns}, std::move(heights))), {}});
  return make_shape("heightfield", std::move(more));
}

TEST(HeightField, HasAVertexForEachHeight) {
  const float values[2][3] = {{1, 2, 3}, {-4, 5, 0.5f}};
  const auto shape = field_of(
      3, 2, [&](double x, double y) { return double(values[y > 0][int(std::lround(x)) + 1]); },
      {{"scale", 2.0, {}}});
  const TriangleMesh& mesh = *shape->mesh();
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      const auto i = size_t(y * 3 + x);
      EXPECT_EQ(mesh.positions[i], Vec3f(float(x - 1), float(2 * y - 1), 2 * values[y][x]));
      EXPECT_EQ(mesh.uvs[i], Vec2f(0.5f * float(x), float(y)));
    }
}

/// The surface is the plane itself, with its normal, wherever it is placed.
TEST(HeightField, OfAPlaneIsExact) {
  const Vec3d slope(0.3, -0.7, 0);
  for (const Transform& place : {Transform(), placement(2) * Transform::scale({1.0, 0.5, -3.0})}) {
    const auto shape =
        field_of(7, 4, [&](double x, double y) { return slope.x * x + slope.y * y + 0.2; },
                 {{"to_world", place, {}}});
    const auto tracer = tracer_of({shape});
    const Vec3f normal = normalize(place.normal(Vec3f(-0.3f, 0.7f, 1)));
    Random random(71);
    for (int i = 0; i < 2000; ++i) {
      const float x = random.uniform(-0.99f, 0.99f), y = random.uniform(-0.99f, 0.99f);
      const Vec3f target = place.point({x, y, 0.3f * x - 0.7f * y + 0.2f});
      const Vec3f origin = target + normal * 3.0f + random.in_box(1);
      Hit hit;
      const Ray ray{origin, target - origin, infinity};
      ASSERT_TRUE(tracer->intersect(ray, hit));
      const SurfacePoint p = tracer->surface_point(ray, hit);
      EXPECT_LT(length(p.position - target), 1e-5f);
      EXPECT_LT(length(p.ng - normal), 1e-5f);
      EXPECT_LT(length(p.ns - normal), 1e-5f);
      EXPECT_NEAR(p.uv.x, 0.5f * (x + 1), 1e-5f);
      EXPECT_NEAR(p.uv.y, 0.5f * (y + 1), 1e-5f);
    }
  }
}

TEST(HeightField, OfWavesHasTheirNormals) {
  const auto height = [](double x, double y) { return 0.2 * std::cos(3 * x) * std::cos(2 * y); };
  const auto normal_at = [](double x, double y) {
    return Vec3d(0.6 * std::sin(3 * x) * std::cos(2 * y), 0.4 * std::cos(3 * x) * std::sin(2 * y),
                 1)
        .normalized();
  };
  for (const bool is_smooth : {true, false})
    for (const bool is_flipped : {true, false}) {
      const auto shape = field_of(
          129, 65, height, {{"shading_normals", is_smooth, {}}, {"flip_normals", is_flipped, {}}});
      const auto tracer = tracer_of({shape});
      Random random(72);
      double bend = 0;
      for (int i = 0; i < 2000; ++i) {
        const float x = random.uniform(-0.95f, 0.95f), y = random.uniform(-0.95f, 0.95f);
        const Ray ray{{x, y, 2}, {0, 0, -1}, infinity};
        Hit hit;
        ASSERT_TRUE(tracer->intersect(ray, hit));
        const SurfacePoint p = tracer->surface_point(ray, hit);
        const Vec3d normal = normal_at(double(x), double(y)) * (is_flipped ? -1.0 : 1.0);
        EXPECT_NEAR(p.position.z, height(double(x), double(y)), 1e-3);
        EXPECT_LT((Vec3d(p.ng) - normal).length(), 0.06);
        bend += (Vec3d(p.ns) - normal).length();
        if (!is_smooth) {
          EXPECT_EQ(p.ns, p.ng);
        }
      }
      // Blended normals are much nearer than those of the faces.
      if (is_smooth)
        EXPECT_LT(bend / 2000, 0.002);
      else
        EXPECT_GT(bend / 2000, 0.005);
    }
}

TEST(HeightField, TakesLuminancesOfPictures) {
  // Radiances, whose rows run upward in the file; the last row is the upper one.
  std::string bytes = "PF\n2 2\n-1.0\n";
  const float pixels[2][2][3] = {{{3, 3, 3}, {4, 4, 4}}, {{1, 0, 0}, {-2, -2, -2}}};
  bytes.append(reinterpret_cast<const char*>(pixels), sizeof(pixels));
  const TemporaryFile floats(bytes, "heights.pfm");
  const auto heights = [](const TemporaryFile& file) {
    const auto shape = make_shape("heightfield", {{"filename", file.path(), {}}});
    std::vector<float> z;
    for (const Vec3f& p : shape->mesh()->positions) z.push_back(p.z);
    return z;
  };
  const std::vector<float> found = heights(floats);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_NEAR(found[0], 0.212639f, 1e-6f);
  EXPECT_NEAR(found[1], -2, 1e-5f);
  EXPECT_NEAR(found[2], 3, 1e-5f);
  EXPECT_NEAR(found[3], 4, 1e-5f);
  // Bytes are sRGB encoded.
  const TemporaryFile grey("P5\n2 2\n255\n" + std::string("\x00\xff\xbc\xbc", 4), "heights.pgm");
  const std::vector<float> decoded = heights(grey);
  ASSERT_EQ(decoded.size(), 4u);
  EXPECT_EQ(decoded[0], 0);
  EXPECT_NEAR(decoded[1], 1, 1e-6f);
  EXPECT_NEAR(decoded[2], std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
}

TEST(HeightField, MayShine) {
  const auto shape = field_of(5, 9, [](double x, double) { return 0.75 * x; });
  EXPECT_TRUE(shape->can_sample());
  EXPECT_NEAR(shape->area(), 4 * 1.25, 1e-5);
}

TEST(HeightField, TellsWhatIsWrong) {
  const auto message = [](std::vector<Property> properties) -> std::string {
    try {
      make_shape("heightfield", std::move(properties));
    } catch (const Error& error) {
      EXPECT_FALSE(error.problems()[0].remedy.empty()) << error.what();
      return error.what();
    }
    return {};
  };
  const auto buffer = [](std::vector<size_t> extents, std::vector<float> values) {
    return std::vector<Property>{
        {"heights", Value(Array::of<float>(std::move(extents), std::move(values))), {}}};
  };
  EXPECT_NE(message({}).find("filename"), std::string::npos);
  EXPECT_NE(message(buffer({1, 4}, {1, 2, 3, 4})).find("4 x 1"), std::string::npos);
  EXPECT_NE(message(buffer({4, 1}, {1, 2, 3, 4})).find("1 x 4"), std::string::npos);
  EXPECT_NE(message(buffer({4}, {1, 2, 3, 4})), "");
  EXPECT_NE(message(buffer({2, 2}, {1, 2, std::nanf(""), 4})).find("row 1 and column 0"),
            std::string::npos);
  EXPECT_NE(message(buffer({2, 2}, {1, 2, 3, 3e38f})), "");
  EXPECT_NE(message({{"filename", std::string("/nowhere/hills.png"), {}}}).find("hills.png"),
            std::string::npos);
  // Far more is promised than there is.
  const TemporaryFile liar("P5\n20000 20000\n255\n" + std::string(1000, 'x'), "liar.pgm");
  EXPECT_NE(message({{"filename", liar.path(), {}}}), "");
}

}  // namespace
}  // namespace kaustik::test
