#include "kaustik/image/tone_mapping.h"

#include <algorithm>
#include <limits>

#include "kaustik/image/photometry.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Image grey_image(int width, int height, const std::function<float(int, int)>& value) {
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = value(x, y);
  return image;
}

void expect_displayable(const Image& image) {
  for (int c = 0; c < 3; ++c)
    for (const float value : image.channel(c)) {
      ASSERT_GE(value, 0);
      ASSERT_LE(value, 1);
    }
}

std::vector<float> log_uniform(double decades, int count) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i)
    values.push_back(float(std::pow(10.0, decades * i / double(count - 1))));
  return values;
}

/// Steepest d log display / d log world of the curve, over steps of `step` in the logarithm.
double steepest_slope(const HistogramAdjustment& curve, double from, double to, double step) {
  double steepest = 0;
  for (double x = std::log(from); x + step < std::log(to); x += step)
    steepest =
        std::max(steepest, std::log(double(curve.display_luminance(float(std::exp(x + step)))) /
                                    double(curve.display_luminance(float(std::exp(x))))) /
                               step);
  return steepest;
}

TEST(SimpleTone, scales) {
  const Image image = grey_image(2, 1, [](int x, int) { return x ? 4.0f : 0.125f; });
  ToneMapping mapping;
  mapping.op = ToneOperator::srgb;
  EXPECT_EQ(tone_map(image, mapping).at(0, 0, 0), 0.125f);
  EXPECT_EQ(tone_map(image, mapping).at(1, 0, 0), 1);
  mapping.op = ToneOperator::linear;
  mapping.exposure = 2;
  EXPECT_EQ(tone_map(image, mapping).at(0, 0, 1), 0.5f);
  mapping.exposure = -3;
  EXPECT_EQ(tone_map(image, mapping).at(1, 0, 1), 0.5f);
}

TEST(SimpleTone, names) {
  EXPECT_EQ(tone_operator_from_name("linear"), ToneOperator::linear);
  EXPECT_EQ(tone_operator_from_name("srgb"), ToneOperator::srgb);
  EXPECT_EQ(tone_operator_from_name("histogram"), ToneOperator::histogram);
  expect_input_error([] { tone_operator_from_name("histgram"); }, "did you mean 'histogram'");
}

TEST(Gamut, keeps_luminance_and_hue) {
  for (const Vec3f& colour : {Vec3f(2, 0.1f, 0.1f), Vec3f(0.5f, 0.5f, 3), Vec3f(-0.2f, 0.7f, 0.3f),
                              Vec3f(1.3f, 0.4f, -0.1f)}) {
    const Vec3f shown = into_gamut(colour);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(shown[c], 0);
      EXPECT_LE(shown[c], 1);
    }
    EXPECT_NEAR(photopic(shown), photopic(colour), 1e-5);
    // The same direction from grey.
    const Vec3f from = colour - Vec3f(photopic(colour)), to = shown - Vec3f(photopic(shown));
    EXPECT_NEAR(dot(normalize(from), normalize(to)), 1, 1e-5);
  }
  EXPECT_EQ(into_gamut(Vec3f(0.2f, 0.9f, 1)), Vec3f(0.2f, 0.9f, 1));
  EXPECT_EQ(into_gamut(Vec3f(9, 5, 5)), Vec3f(1));
  EXPECT_EQ(into_gamut(Vec3f(-1, 0, 0)), Vec3f(0));
}

TEST(Histogram, foveal_cells_are_one_degree) {
  const Image image = grey_image(400, 200, [](int, int) { return 1.0f; });
  ToneMapping mapping;
  mapping.horizontal_fov = 50;
  const auto count = [&] { return foveal_luminances(rgb_view(image), 400, 200, mapping).size(); };
  // 2 tan 25° / 2 tan 0.5° = 53.4; half as many rows.
  EXPECT_EQ(count(), 53u * 27u);
  mapping.vertical_fov = 50;
  EXPECT_EQ(count(), 53u * 53u);
  mapping.horizontal_fov = 0.5f;
  mapping.vertical_fov = 0.1f;
  EXPECT_EQ(count(), 1u);
}

