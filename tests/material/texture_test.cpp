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

/// Textures in the squares.
TEST(checkerboard, holds_textures) {
  const auto fine = make_texture("checkerboard", {property("color0", 1.0), property("color1", 0.0),
                                                  property("to_uv", Transform::scale({8, 8, 1}))});
  const auto board = make_texture("checkerboard", {property("color1", 0.25)}, {{"color0", fine}});
  EXPECT_EQ(value(board, 0.03f, 0.03f), 1);
  EXPECT_EQ(value(board, 0.09f, 0.03f), 0);
  EXPECT_EQ(value(board, 0.53f, 0.03f), 0.25f);
  EXPECT_EQ(board->mean()[1], 0.375f);
  EXPECT_EQ(board->maximum(), 1);
  EXPECT_EQ(board->size(), 3 + 2);
  EXPECT_EQ(board->scalar(point(0.03f, 0.03f)), luminance_of(spectrum_from_rgb(1, 1, 1)));
  // Both are filtered: half of the footprint is the fine one's mean.
  TextureCoordinates at = point(0.5f, 0.25f);
  at.uv_width = {0.25f, 0.25f};
  EXPECT_NEAR(board->eval(at, {})[0], 0.5f * 0.5f + 0.5f * 0.25f, 1e-5f);
}

/// The relief of what is in the squares, and a step between them.
TEST(checkerboard, has_the_relief_of_its_textures) {
  const Picture slope({{0, 1}});
  const auto ramp = bitmap(slope, {property("wrap_mode", std::string("clamp"))});
  const auto board = make_texture("checkerboard", {property("color1", 0.5)}, {{"color0", ramp}});
  TextureCoordinates at = point(0.4f, 0.2f);
  at.uv_width = {0.001f, 0.001f};
  // Shares of narrow footprints are rounded to some 1e-5.
  EXPECT_NEAR(board->height_gradient(at).uv.x, ramp->height_gradient(at).uv.x, 1e-4f);
  EXPECT_EQ(board->height_gradient(point(0.7f, 0.2f)).uv, Vec2f(0, 0));
  // Down at the border: from 0.5 to 0.4 within five thousandths.
  const auto plain =
      make_texture("checkerboard", {property("color0", 0.5), property("color1", 0.4)});
  EXPECT_NEAR(plain->height_gradient(point(0.5f, 0.2f)).uv.x, -0.1f / 0.005f, 0.1f);
  EXPECT_NEAR(plain->height_gradient(point(0.5f, 0.2f)).uv.y, 0, 1e-6f);
}

TEST(gridtexture, draws_lines_about_the_borders) {
  const auto grid = make_texture("gridtexture", {property("line_width", 0.1)});
  for (const float line : {0.0f, 0.09f, 0.91f, 1.0f, -0.09f, 7.05f})
    for (const float other : {0.05f, 0.5f}) {
      EXPECT_FLOAT_EQ(value(grid, line, other), 0.4f) << line;
      EXPECT_FLOAT_EQ(value(grid, other, line), 0.4f) << line;
    }
  for (const float between : {0.11f, 0.5f, 0.89f, -0.11f, 3.2f})
    EXPECT_FLOAT_EQ(value(grid, between, 0.5f), 0.2f) << between;
  EXPECT_FLOAT_EQ(grid->mean()[0], 0.2f + 0.2f * (1 - 0.64f));
  // Filtered exactly: a tenth of the width is line.
  TextureCoordinates at = point(0.15f, 0.5f);
  at.uv_width = {0.2f, 0.1f};
  EXPECT_NEAR(grid->eval(at, {})[0], 0.2f * 0.75f + 0.4f * 0.25f, 1e-5f);
  EXPECT_FLOAT_EQ(value(make_texture("gridtexture", {property("line_width", 0.5)}), 0.3f, 0.3f),
                  0.4f);
  EXPECT_FLOAT_EQ(value(make_texture("gridtexture", {property("line_width", 0.0)}), 0, 0), 0.2f);
}

