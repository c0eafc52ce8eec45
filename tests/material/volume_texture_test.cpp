// Textures that show a volume: what it is at the points of a surface.

#include <gtest/gtest.h>

#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

std::shared_ptr<const Volume> grid_of(std::vector<float> values, int channels = 1) {
  VolumeSamples samples;
  samples.channels = channels;
  samples.size = {int(values.size()) / channels, 1, 1};
  samples.values = std::move(values);
  return std::make_shared<Volume>(GridVolume(
      samples, GridVolume::Filter::trilinear, GridVolume::Wrap::clamp,
      Transform::translate({10, 0, 0}) * Transform::scale({samples.size[0] * 1.0, 3, 5})));
}

std::shared_ptr<const Texture> shown(const std::shared_ptr<const Volume>& volume) {
  return make_texture("volume", {}, {}, {{"volume", volume}});
}

TextureCoordinates place(const Vec3f& position) {
  TextureCoordinates at;
  at.position = position;
  return at;
}

TEST(volume_texture, is_linear_between_the_middles_of_cells) {
  const auto texture = shown(grid_of({0.2f, 0.6f}));
  for (const auto& [x, value] : {std::pair(9.0f, 0.2f),
                                 {10.5f, 0.2f},
                                 {11.0f, 0.4f},
                                 {11.25f, 0.5f},
                                 {11.5f, 0.6f},
                                 {13.0f, 0.6f}}) {
    const Spectrum found = texture->eval(place({x, 0.7f, 2}), {});
    for (int lane = 0; lane < 3; ++lane) EXPECT_NEAR(found[lane], value, 1e-6f) << x;
    EXPECT_EQ(found[3], 0);
    EXPECT_NEAR(texture->scalar(place({x, 0.7f, 2})), value, 1e-6f) << x;
  }
  EXPECT_FLOAT_EQ(texture->maximum(), 0.6f);
  EXPECT_FLOAT_EQ(texture->mean()[1], 0.4f);
  EXPECT_FALSE(texture->is_constant());
  // uv and footprints mean nothing to it.
  TextureCoordinates wide = place({11, 0, 0});
  wide.width = 2;
  wide.uv = {0.3f, 0.8f};
  EXPECT_NEAR(texture->eval(wide, {})[1], 0.4f, 1e-6f);
}

TEST(volume_texture, has_colours) {
  const auto texture = shown(grid_of({0.1f, 0.2f, 0.3f, 0.5f, 0.6f, 0.9f}, 3));
  const Spectrum found = texture->eval(place({11, 0, 0}), {});
  EXPECT_NEAR(found[0], 0.3f, 1e-6f);
  EXPECT_NEAR(found[1], 0.4f, 1e-6f);
  EXPECT_NEAR(found[2], 0.6f, 1e-6f);
  EXPECT_NEAR(texture->scalar(place({11, 0, 0})), luminance_of(found), 1e-6f);
  EXPECT_FLOAT_EQ(texture->maximum(), 0.9f);
  EXPECT_FLOAT_EQ(texture->mean()[2], 0.6f);
  // As any colour that reflects.
  const Wavelengths four(440, 500, 580, 660);
  const Spectrum lanes = lanes_from_reflectance(found, four);
  for (int lane = 0; lane < 4; ++lane)
    EXPECT_FLOAT_EQ(texture->eval(place({11, 0, 0}), four)[lane], lanes[lane]);
}

/// Cells are 1 m long: the height rises by 0.4 from the middle of one to that of the other.
TEST(volume_texture, is_a_relief) {
  const auto texture = shown(grid_of({0.2f, 0.6f}));
  const HeightGradient found = texture->height_gradient(place({11, 0.7f, 2}));
  EXPECT_NEAR(found.position.x, 0.4f, 1e-5f);
  EXPECT_EQ(found.position.y, 0);
  EXPECT_EQ(found.position.z, 0);
  EXPECT_EQ(found.uv, Vec2f(0, 0));
  EXPECT_TRUE(is_finite(texture->height_gradient(place({1e30f, -1e30f, 0})).position));
}

TEST(volume_texture, may_be_one_value) {
  const Spectrum pink = spectrum_from_rgb(0.9f, 0.4f, 0.5f);
  for (const auto& texture : {shown(std::make_shared<Volume>(Volume::Color(Rgb{0.9, 0.4, 0.5}))),
                              make_texture("volume", {property("volume", Rgb{0.9, 0.4, 0.5})})}) {
    EXPECT_TRUE(texture->is_constant());
    EXPECT_EQ(texture->eval(place({3, 4, 5}), {}), pink);
  }
  EXPECT_FLOAT_EQ(make_texture("volume")->mean()[0], 0.75f);
}

TEST(volume_texture, tells_what_it_cannot_show) {
  const auto message = [](const std::shared_ptr<const Volume>& volume,
                          std::vector<Property> more = {}) -> std::string {
    try {
      make_texture("volume", std::move(more), {}, {{"volume", volume}});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_TRUE(error.problems()[0].place.file);
      EXPECT_FALSE(error.problems()[0].remedy.empty());
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message(grid_of({1, 2, 3, 4, 5, 6}, 6)).find("six channels"), std::string::npos);
  EXPECT_NE(message(grid_of({1, -0.1f})).find("negative"), std::string::npos);
  EXPECT_NE(message(grid_of({1, 1}), {property("volume", 0.5)}).find("both"), std::string::npos);
}

}  // namespace
}  // namespace kaustik