TEST(Histogram, foveal_values_are_means_of_luminance) {
  const Image image = grey_image(100, 100, [](int x, int) { return x % 2 ? 3.0f : 1.0f; });
  ToneMapping mapping;
  mapping.horizontal_fov = mapping.vertical_fov = 1;
  const std::vector<float> means = foveal_luminances(rgb_view(image), 100, 100, mapping);
  ASSERT_EQ(means.size(), 1u);
  EXPECT_NEAR(means[0], 2 * 179, 0.01);
}

TEST(Histogram, a_scene_within_the_display_range_is_scaled) {
  const HistogramAdjustment curve(log_uniform(1.5, 500), {});
  EXPECT_TRUE(curve.is_linear());
  const float brightest = std::pow(10.0f, 1.5f);
  EXPECT_NEAR(curve.display_luminance(brightest), 100, 1e-3);
  EXPECT_NEAR(curve.display_luminance(brightest / 7), 100.0 / 7, 1e-3);
}

TEST(Histogram, curve_is_monotonic_and_within_the_display_range) {
  std::mt19937 generator(5);
  std::lognormal_distribution<float> distribution(2, 3);
  std::vector<float> values;
  for (int i = 0; i < 2000; ++i) values.push_back(distribution(generator));
  const HistogramAdjustment curve(values, {});
  EXPECT_FALSE(curve.is_linear());
  float last = 0;
  for (double x = 1e-12; x < 1e12; x *= 1.01) {
    const float shown = curve.display_luminance(float(x));
    ASSERT_GE(shown, 1.0f);
    ASSERT_LE(shown, 100.0f);
    ASSERT_GE(shown, last);
    last = shown;
  }
  EXPECT_EQ(curve.display_luminance(0), 1);
  EXPECT_EQ(curve.display_luminance(nan), 1);
  EXPECT_EQ(curve.display_luminance(infinity), 100);
  EXPECT_EQ(last, 100);
}

TEST(Histogram, contrast_never_exceeds_that_of_the_scene) {
  // Two narrow crowds far apart: naive equalisation would blow up the contrast inside each.
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) {
    values.push_back(1 + 0.2f * float(i) / 1000);
    values.push_back(10000 + 2000 * float(i) / 1000);
  }
  const HistogramAdjustment curve(values, {});
  EXPECT_FALSE(curve.is_linear());
  EXPECT_LE(steepest_slope(curve, 1, 12000, 0.02), 1.01);
  EXPECT_GE(steepest_slope(curve, 1, 12000, 0.02), 0.9);  // where the crowds are: as in the scene
}

TEST(Histogram, sparse_bins_make_no_bands) {
  // Samples so few that most bins are empty. Without smoothing the curve is flat across each empty
  // bin and jumps at each full one.
  std::vector<float> values;
  for (int i = 0; i <= 12; ++i) values.push_back(std::pow(10.0f, 6.0f * float(i) / 12));
  const HistogramAdjustment curve(values, {});
  double flattest = 1;
  constexpr double step = 0.1;
  for (double x = 0.1; x + step < std::log(1e6); x += step)
    flattest =
        std::min(flattest, std::log(double(curve.display_luminance(float(std::exp(x + step)))) /
                                    double(curve.display_luminance(float(std::exp(x))))) /
                               step);
  EXPECT_GT(flattest, 0.002);
  EXPECT_LE(steepest_slope(curve, 1, 1e6, 0.02), 1.01);
}

TEST(Histogram, uniform_log_luminance_is_compressed_evenly) {
  const HistogramAdjustment curve(log_uniform(6, 20000), {});
  // Six decades into two.
  for (const double decade : {1.0, 2.0, 3.0, 4.0, 5.0})
    EXPECT_NEAR(std::log10(double(curve.display_luminance(float(std::pow(10, decade))))),
                decade / 3, 0.01);
}

TEST(Histogram, ranges_just_above_the_display_agree_with_linear) {
  const double decades = 2.001;
  const HistogramAdjustment curve(log_uniform(decades, 5000), {});
  EXPECT_FALSE(curve.is_linear());
  for (double x = 0.2; x < decades; x += 0.2)
    EXPECT_NEAR(std::log10(double(curve.display_luminance(float(std::pow(10, x))))), x, 0.02);
}