TEST(scale, multiplies_what_it_holds) {
  const Picture picture({{1, 2, 3, 4}});
  const auto texture = bitmap(picture, {property("filter_type", std::string("nearest"))});
  const auto scaled =
      make_texture("scale", {property("scale", Rgb{2, 0.5, 0})}, {{"value", texture}});
  EXPECT_EQ(scaled->eval(point(0.3f, 0.5f), {}), spectrum_from_rgb(4, 1, 0));
  EXPECT_EQ(scaled->maximum(), 8);
  EXPECT_EQ(scaled->mean(), spectrum_from_rgb(5, 1.25f, 0));
  EXPECT_FALSE(scaled->is_constant());
  EXPECT_EQ(scaled->size(), 2);
  const float luminance = luminance_of(spectrum_from_rgb(2, 0.5f, 0));
  EXPECT_FLOAT_EQ(scaled->scalar(point(0.3f, 0.5f)), 2 * luminance);
  EXPECT_FLOAT_EQ(scaled->height_gradient(point(0.5f, 0.5f)).uv.x,
                  luminance * texture->height_gradient(point(0.5f, 0.5f)).uv.x);
  const auto constant = make_texture("scale", {property("value", 0.5), property("scale", 0.5)});
  EXPECT_TRUE(constant->is_constant());
  EXPECT_FLOAT_EQ(value(constant, 0, 0), 0.25f);
  EXPECT_THROW(make_texture("scale"), Error);
}

TEST(scale, multiplies_two_textures) {
  const Picture picture({{1, 2, 3, 4}}), other({{4, 3, 2, 1}});
  const auto nearest = property("filter_type", std::string("nearest"));
  const auto a = bitmap(picture, {nearest}), b = bitmap(other, {nearest});
  const auto product = make_texture("scale", {}, {{"value", a}, {"scale", b}});
  for (const float u : {0.1f, 0.3f, 0.6f, 0.9f})
    EXPECT_EQ(product->eval(point(u, 0.5f), {}),
              a->eval(point(u, 0.5f), {}) * b->eval(point(u, 0.5f), {}));
  EXPECT_EQ(product->maximum(), 16);
  EXPECT_EQ(product->size(), 3);
  // By the product rule.
  const auto at = point(0.5f, 0.5f);
  EXPECT_FLOAT_EQ(
      product->height_gradient(at).uv.x,
      a->height_gradient(at).uv.x * b->scalar(at) + b->height_gradient(at).uv.x * a->scalar(at));
}

