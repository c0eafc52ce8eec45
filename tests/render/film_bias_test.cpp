// How far off pixels are told to be, by the estimates of their bias.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kaustik/image/photometry.h"
#include "kaustik/render/film_errors.h"
#include "tests/support/film.h"

namespace kaustik {
namespace {

using test::tiled, test::value_at;

constexpr Vec2i few(5, 4);  ///< pixels

Film film_with_bias(const Vec2i& size = few) {
  return Film(test::film_of_size(size.x, size.y), {ComponentSet::all(), true});
}

TEST(FilmBias, RegionHasTheMeanOfItsPixels) {
  Film film = film_with_bias();
  for (uint32_t pass = 0; pass < 2; ++pass) {
    std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
    for (size_t i = 0; i < pixels.size(); ++i)
      pixels[i].bias = Spectrum(i % size_t(few.x) < 2 ? 0.25f : -0.75f);
    film.add_pass(tiled(pixels, film), pass);
  }
  EXPECT_NEAR(FilmErrors(film).known(PixelRegion{0, 0, 2, 3}).bias, 0.25, 1e-6);
  EXPECT_NEAR(FilmErrors(film).known(PixelRegion{1, 1, 2, 2}).bias, 0.25, 1e-6);
  EXPECT_NEAR(FilmErrors(film).known(PixelRegion{2, 0, 3, 1}).bias, 0.75, 1e-6);
}

TEST(FilmBias, IsPartOfTheError) {
  Film film = film_with_bias();
  for (uint32_t pass = 0; pass < 2; ++pass) {
    std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
    for (PassPixel& pixel : pixels) pixel.bias = {0.3f, -0.4f, pass == 0 ? 1.2f : -1.2f, 0};
    film.add_pass(tiled(pixels, film), pass);
  }
  const Image image = film.image();
  EXPECT_FLOAT_EQ(value_at(image, 1, 2, "bias.G"), -0.4f);
  // All pixels have the same: it is taken for light that bends smoothly.
  EXPECT_FLOAT_EQ(value_at(image, 1, 2, "error.R"), 0.2f);
  EXPECT_FLOAT_EQ(value_at(image, 1, 2, "error.G"), 0.8f / 3);
  EXPECT_FLOAT_EQ(value_at(image, 1, 2, "error.B"), 0);
  const double mean = std::fabs(double(photopic({0.3f, -0.4f, 0})));
  const double half_difference = double(photopic({0, 0, 1.2f}));
  const double product = mean * mean - half_difference * half_difference;
  const double bias = std::sqrt(4 / 9.0 * product);
  EXPECT_NEAR(film.picture_error(), bias / 2.02, 1e-6);
  EXPECT_NEAR(film.mean_error(), mean / 2, 1e-6);
  const KnownLuminance known = FilmErrors(film).known(3);
  EXPECT_NEAR(known.bias, bias, 1e-6);
  const double variance = half_difference * half_difference;
  EXPECT_NEAR(known.bias_deviation, std::sqrt(4 / 9.0 * variance * product / (product + variance)),
              1e-6);
  // The passes are the same, so that is all there is.
  EXPECT_EQ(known.deviation, 0);
  EXPECT_GT(known.interval().half_width, bias + known.bias_deviation);
  EXPECT_LT(
      Film(test::film_of_size(few.x, few.y), {ComponentSet::all()}).image().find_channel("bias.R"),
      0);
}

/// Where the two halves contradict each other that is no bias, but it takes nothing off the noise.
TEST(FilmBias, ContradictionsDoNotHideNoise) {
  const auto film_with = [](bool biased) {
    Film film(test::film_of_size(few.x, few.y), FilmLayers{ComponentSet::all(), biased});
    for (uint32_t pass = 0; pass < 16; ++pass) {
      std::vector<PassPixel> pixels =
          test::grey_pixels(1 + 0.1f * float(pass % 5), film.pixel_count());
      for (PassPixel& pixel : pixels) pixel.bias = Spectrum(pass % 2 == 0 ? 3.0f : -3.0f);
      film.add_pass(tiled(pixels, film), pass);
    }
    return film.picture_error();
  };
  EXPECT_GT(film_with(false), 0.01);
  EXPECT_DOUBLE_EQ(film_with(true), film_with(false));
}

/// At an edge of light the bias is of opposite signs on the two sides, and no smaller for that.
TEST(FilmBias, OppositeSignsDoNotCancel) {
  Film film = film_with_bias({8, 5});
  for (uint32_t pass = 0; pass < 3; ++pass) {
    std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i].bias = Spectrum(i % 8 < 4 ? 0.5f : -0.5f);
    film.add_pass(tiled(pixels, film), pass);
    // One pass tells nothing of its noise.
    EXPECT_NEAR(value_at(film.image(), 4, 2, "error.R"), pass == 0 ? 0 : 0.5, 1e-6);
  }
  EXPECT_FLOAT_EQ(value_at(film.image(), 4, 2, "bias.R"), -0.5f);
  EXPECT_NEAR(film.picture_error(), 0.5 / 2.02, 1e-6);
}

/// A line of bias that is sure keeps its bias where the pixels around would thin it out; beside it,
/// and in the picture, their mean counts, with less of what they have in common.
TEST(FilmBias, LinesAreNotThinnedOut) {
  Film film = film_with_bias({9, 9});
  for (uint32_t pass = 0; pass < 4; ++pass) {
    std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
    for (size_t y = 0; y < 9; ++y) pixels[9 * y + 4].bias = Spectrum(0.5f);
    film.add_pass(tiled(pixels, film), pass);
  }
  const Image image = film.image();
  constexpr double too_much = 5 / 9.0 / (9 * 9);
  EXPECT_NEAR(value_at(image, 4, 4, "error.R"), 0.5 * std::sqrt(1 - too_much), 1e-6);
  EXPECT_NEAR(value_at(image, 3, 4, "error.R"), 0.5 * std::sqrt(1 / 9.0 - too_much), 1e-6);
  EXPECT_EQ(value_at(image, 1, 4, "error.R"), value_at(image, 3, 4, "error.R"));
  EXPECT_NEAR(film.picture_error(), 0.5 * std::sqrt(1 / 9.0 - too_much) / 2.02, 1e-6);
}

/// Estimates that are noise alone make the error of the picture no larger.
TEST(FilmBias, NoiseOfItsEstimatesIsNone) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.4f);
  constexpr int side = 100;
  Film film = film_with_bias({side, side});
  for (uint32_t pass = 0; pass < 16; ++pass) {
    std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
    for (PassPixel& pixel : pixels) pixel.bias = Spectrum(noise(random));
    film.add_pass(tiled(pixels, film), pass);
  }
  // Its mean has a standard error of 0.1, a twentieth of the light.
  EXPECT_LT(film.picture_error(), 0.01);
  double mean_square = 0;
  const Image image = film.image();
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      mean_square += std::pow(double(value_at(image, x, y, "error.R")), 2) / (side * side);
  EXPECT_LT(std::sqrt(mean_square), 0.05);
  // Nor are intervals wider: a twentieth of it is what a window of 23 × 23 leaves.
  const FilmErrors errors(film);
  for (size_t i = 0; i < film.pixel_count(); ++i) EXPECT_LT(errors.known(i).bias_deviation, 0.01);
}