TEST(Histogram, two_values_far_apart_both_show) {
  const Image image = grey_image(60, 60, [](int x, int) { return x < 30 ? 1e-3f : 1e3f; });
  const Image shown = tone_map(image, {});
  expect_displayable(shown);
  EXPECT_LT(shown.at(5, 5, 0), 0.05f);
  EXPECT_GT(shown.at(55, 5, 0), 0.9f);
}

TEST(Histogram, equal_pixels_and_black_images) {
  for (const float value : {1e-6f, 0.5f, 1e6f}) {
    const Image shown = tone_map(grey_image(8, 8, [=](int, int) { return value; }), {});
    expect_displayable(shown);
    for (const float result : shown.channel(0)) EXPECT_NEAR(result, 1, 1e-4);
  }
  const Image black = tone_map(grey_image(8, 8, [](int, int) { return 0.0f; }), {});
  for (int c = 0; c < 3; ++c)
    for (const float result : black.channel(c)) EXPECT_EQ(result, 0);
}

TEST(Histogram, bad_pixels_do_not_poison_the_others) {
  const Image clean = testing::test_picture(60, 60, 5);
  Image dirty = clean;
  dirty.at(10, 40, 0) = nan;
  dirty.at(20, 40, 1) = infinity;
  dirty.at(30, 40, 2) = -infinity;
  const Image wanted = tone_map(clean, {}), shown = tone_map(dirty, {});
  expect_displayable(shown);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(shown.at(10, 40, c), 0);
    EXPECT_EQ(shown.at(20, 40, c), 1);
    EXPECT_EQ(shown.at(30, 40, c), 0);
    for (int x = 0; x < 60; ++x)
      if (x % 10 != 0) {
        EXPECT_NEAR(shown.at(x, 40, c), wanted.at(x, 40, c), 0.02);
      }
  }
}

TEST(Histogram, scale_of_the_scene_does_not_matter) {
  const Image image = testing::test_picture(60, 60, 5);
  Image scaled = image;
  for (int c = 0; c < 3; ++c)
    for (float& value : scaled.channel(c)) value *= 0x1p-20f;
  const Image a = tone_map(image, {}), b = tone_map(scaled, {});
  for (size_t i = 0; i < image.pixel_count(); ++i)
    ASSERT_NEAR(a.channel(1)[i], b.channel(1)[i], 2e-3);
}

TEST(ToneMapping, refuses_bad_parameters) {
  const Image image(2, 2, {"R", "G", "B"});
  const auto refuses = [&](const std::function<void(ToneMapping&)>& change, const char* part) {
    ToneMapping mapping;
    change(mapping);
    expect_input_error([&] { tone_map(image, mapping); }, part);
  };
  refuses([](ToneMapping& m) { m.horizontal_fov = 180; }, "horizontal");
  refuses([](ToneMapping& m) { m.horizontal_fov = 0; }, "horizontal");
  refuses([](ToneMapping& m) { m.vertical_fov = nan; }, "vertical");
  refuses([](ToneMapping& m) { m.display_max_luminance = 0; }, "maximum");
  refuses([](ToneMapping& m) { m.display_dynamic_range = 1; }, "dynamic range");
  refuses([](ToneMapping& m) { m.exposure = infinity; }, "exposure");
}

TEST(SrgbBytes, rounds_to_nearest) {
  Image image(3, 1, {"R", "G", "B"});
  image.at(1, 0, 0) = 1;
  image.at(1, 0, 1) = linear_from_srgb(100.4f / 255);
  image.at(1, 0, 2) = linear_from_srgb(100.6f / 255);
  image.at(2, 0, 0) = nan;
  image.at(2, 0, 1) = 7;
  image.at(2, 0, 2) = -7;
  EXPECT_EQ(srgb_bytes(image), (std::vector<uint8_t>{0, 0, 0, 255, 100, 101, 0, 255, 0}));
}

}  // namespace
}  // namespace kaustik