TEST(mesh_attribute, asks_the_surface) {
  const auto texture = make_texture(
      "mesh_attribute", {property("name", std::string("vertex_color")), property("scale", 2.0)});
  TextureCoordinates at;
  at.position = {1, 5, 6};
  EXPECT_FLOAT_EQ(texture->eval(at, {})[1], 1 + 0.8f * std::sin(1.0f));
  EXPECT_FLOAT_EQ(texture->scalar(at), 1 + 0.8f * std::sin(1.0f));
  EXPECT_EQ(texture->eval(at, {})[3], 0);
  EXPECT_FLOAT_EQ(texture->maximum(), 1.8f);
  EXPECT_FLOAT_EQ(texture->mean()[2], 1);
  EXPECT_FALSE(texture->is_constant());
  // The luminance of grey is grey.
  EXPECT_NEAR(texture->height_gradient(at).position.x, 2, 1e-5f);
  EXPECT_THROW(make_texture("mesh_attribute", {property("name", std::string("vertex_heat"))}),
               Error);
  EXPECT_THROW(make_texture("mesh_attribute", {property("name", std::string("color"))}), Error);
  EXPECT_THROW(make_texture("mesh_attribute"), Error);
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

/// Each axis by itself, black and white beyond.
TEST(bitmap, wraps_each_axis) {
  const Picture picture({{0.1f, 0.2f}, {0.3f, 0.4f}});
  const auto with = [&](const std::string& u, const std::string& v) {
    return bitmap(picture, {property("filter_type", std::string("nearest")),
                            property("wrap_mode", std::string("mirror")),
                            property("wrap_mode_u", u), property("wrap_mode_v", v)});
  };
  const auto black = with("zero", "repeat"), white = with("clamp", "one");
  EXPECT_EQ(value(black, 1.1f, 0.1f), 0);
  EXPECT_EQ(value(black, -0.1f, 0.9f), 0);
  EXPECT_EQ(value(black, 0.9f, 1.1f), 0.2f);
  EXPECT_EQ(value(black, 1e9f, 0.1f), 0);
  EXPECT_EQ(value(white, 1.1f, 0.1f), 0.2f);
  EXPECT_EQ(value(white, 0.1f, 1.1f), 1);
  EXPECT_EQ(value(white, 0.1f, -1e9f), 1);
  EXPECT_EQ(black->maximum(), 0.4f);
  EXPECT_EQ(white->maximum(), 1);
  // What is not said of one axis is what is said of both.
  const auto mirrored = bitmap(picture, {property("filter_type", std::string("nearest")),
                                         property("wrap_mode", std::string("mirror")),
                                         property("wrap_mode_u", std::string("repeat"))});
  EXPECT_EQ(value(mirrored, 1.1f, 0.1f), 0.1f);
  EXPECT_EQ(value(mirrored, 0.1f, 1.1f), 0.3f);
  // Between the edge and what is beyond.
  const auto blurred = bitmap(picture, {property("wrap_mode", std::string("zero"))});
  EXPECT_FLOAT_EQ(value(blurred, 0, 0.25f), 0.05f);
  EXPECT_FLOAT_EQ(value(blurred, 1, 0.75f), 0.2f);
}

/// An EXR with a picture, its opacity and a layer; each may be asked for alone.
TEST(bitmap, shows_the_channel_that_is_chosen) {
  const std::string path = testing::TempDir() + "kaustik_texture_test.exr";
  const auto written = [&](const std::vector<std::string>& channels) {
    Image image(2, 2, channels);
    for (int c = 0; c < image.channel_count(); ++c)
      for (float& value : image.channel(c)) value = 0.125f * float(c + 1);
    write_image(image, path);
  };
  const auto seen = [&](const std::string& channel) {
    return make_texture("bitmap", {property("filename", path), property("channel", channel)})
        ->eval(point(0.5f, 0.5f), {});
  };
  const auto grey = [](float value) { return spectrum_from_rgb(value, value, value); };
  written({"R", "G", "B", "A", "paint.R", "paint.G", "paint.B", "depth.Z"});
  EXPECT_EQ(seen(""), spectrum_from_rgb(0.125f, 0.25f, 0.375f));
  EXPECT_EQ(seen("g"), grey(0.25f));
  EXPECT_EQ(seen("B"), grey(0.375f));
  EXPECT_EQ(seen("a"), grey(0.5f));
  EXPECT_EQ(seen("paint"), spectrum_from_rgb(0.625f, 0.75f, 0.875f));
  EXPECT_EQ(seen("paint.G"), grey(0.75f));
  EXPECT_EQ(seen("depth.Z"), grey(1));
  try {
    seen("shine");
    ADD_FAILURE();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("no channel or layer 'shine'"), std::string::npos) << text;
    EXPECT_NE(text.find("paint.R"), std::string::npos) << text;
    EXPECT_EQ(text.rfind("scene.xml:9:4: ", 0), 0u) << text;
  }
  // Grey is red, green and blue.
  written({"Y", "A"});
  EXPECT_EQ(seen("r"), grey(0.125f));
  EXPECT_EQ(seen("a"), grey(0.25f));
  EXPECT_THROW(seen("x"), Error);
  // Of layers alone the first is taken.
  written({"b.R", "b.G", "b.B", "a.R", "a.G", "a.B"});
  EXPECT_EQ(seen(""), spectrum_from_rgb(0.5f, 0.625f, 0.75f));
  EXPECT_EQ(seen("b"), spectrum_from_rgb(0.125f, 0.25f, 0.375f));
  std::remove(path.c_str());
}

