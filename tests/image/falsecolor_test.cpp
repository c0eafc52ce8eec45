#include "kaustik/image/color_scale.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/stroke_font.h"
#include "kaustik/image/tone_mapping.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;

std::vector<double> ramp(double from, double to, int count = 1000) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

TEST(ColorScale, linear_limits_are_round) {
  const ColorScale scale = make_scale(ramp(1, 790), {});
  EXPECT_EQ(scale.minimum, 0);
  // 98 % stay below 774; a sixth of it is 129, so steps of 200.
  EXPECT_EQ(scale.ticks, (std::vector<double>{0, 200, 400, 600, 800}));
  EXPECT_EQ(scale.maximum, 800);
  EXPECT_EQ(scale.position(200), 0.25);
  EXPECT_EQ(scale.band(199), 0u);
  EXPECT_EQ(scale.band(200), 1u);
  EXPECT_EQ(scale.band(1e9), 3u);
}

TEST(ColorScale, a_small_lamp_does_not_stretch_it) {
  std::vector<double> values = ramp(1, 95);
  for (int i = 0; i < 10; ++i) values.push_back(1e6);
  EXPECT_EQ(make_scale(values, {}).maximum, 100);
}

TEST(ColorScale, logarithmic_limits_and_ticks) {
  ScaleSettings settings;
  settings.is_logarithmic = true;
  const ColorScale scale = make_scale(ramp(3, 90), settings);
  EXPECT_EQ(scale.maximum, 100);
  EXPECT_EQ(scale.minimum, 2);  // 2 % are below 4.7
  EXPECT_EQ(scale.ticks, (std::vector<double>{2, 5, 10, 20, 50, 100}));
  EXPECT_NEAR(scale.position(std::sqrt(200.0)), 0.5, 1e-12);
  EXPECT_LT(scale.position(0), 0);
  // Ten decades: four of them.
  std::vector<double> wide;
  for (int i = 0; i < 1000; ++i) wide.push_back(std::pow(10, -5 + i / 100.0));
  const ColorScale four = make_scale(wide, settings);
  EXPECT_NEAR(four.maximum / four.minimum, 1e4, 1);
  settings.minimum = 1e-6, settings.maximum = 1e6;
  EXPECT_LE(make_scale({}, settings).ticks.size(), 14u);
}

TEST(ColorScale, given_limits_are_kept_and_labelled) {
  ScaleSettings settings;
  settings.minimum = 30;
  settings.maximum = 510;
  EXPECT_EQ(make_scale({}, settings).ticks, (std::vector<double>{30, 100, 200, 300, 400, 510}));
}

TEST(ColorScale, refuses_what_is_no_range) {
  ScaleSettings settings;
  settings.minimum = 5;
  settings.maximum = 5;
  expect_input_error([&] { make_scale({}, settings); }, "from 5 to 5");
  settings.minimum = 0;
  settings.is_logarithmic = true;
  expect_input_error([&] { make_scale({}, settings); }, "cannot start at 0");
}

TEST(ColorScale, any_values_give_a_range) {
  for (const bool is_logarithmic : {false, true})
    for (const std::vector<double>& values :
         {std::vector<double>{}, {0, 0}, {-3}, {7}, {1e-30}, {1e30}, {1e-30, 1e30}}) {
      ScaleSettings settings;
      settings.is_logarithmic = is_logarithmic;
      const ColorScale scale = make_scale(values, settings);
      EXPECT_LT(scale.minimum, scale.maximum);
      EXPECT_GE(scale.ticks.size(), 2u);
      EXPECT_LE(scale.ticks.size(), 14u);
      for (size_t i = 1; i < scale.ticks.size(); ++i) EXPECT_LT(scale.ticks[i - 1], scale.ticks[i]);
    }
}

TEST(Viridis, ends_and_middle_are_the_published_ones) {
  const auto encoded = [](float t, int c) { return srgb_from_linear(viridis(t)[c]); };
  EXPECT_NEAR(encoded(0, 0), 0.267004, 1e-5);
  EXPECT_NEAR(encoded(0, 2), 0.329415, 1e-5);
  EXPECT_NEAR(encoded(1, 0), 0.993248, 1e-5);
  EXPECT_NEAR(encoded(1, 1), 0.906157, 1e-5);
  EXPECT_NEAR(encoded(0.5f, 1), 0.565, 2e-3);  // between numbers 127 and 128
  EXPECT_EQ(viridis(-1), viridis(0));
  EXPECT_EQ(viridis(2), viridis(1));
}

TEST(Viridis, lightness_rises_evenly) {
  // CIE L* of the ends is 14.7 and 90.9: within 3 of the straight line between them.
  const auto lightness = [](float t) { return 116 * std::cbrt(photopic(viridis(t))) - 16; };
  const float low = lightness(0), high = lightness(1);
  float last = 0;
  for (float t = 0; t <= 1; t += 0.01f) {
    EXPECT_NEAR(lightness(t), low + t * (high - low), 3);
    EXPECT_GT(lightness(t), last);
    last = lightness(t);
  }
}

Image black(int width, int height) { return Image(width, height, {"R", "G", "B"}); }

double ink(const Image& image, int x0, int x1) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = x0; x < x1; ++x) sum += double(image.at(x, y, 1));
  return sum;
}