/// Bright above, dark below with a bias as large as its light: means over a window are weighted by
/// the light. The window reaches 11 pixels, across rows that are looked at apart, too.
TEST(FilmBias, MeansAreWeightedByTheLight) {
  constexpr int rows = 560, columns = 4, reach = 11;
  constexpr double bright = 2, dark = 0.1;
  for (const int edge : {100, 250, 256, 262, 512}) {
    Film film = film_with_bias({columns, rows});
    for (uint32_t pass = 0; pass < 2; ++pass) {
      std::vector<PassPixel> pixels(size_t{columns} * rows);
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
          PassPixel& pixel = pixels[size_t(y * columns + x)];
          pixel.radiance[0] = Spectrum(float(y < edge ? bright : dark));
          pixel.bias = Spectrum(y < edge ? 0 : float(dark));
        }
      film.add_pass(tiled(pixels, film), pass);
    }
    const FilmErrors errors(film);
    const double mean = (bright * edge + dark * (rows - edge)) / rows;
    const double bright_light = bright + 0.01 * mean, dark_light = dark + 0.01 * mean;
    const double relative = dark / dark_light;
    for (int y = edge - 20; y < edge; ++y) {
      const int dark_rows = std::max(0, y + reach - edge + 1), bright_rows = edge - y + reach;
      const double share =
          dark_light * dark_rows / (dark_light * dark_rows + bright_light * bright_rows);
      const double squared = sqr(relative) * share * (1 - 5 / 9.0 * share);
      EXPECT_NEAR(errors.known(size_t(y) * columns + 1).bias, std::sqrt(squared) * bright_light,
                  1e-5 * bright_light)
          << y << " of " << edge;
    }
  }
}