/// Opacity of a file whose colours are sRGB encoded is linear.
TEST(bitmap, opacity_is_linear) {
  const std::string path = testing::TempDir() + "kaustik_texture_test.tga";
  // 1 × 1, 32 bits: blue 10, green 20, red 188, opacity 64.
  std::ofstream(path, std::ios::binary)
      << std::string{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 32, 8} << char(10) << char(20)
      << char(188) << char(64);
  for (const double gamma : {0.0, 2.2})
    EXPECT_FLOAT_EQ(
        make_texture("bitmap", {property("filename", path), property("channel", std::string("a")),
                                property("gamma", gamma)})
            ->scalar(point(0.5f, 0.5f)),
        64.0f / 255);
  EXPECT_NEAR(
      make_texture("bitmap", {property("filename", path), property("channel", std::string("r"))})
          ->scalar(point(0.5f, 0.5f)),
      std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
  std::remove(path.c_str());
}

TEST(bitmap, has_the_gamma_that_is_given) {
  const std::string path = testing::TempDir() + "kaustik_texture_test.ppm";
  std::ofstream(path, std::ios::binary) << "P6\n1 1\n255\n" << std::string(3, char(188));
  const auto seen = [&](std::vector<Property> more) {
    more.push_back(property("filename", path));
    return value(make_texture("bitmap", std::move(more)), 0.5f, 0.5f);
  };
  const double stored = 188 / 255.0, srgb = std::pow((stored + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(seen({property("gamma", 1.0)}), stored, 1e-6);
  EXPECT_NEAR(seen({property("gamma", 2.2)}), std::pow(stored, 2.2), 1e-6);
  EXPECT_NEAR(seen({property("gamma", -1.0)}), srgb, 1e-5);
  EXPECT_NEAR(seen({property("gamma", 0.0)}), srgb, 1e-5);
  EXPECT_THROW(seen({property("gamma", -0.5)}), Error);
  EXPECT_THROW(seen({property("gamma", 2.2), property("raw", true)}), Error);
  EXPECT_NEAR(seen({property("gamma", 1.0), property("raw", true)}), stored, 1e-6);
  // Floats are linear unless something else is said.
  const Picture picture({{0.5f, 0.5f}});
  EXPECT_FLOAT_EQ(value(bitmap(picture), 0.5f, 0.5f), 0.5f);
  EXPECT_FLOAT_EQ(value(bitmap(picture, {property("gamma", 2.0)}), 0.5f, 0.5f), 0.25f);
  std::remove(path.c_str());
}

TEST(bitmap, survives_any_coordinate) {
  const Picture picture({{1, 2}, {3, 4}});
  for (const std::string mode : {"repeat", "mirror", "clamp", "zero", "one"})
    for (const std::string filter : {"nearest", "bilinear"}) {
      const auto texture =
          bitmap(picture, {property("filter_type", filter), property("wrap_mode", mode)});
      for (const float u : {-1e30f, 1e30f, 1e9f, -1e-20f, 0.0f, 1.0f, 2.0f, -1.0f}) {
        EXPECT_GE(value(texture, u, 0.3f), mode == "zero" ? 0 : 1) << u;
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

/// With the values that a scene need not give.
TEST(texture_types, keep_within_their_bounds) {
  const Picture picture({{0.25f, 1}, {0.5f, 0}});
  for (const TextureType& type : texture_types()) {
    SCOPED_TRACE(type.info.name);
    const auto texture = make_usual_texture(type, picture.path());
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