TEST(StrokeFont, every_character_of_the_legends_differs_from_every_other) {
  const std::vector<std::string> characters = {"0", "1", "2", "3", "4", "5", "6", "7", "8",
                                               "9", ".", "-", "+", "/", " ", "c", "d", "e",
                                               "k", "l", "m", "x", "W", "²", "≤", "≥", "?"};
  std::vector<Image> pictures;
  for (const std::string& character : characters) {
    Image image = black(24, 24);
    draw_text(image, character, 4, 20, 16, Vec3f(1));
    for (size_t i = 0; i < pictures.size(); ++i) {
      double difference = 0;
      for (size_t p = 0; p < image.pixel_count(); ++p)
        difference += std::fabs(double(image.channel(0)[p]) - double(pictures[i].channel(0)[p]));
      EXPECT_GT(difference, 2) << character << " looks like " << characters[i];
    }
    pictures.push_back(std::move(image));
  }
}

TEST(StrokeFont, width_is_that_of_what_is_drawn) {
  for (const std::string text : {"8", "1888", "cd/m²", "≥2500"}) {
    Image image = black(200, 40);
    draw_text(image, text, 20, 30, 20, Vec3f(1));
    const int end = 20 + int(std::ceil(text_width(text) * 20));
    EXPECT_EQ(ink(image, 0, 17), 0) << text;
    EXPECT_EQ(ink(image, end + 3, 200), 0) << text;
    EXPECT_GT(ink(image, end - 3, end + 3), 1) << text;
  }
}

TEST(StrokeFont, what_is_outside_is_left_out) {
  Image image = black(5, 5);
  draw_text(image, "cd/m² 12345 ✗", -20, 3, 30, Vec3f(1));
  draw_text(image, "88", 1e6f, -1e6f, 10, Vec3f(1));
  for (const float value : image.channel(0)) EXPECT_TRUE(value >= 0 && value <= 1);
}

Image luminance_ramp(int width, int height, float highest) {
  Image image(width, height, {"Y"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y, 0) = highest / white_efficacy * (float(x) + 0.5f) / float(width);
  return image;
}

TEST(FalseColor, shows_luminance_by_the_scale) {
  const Image image = luminance_ramp(100, 4, 1000);
  const Image shown =
      tone_map(image, *make_tone_operator("falsecolor", {"legend=false", "maximum=1000"}));
  EXPECT_EQ(shown.width(), 100);
  for (int x = 0; x < 100; ++x)
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(shown.at(x, 2, c), viridis((float(x) + 0.5f) / 100)[c], 1e-5);
}

TEST(FalseColor, legend_stands_beside_the_picture) {
  const Image image = luminance_ramp(100, 300, 1000);
  const auto tone = make_tone_operator("falsecolor");
  const Image shown = tone_map(image, *tone);
  const Image bare = tone_map(image, *make_tone_operator("falsecolor", {"legend=false"}));
  EXPECT_GT(shown.width(), 130);
  EXPECT_EQ(shown.height(), 300);
  for (int x = 0; x < 100; ++x) ASSERT_EQ(shown.at(x, 150, 1), bare.at(x, 150, 1));
  // A picture too small for the numbers gets a larger canvas.
  EXPECT_GT(tone_map(luminance_ramp(3, 2, 1), *tone).height(), 50);
}

TEST(FalseColor, irradiance_is_labelled_in_lux) {
  Image image = luminance_ramp(100, 300, 1000);
  const auto shown = [&](const std::vector<std::string>& settings) {
    const Image picture = tone_map(image, *make_tone_operator("falsecolor", settings));
    std::vector<float> values;
    for (int c = 0; c < 3; ++c)
      for (const float value : picture.channel(c)) values.push_back(value);
    return values;
  };
  const auto nits = shown({"quantity=luminance"}), lux = shown({"quantity=illuminance"});
  EXPECT_NE(nits, lux);
  EXPECT_EQ(shown({}), nits);
  image.set_metadata("quantity", std::string("irradiance"));
  EXPECT_EQ(shown({}), lux);
  EXPECT_EQ(shown({"quantity=luminance"}), nits);
  image.set_metadata("quantity", std::string("radiance"));
  EXPECT_EQ(shown({}), nits);
}

TEST(FalseColor, bands_have_as_many_colours_as_the_scale_has_steps) {
  const Image image = luminance_ramp(1000, 1, 1000);
  const Image shown = tone_map(
      image, *make_tone_operator("falsecolor", {"legend=false", "contours=bands", "maximum=1000"}));
  int changes = 0;
  for (int x = 1; x < 1000; ++x) changes += shown.at(x, 0, 1) != shown.at(x - 1, 0, 1);
  EXPECT_EQ(changes, 4);  // at 200, 400, 600 and 800
  EXPECT_EQ(shown.at(200, 0, 1), shown.at(399, 0, 1));
}

TEST(FalseColor, lines_are_where_the_steps_are) {
  const Image image = luminance_ramp(1000, 1, 1000);
  const Image shown = tone_map(
      image, *make_tone_operator("falsecolor", {"legend=false", "contours=lines", "maximum=1000"}));
  for (const int x : {199, 399}) EXPECT_EQ(shown.at(x, 0, 0), 1) << x;
  for (const int x : {599, 799}) EXPECT_EQ(shown.at(x, 0, 0), 0) << x;
  EXPECT_NE(shown.at(300, 0, 0), 1);
}

}  // namespace
}  // namespace kaustik