/// A bright line among dark pixels is sure by its own light, not by theirs.
TEST(FilmBias, BrightLinesAreSureAmongDarkPixels) {
  constexpr int side = 31, line = 15;
  Film film = film_with_bias({side, side});
  for (uint32_t pass = 0; pass < 2; ++pass) {
    std::vector<PassPixel> pixels(size_t{side} * side);
    for (size_t i = 0; i < pixels.size(); ++i) {
      const bool is_bright = i % side == line;
      pixels[i].radiance[0] = Spectrum(is_bright ? 100.0f : 0.01f);
      // Of what is dark, noise alone.
      pixels[i].bias = Spectrum(is_bright ? 20.0f : pass == 0 ? 0.05f : -0.05f);
    }
    film.add_pass(tiled(pixels, film), pass);
  }
  // A third of the window's smooth part, which is the line's share in it, is too much.
  const FilmErrors errors(film);
  const double bias = errors.known(size_t{line} * side + line).bias;
  EXPECT_LT(bias, 20);
  EXPECT_GT(bias, 13);
}

/// Those of the luminance around, by plain loops, from halves that differ: across the rows that are
/// looked at together, too.
TEST(FilmBias, IsAsPlainLoopsFindIt) {
  constexpr int columns = 3, rows = 300, reach = 11;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform;
  Film film = film_with_bias({columns, rows});
  std::vector<std::array<double, 2>> halves(size_t{columns} * rows);
  std::vector<double> light(halves.size());
  double mean = 0;
  for (double& own : light) mean += (own = double(1 + uniform(random))) / (columns * rows);
  for (uint32_t half = 0; half < 2; ++half) {
    std::vector<PassPixel> pixels(light.size());
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i].radiance[0] = Spectrum(float(light[i]));
      const float bias = 0.2f + 0.1f * std::sin(0.05f * float(i)) + 0.3f * (uniform(random) - 0.5f);
      pixels[i].bias = Spectrum(bias);
      halves[i][half] = double(bias);
    }
    film.add_pass(tiled(pixels, film), half);
  }
  for (double& own : light) own += 0.01 * mean;
  const auto in_window = [&](size_t y, const auto& value) {
    double sum = 0, weight = 0;
    for (size_t k = y - std::min<size_t>(y, reach); k < std::min<size_t>(rows, y + reach + 1); ++k)
      for (size_t i = k * columns; i < (k + 1) * columns; ++i)
        sum += light[i] * value(i), weight += light[i];
    return sum / weight;
  };
  const auto mean_of = [&](size_t half, size_t y) {
    return in_window(y, [&](size_t i) { return halves[i][half] / light[i]; });
  };
  std::vector<double> differences;
  for (size_t y = 0; y < rows; ++y) differences.push_back(0.5 * (mean_of(0, y) - mean_of(1, y)));
  const FilmErrors errors(film);
  int equal = 0;
  for (size_t y = 0; y < rows; ++y) {
    const double all =
        in_window(y, [&](size_t i) { return halves[i][0] * halves[i][1] / sqr(light[i]); });
    const double common = std::clamp(mean_of(0, y) * mean_of(1, y), 0.0, all);
    const double variance = in_window(y, [&](size_t i) { return sqr(differences[i / columns]); });
    const size_t pixel = y * columns + 1;
    const KnownLuminance known = errors.known(pixel);
    const double bias = std::sqrt(all - 5 / 9.0 * common) * light[pixel];
    // Where a pixel is sure of its own, it is more.
    EXPECT_GE(known.bias, (1 - 1e-5) * bias) << y;
    equal += known.bias < (1 + 1e-5) * bias ? 1 : 0;
    EXPECT_NEAR(known.bias_deviation,
                2 / 3.0 * std::sqrt(variance * common / (variance + common)) * light[pixel],
                1e-3 * known.bias_deviation)
        << y;
  }
  EXPECT_GT(equal, rows / 2);
}

