#include "kaustik/material/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "kaustik/image/image_io.h"
#include "tests/material/bsdf_support.h"
#include "tests/support/type_rows.h"

namespace kaustik {
namespace {

using namespace test;

TextureCoordinates point(float u, float v) {
  TextureCoordinates at;
  at.uv = {u, v};
  return at;
}

/// A PFM picture of grey values, given from the upper row down, that is removed with the object.
class Picture {
 public:
  explicit Picture(const std::vector<std::vector<float>>& rows)
      : path_(testing::TempDir() + "kaustik_texture_test.pfm") {
    std::ofstream file(path_, std::ios::binary);
    file << "PF\n" << rows[0].size() << " " << rows.size() << "\n-1.0\n";
    for (auto row = rows.rbegin(); row != rows.rend(); ++row)
      for (const float value : *row)
        for (int channel = 0; channel < 3; ++channel)
          file.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
  ~Picture() { std::remove(path_.c_str()); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::shared_ptr<const Texture> bitmap(const Picture& picture, std::vector<Property> more = {}) {
  more.push_back(property("filename", picture.path()));
  return make_texture("bitmap", std::move(more));
}

float value(const std::shared_ptr<const Texture>& texture, float u, float v) {
  const Spectrum s = texture->eval(point(u, v), {});
  EXPECT_EQ(s[0], s[2]);
  EXPECT_EQ(s[3], 0);
  return s[0];
}

TEST(constant_texture, is_the_same_everywhere) {
  const auto texture = make_constant_texture(SpectralValue::reflectance(Rgb{0.1, 0.2, 0.3}));
  EXPECT_TRUE(texture->is_constant());
  EXPECT_EQ(texture->eval(point(3, -7), {}), Spectrum(0.1f, 0.2f, 0.3f, 0));
  EXPECT_EQ(texture->mean(), Spectrum(0.1f, 0.2f, 0.3f, 0));
  EXPECT_FLOAT_EQ(texture->maximum(), 0.3f);
}

TEST(checkerboard, has_color0_at_the_origin) {
  const auto texture = make_texture("checkerboard", {property("color0", 0.9)});
  EXPECT_FALSE(texture->is_constant());
  EXPECT_FLOAT_EQ(value(texture, 0.25f, 0.25f), 0.9f);
  EXPECT_FLOAT_EQ(value(texture, 0.75f, 0.25f), 0.2f);
  EXPECT_FLOAT_EQ(value(texture, 0.75f, 0.75f), 0.9f);
  EXPECT_FLOAT_EQ(value(texture, -0.25f, 0.25f), 0.2f);
  EXPECT_FLOAT_EQ(texture->mean()[1], 0.55f);
  EXPECT_FLOAT_EQ(texture->maximum(), 0.9f);
}

TEST(checkerboard, is_transformed) {
  const auto texture = make_texture(
      "checkerboard", {property("color0", 0.9), property("to_uv", Transform::scale({4, 2, 1}))});
  EXPECT_FLOAT_EQ(value(texture, 0.05f, 0.1f), 0.9f);
  EXPECT_FLOAT_EQ(value(texture, 0.15f, 0.1f), 0.2f);
  EXPECT_FLOAT_EQ(value(texture, 0.05f, 0.3f), 0.2f);
}

TEST(bitmap, nearest_texels_from_the_upper_left) {
  const Picture picture({{1, 2, 3}, {4, 5, 6}});
  const auto texture = bitmap(picture, {property("filter_type", std::string("nearest"))});
  EXPECT_EQ(value(texture, 0.1f, 0.1f), 1);
  EXPECT_EQ(value(texture, 0.5f, 0.1f), 2);
  EXPECT_EQ(value(texture, 0.9f, 0.4f), 3);
  EXPECT_EQ(value(texture, 0.1f, 0.9f), 4);
  EXPECT_EQ(value(texture, 0.99f, 0.99f), 6);
  EXPECT_EQ(texture->maximum(), 6);
  EXPECT_FLOAT_EQ(texture->mean()[0], 3.5f);
}

TEST(bitmap, bilinear_between_the_centres) {
  const Picture picture({{0, 1}, {2, 3}});
  const auto texture = bitmap(picture);
  EXPECT_FLOAT_EQ(value(texture, 0.25f, 0.25f), 0);
  EXPECT_FLOAT_EQ(value(texture, 0.75f, 0.25f), 1);
  EXPECT_FLOAT_EQ(value(texture, 0.5f, 0.5f), 1.5f);
  EXPECT_FLOAT_EQ(value(texture, 0.375f, 0.25f), 0.25f);
  EXPECT_FLOAT_EQ(value(texture, 0.25f, 0.375f), 0.5f);
  // At the border half of the opposite side comes in.
  EXPECT_FLOAT_EQ(value(texture, 0, 0.25f), 0.5f);
}

TEST(bitmap, wraps) {
  const Picture picture({{1, 2, 3, 4}});
  const auto with = [&](const std::string& mode) {
    return bitmap(picture,
                  {property("filter_type", std::string("nearest")), property("wrap_mode", mode)});
  };
  const auto repeat = with("repeat"), mirror = with("mirror"), clamp = with("clamp");
  const float u[] = {-1.1f, -0.9f, -0.1f, 0.1f, 0.9f, 1.1f, 1.9f, 2.1f, 1001.1f};
  const float repeated[] = {4, 1, 4, 1, 4, 1, 4, 1, 1};
  const float mirrored[] = {4, 4, 1, 1, 4, 4, 1, 1, 4};
  const float clamped[] = {1, 1, 1, 1, 4, 4, 4, 4, 4};
  for (size_t i = 0; i < std::size(u); ++i) {
    EXPECT_EQ(value(repeat, u[i], 0.5f), repeated[i]) << u[i];
    EXPECT_EQ(value(mirror, u[i], 0.5f), mirrored[i]) << u[i];
    EXPECT_EQ(value(clamp, u[i], 0.5f), clamped[i]) << u[i];
  }
}

/// Grey with alpha is grey; alpha alone is no colour.
TEST(bitmap, channels_of_the_file) {
  const std::string path = testing::TempDir() + "kaustik_texture_test.exr";
  const auto written = [&](const std::vector<std::string>& channels) {
    Image image(2, 2, channels);
    for (int c = 0; c < image.channel_count(); ++c)
      for (float& value : image.channel(c)) value = c == 0 ? 0.25f : 0.75f;
    write_image(image, path);
    return make_texture("bitmap", {property("filename", path)});
  };
  for (const std::vector<std::string>& channels :
       {std::vector<std::string>{"Y", "A"}, {"Y"}, {"mask"}}) {
    const Spectrum value = written(channels)->eval(point(0.5f, 0.5f), {});
    for (int lane = 0; lane < 3; ++lane) EXPECT_EQ(value[lane], 0.25f) << channels[0];
  }
  for (const std::vector<std::string>& channels :
       {std::vector<std::string>{"A"}, {"left", "right"}}) {
    try {
      written(channels);
      ADD_FAILURE() << channels[0];
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("the channels are: " + channels[0]),
                std::string::npos)
          << error.what();
    }
  }
  std::remove(path.c_str());
}

TEST(bitmap, survives_any_coordinate) {
  const Picture picture({{1, 2}, {3, 4}});
  for (const std::string mode : {"repeat", "mirror", "clamp"})
    for (const std::string filter : {"nearest", "bilinear"}) {
      const auto texture =
          bitmap(picture, {property("filter_type", filter), property("wrap_mode", mode)});
      for (const float u : {-1e30f, 1e30f, 1e9f, -1e-20f, 0.0f, 1.0f, 2.0f, -1.0f}) {
        EXPECT_GE(value(texture, u, 0.3f), 1) << u;
        EXPECT_LE(value(texture, 0.3f, u), 4) << u;
      }
    }
}

TEST(bitmap, is_transformed) {
  const Picture picture({{1, 2, 3, 4}});
  const auto texture = bitmap(picture, {property("filter_type", std::string("nearest")),
                                        property("to_uv", Transform::translate({0.25, 0, 0}))});
  EXPECT_EQ(value(texture, 0.1f, 0.5f), 2);
}

TEST(bitmap, of_eight_bits_is_srgb_unless_raw) {
  const std::string path = testing::TempDir() + "kaustik_texture_test.ppm";
  std::ofstream(path, std::ios::binary) << "P6\n1 1\n255\n" << std::string(3, char(188));
  const auto srgb = make_texture("bitmap", {property("filename", path)});
  const auto raw = make_texture("bitmap", {property("filename", path), property("raw", true)});
  EXPECT_NEAR(value(srgb, 0.5f, 0.5f), std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
  EXPECT_NEAR(value(raw, 0.5f, 0.5f), 188 / 255.0, 1e-6);
  std::remove(path.c_str());
}

TEST(bitmap, that_is_missing_is_told_with_its_place) {
  try {
    make_texture("bitmap", {property("filename", std::string("/nowhere/at_all.png"))});
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(error.what()).rfind("scene.xml:9:4: ", 0), 0u) << error.what();
    EXPECT_NE(std::string(error.what()).find("/nowhere/at_all.png"), std::string::npos);
  }
}

TEST(bitmap, repairs_negative_and_broken_values) {
  for (const float bad :
       {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const auto texture = bitmap(Picture({{1, 2}, {3, bad}}));
    EXPECT_EQ(texture->maximum(), 3);
    EXPECT_FLOAT_EQ(texture->mean()[0], (6 + (bad > 0 ? 3.0f : 0.0f)) / 4);
  }
}

TEST(texture_types, are_rows) { expect_rows_of("texture", texture_types()); }

/// With the values that a scene need not give; a bitmap needs a picture.
TEST(texture_types, keep_within_their_bounds) {
  const Picture picture({{0.25f, 1}, {0.5f, 0}});
  for (const TextureType& type : texture_types()) {
    SCOPED_TRACE(type.info.name);
    const Parameter* file = type.info.find("filename");
    const auto texture = file ? make_texture(type.info.name, {property("filename", picture.path())})
                              : make_texture(type.info.name);
    EXPECT_LE(texture->mean().max_lane(), texture->maximum());
    for (const float far : {0.0f, 1.0f, 1e4f, 1e30f})
      for (int i = 0; i < 200; ++i) {
        TextureCoordinates at = point(far * std::sin(float(i)), far * std::cos(0.7f * float(i)));
        at.position = Vec3f(at.uv.x, at.uv.y, far * std::sin(2.3f * float(i)));
        at.normal = {0, 0, 1};
        at.width = i % 3 == 0 ? 0.1f : 0.0f;
        at.uv_width = Vec2f(at.width, at.width);
        const Spectrum value = texture->eval(at, {});
        ASSERT_TRUE(value.is_finite());
        ASSERT_LE(value.max_lane(), texture->maximum() * (1 + 1e-5f));
        for (int lane = 0; lane < Spectrum::lane_count; ++lane) ASSERT_GE(value[lane], 0);
        ASSERT_TRUE(std::isfinite(texture->scalar(at)));
      }
  }
}

}  // namespace
}  // namespace kaustik