/// A region has passes of both halves, the rest of the picture has one: it has no bias, and takes
/// nothing off that of the region.
TEST(FilmBias, PixelsOfOneHalfHaveNone) {
  Film film = film_with_bias({40, 40});
  std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
  for (PassPixel& pixel : pixels) pixel.bias = Spectrum(0.3f);
  film.add_pass(tiled(pixels, film), 0);
  const PixelRegion region{10, 10, 8, 6};
  pixels.resize(size_t(region.pixel_count()));
  for (int i = 0; i < 2; ++i)
    film.add_regional_pass(region, test::pass_of(pixels, {region.width, region.height}),
                           film.next_regional_pass(region, 1));
  const FilmErrors errors(film);
  for (size_t i = 0; i < film.pixel_count(); ++i)
    EXPECT_NEAR(errors.known(i).bias, region.holds(int(i % 40), int(i / 40)) ? 0.2 : 0, 1e-6) << i;
}

/// Of numbers that are none, an interval holds everything.
TEST(FilmBias, WhatIsNotKnownHasNoNarrowInterval) {
  for (const double none : {std::nan(""), double(infinity)}) {
    EXPECT_TRUE(std::isinf(KnownLuminance{1, none, 0.2, 15, 0.1}.interval().half_width));
    EXPECT_TRUE(std::isinf(KnownLuminance{1, 0.1, none, 15, 0.1}.interval().half_width));
    EXPECT_TRUE(std::isinf(KnownLuminance{1, 0.1, 0.2, 15, none}.interval().half_width));
  }
  EXPECT_LT(KnownLuminance({1, 0.1, 0.2, 15, 0.1}).interval().half_width, 1);
}

/// Pixels that have nothing to do with one another tell nothing of smooth light.
TEST(FilmBias, ApartEachTellsItsOwn) {
  FilmLayers layers{ComponentSet::all(), true};
  layers.pixels_are_apart = true;
  Film film(test::film_of_size(few.x, few.y), layers);
  for (uint32_t pass = 0; pass < 2; ++pass) {
    std::vector<PassPixel> pixels = test::grey_pixels(2, film.pixel_count());
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i].bias = Spectrum(i == 7 ? 0.5f : 0.0f);
    film.add_pass(tiled(pixels, film), pass);
  }
  const FilmErrors errors(film);
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    EXPECT_NEAR(errors.known(i).bias, i == 7 ? 0.5 : 0, 1e-6);
    EXPECT_EQ(errors.known(i).bias_deviation, 0);
  }
}

}  // namespace
}  // namespace kaustik
