// The film: exact sums, means with their errors, layers.

#include "kaustik/render/film.h"

#include <gtest/gtest.h>

#include <random>

#include "kaustik/base/statistics.h"
#include "kaustik/image/photometry.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/rounded_line.h"
#include "tests/support/film.h"

namespace kaustik {
namespace {

constexpr int width = 5, height = 4;

using test::tiled, test::value_at;

FilmSettings film_settings(int w = width, int h = height) { return test::film_of_size(w, h); }

/// Made-up passes with values over many orders of magnitude, some negative.
std::vector<std::vector<PassPixel>> made_up_passes(size_t count) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> exponent(-8, 5), uniform(-1, 1);
  std::vector<std::vector<PassPixel>> passes(count, std::vector<PassPixel>(width * height));
  for (auto& pass : passes)
    for (PassPixel& pixel : pass) {
      for (Spectrum& radiance : pixel.radiance)
        radiance = {std::pow(10.0f, exponent(generator)), uniform(generator) + 0.9f, 0.1f, 0};
      pixel.first_hit.albedo = {0.5f, 0.25f, 1, 0};
      pixel.first_hit.normal = {uniform(generator), uniform(generator), 0};
      pixel.first_hit.depth = std::pow(10.0f, exponent(generator));
      pixel.first_hit.lamps = uniform(generator);
    }
  return passes;
}

Film filmed(const std::vector<std::vector<PassPixel>>& passes, const std::vector<uint32_t>& order) {
  Film film(film_settings(), {ComponentSet::all()});
  for (const uint32_t pass : order) film.add_pass(tiled(passes[pass], film), pass);
  return film;
}

std::vector<uint32_t> counting(size_t count) {
  std::vector<uint32_t> order;
  for (size_t i = 0; i < count; ++i) order.push_back(uint32_t(i));
  return order;
}

TEST(Film, OrderOfThePassesMakesNoDifference) {
  const auto passes = made_up_passes(20);
  std::vector<uint32_t> order = counting(passes.size());
  const Film forward = filmed(passes, order);
  const Image expected = forward.image();
  std::mt19937 generator(2);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(order.begin(), order.end(), generator);
    const Film shuffled = filmed(passes, order);
    const Image image = shuffled.image();
    for (int c = 0; c < expected.channel_count(); ++c)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          ASSERT_EQ(image.at(x, y, c), expected.at(x, y, c)) << expected.channel_names()[size_t(c)];
    EXPECT_EQ(shuffled.mean_error(), forward.mean_error());
    EXPECT_EQ(shuffled.picture_error(), forward.picture_error());
  }
}

TEST(Film, NoiseOfBothKindsOfLightOverTheSamples) {
  // Two passes with two samples each; scattered light 1, 3, 5, 3 in all lanes, mirrored 2, 2, 0, 0.
  const auto pass_of = [](float scattered, float scattered_squares, float mirrored,
                          float mirrored_squares) {
    PassPixel pixel;
    pixel.radiance[size_t(Component::direct)] = Spectrum(0.25f * scattered);
    pixel.radiance[size_t(Component::indirect)] = Spectrum(0.75f * scattered);
    pixel.radiance[size_t(Component::specular)] = Spectrum(mirrored);
    pixel.radiance[size_t(Component::emission)] = Spectrum(100);
    pixel.squares = {scattered_squares, mirrored_squares};
    return std::vector<PassPixel>(width * height, pixel);
  };
  Film film(film_settings(), {ComponentSet::all()});
  film.add_pass(tiled(pass_of(2, (1 + 9) / 2.0f, 2, (4 + 4) / 2.0f), film), 0, 2);
  film.add_pass(tiled(pass_of(4, (25 + 9) / 2.0f, 0, 0), film), 1, 2);
  const Image image = film.image();
  // Means 3 and 1, sums of squared deviations 8 and 4, over n (n − 1) = 12.
  EXPECT_NEAR(value_at(image, 1, 1, "noise.scattered"), std::sqrt(8.0 / 12), 1e-5);
  EXPECT_NEAR(value_at(image, 1, 1, "noise.mirrored"), std::sqrt(4.0 / 12), 1e-5);
  // One sample tells nothing of its noise.
  Film single(film_settings(), {ComponentSet::all()});
  single.add_pass(tiled(pass_of(2, 4, 2, 4), single), 0, 1);
  EXPECT_LT(single.image().find_channel("noise.scattered"), 0);
}

/// All passes count alike, however many samples a pixel has in each.
TEST(Film, NoiseOfUnevenPasses) {
  const auto pass_of = [](uint32_t samples) {
    PassPixel pixel;
    // Single samples are 0 or 2: variance 1.
    pixel.radiance[size_t(Component::direct)] = Spectrum(1);
    pixel.squares = {2, 0};
    pixel.samples = samples;
    return std::vector<PassPixel>(width * height, pixel);
  };
  Film film(film_settings(), {ComponentSet::all()});
  uint32_t pass = 0;
  for (const uint32_t samples : {40u, 40u, 160u, 160u})
    film.add_pass(tiled(pass_of(samples), film), pass++, 40);
  const double variance = (2.0 / 40 + 2.0 / 160) / 16;
  // Up to what the mean takes off the variance of so many samples.
  EXPECT_NEAR(value_at(film.image(), 1, 1, "noise.scattered"), std::sqrt(variance),
              0.01 * std::sqrt(variance));
}

/// Variances of the mean luminances of passes.
std::vector<double> luminance_variances(const std::vector<std::vector<PassPixel>>& passes) {
  std::vector<double> result;
  for (size_t i = 0; i < size_t(width * height); ++i) {
    RunningStatistics luminance;
    for (const auto& pass : passes) {
      Vec3f sum(0, 0, 0);
      for (const Spectrum& radiance : pass[i].radiance)
        sum += Vec3f(radiance[0], radiance[1], radiance[2]);
      luminance.add(double(photopic(sum)));
    }
    result.push_back(sqr(luminance.standard_error()));
  }
  return result;
}

/// Degrees of freedom of such a sum over those of one: 0.616 of one pixel, 0.016 of each of 24.
const double freedom_of_pool = 1 / (sqr(0.616) + 24 * sqr(0.016));

/// Two fifths of a pixel's variance are the mean over 5 × 5 pixels, at most ten times its own.
double pooled_over_own(const std::vector<double>& variances, int x, int y) {
  RunningStatistics around;
  for (int v = std::max(0, y - 2); v <= std::min(height - 1, y + 2); ++v)
    for (int u = std::max(0, x - 2); u <= std::min(width - 1, x + 2); ++u)
      around.add(variances[size_t(v * width + u)]);
  return 0.6 + 0.4 * std::min(10.0, around.mean() / variances[size_t(y * width + x)]);
}

TEST(Film, MeansAndErrorsOfThePasses) {
  const auto passes = made_up_passes(7);
  const std::vector<double> variances = luminance_variances(passes);
  const Film film = filmed(passes, counting(passes.size()));
  EXPECT_EQ(film.pass_count(), 7u);
  const Image image = film.image();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      RunningStatistics green, caustic_red, depth;
      for (const auto& pass : passes) {
        const PassPixel& pixel = pass[size_t(y * width + x)];
        double sum = 0;
        for (const Spectrum& radiance : pixel.radiance) sum += double(radiance[1]);
        green.add(sum);
        caustic_red.add(double(pixel.radiance[size_t(Component::caustic)][0]));
        depth.add(double(pixel.first_hit.depth));
      }
      EXPECT_NEAR(value_at(image, x, y, "G"), green.mean(), 1e-5 * std::fabs(green.mean()));
      const double error = green.standard_error() * std::sqrt(pooled_over_own(variances, x, y));
      EXPECT_NEAR(value_at(image, x, y, "error.G"), error, 1e-4 * error);
      EXPECT_NEAR(value_at(image, x, y, "caustic.R"), caustic_red.mean(),
                  1e-5 * caustic_red.mean());
      EXPECT_NEAR(value_at(image, x, y, "depth.Z"), depth.mean(), 1e-5 * depth.mean());
      EXPECT_FLOAT_EQ(value_at(image, x, y, "albedo.G"), 0.25f);
      EXPECT_FLOAT_EQ(value_at(image, x, y, "N.Z"), 0);
    }
}

TEST(Film, LayersAreThoseOfTheComponents) {
  ComponentSet set;
  set.add(Component::caustic);
  Film film(film_settings(), {set});
  const Image empty = film.image();
  EXPECT_GE(empty.find_channel("caustic.R"), 0);
  EXPECT_EQ(empty.find_channel("direct.R"), -1);
  for (const char* name : {"R", "G", "B", "albedo.R", "N.X", "N.Y", "depth.Z", "error.B"})
    EXPECT_GE(empty.find_channel(name), 0) << name;
  for (int c = 0; c < empty.channel_count(); ++c)
    for (const float value : empty.channel(c)) EXPECT_EQ(value, 0);
}

/// A pass whose pixels all have this luminance (of grey).
std::vector<PassPixel> grey_pass(float value, size_t count = width * height) {
  return test::grey_pixels(value, count);
}

TEST(Film, MeanErrorComesFromTheReplicates) {
  Film film(film_settings(), {ComponentSet::all()});
  EXPECT_TRUE(std::isinf(film.mean_error()));
  film.add_pass(tiled(grey_pass(1), film), 0);
  EXPECT_TRUE(std::isinf(film.mean_error()));
  film.add_pass(tiled(grey_pass(3), film), replicate_count);  // the same replicate again
  EXPECT_TRUE(std::isinf(film.mean_error()));
  film.add_pass(tiled(grey_pass(4), film), 1);
  RunningStatistics means;
  means.add(2);
  means.add(4);
  EXPECT_NEAR(
      film.mean_error(),
      student_t_quantile(0.975, double(means.count() - 1)) * means.standard_error() / means.mean(),
      1e-5);
}

TEST(Film, ErrorOfThePictureIsRelative) {
  Film film(film_settings(), {ComponentSet::all()});
  film.add_pass(tiled(grey_pass(1), film), 0);
  EXPECT_TRUE(std::isinf(film.picture_error()));
  film.add_pass(tiled(grey_pass(3), film), 1);
  // Mean 2, standard error of the mean 1.
  EXPECT_NEAR(film.picture_error(), 1 / (2 + 0.01 * 2), 1e-6);
}

/// Passes of one replicate are one value: their sum.
TEST(Film, ErrorsComeFromTheReplicates) {
  Film film(film_settings(), {ComponentSet::all()});
  const float values[] = {1, 2, 4, 3, 9};
  const uint32_t passes[] = {0, 1, replicate_count, replicate_count + 1, 2};
  for (int i = 0; i < 5; ++i) film.add_pass(tiled(grey_pass(values[i]), film), passes[i]);
  // Sums 5, 5 and 9 over 2, 2 and 1 passes; the mean is 19/5.
  const double mean = 19 / 5.0;
  const double squares = 2 * std::pow(5 - 2 * mean, 2) + std::pow(9 - mean, 2),
               variance = squares / 25 * 3 / 2;
  EXPECT_NEAR(value_at(film.image(), 2, 1, "error.G"), std::sqrt(variance), 1e-5);
  EXPECT_NEAR(film.picture_error(), std::sqrt(variance) / (1.01 * mean), 1e-6);
  const ConfidenceInterval interval = FilmErrors(film).luminance(0);
  EXPECT_NEAR(interval.mean, mean, 1e-6);
  EXPECT_NEAR(interval.half_width,
              student_t_quantile(0.975, 2 * freedom_of_pool) * std::sqrt(variance), 1e-5);
}

/// Pixels that share their light have the noise of one: what is added up from pixels' errors as if
/// they were independent would be too small by the root of their number.
TEST(Film, ErrorsOfARegionComeFromItsOwnReplicates) {
  Film shared(film_settings(), {ComponentSet::all()}),
      apart(film_settings(), {ComponentSet::all()});
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> value(1, 3);
  constexpr uint32_t passes = 2 * replicate_count;
  constexpr int left = 1, top = 1, columns = 3, rows = 2;
  std::array<double, replicate_count> sums{};
  for (uint32_t pass = 0; pass < passes; ++pass) {
    shared.add_pass(tiled(grey_pass(value(generator)), shared), pass);
    std::vector<PassPixel> pixels = grey_pass(0);
    for (size_t i = 0; i < pixels.size(); ++i) {
      const float grey = value(generator);
      pixels[i] = grey_pass(grey)[0];
      const int x = int(i) % width, y = int(i) / width;
      if (x >= left && x < left + columns && y >= top && y < top + rows)
        sums[pass % replicate_count] += double(grey) / (columns * rows);
    }
    apart.add_pass(tiled(pixels, apart), pass);
  }
  const PixelRegion region{left, top, columns, rows};
  const FilmErrors of_shared(shared);
  EXPECT_NEAR(of_shared.known(region).deviation, of_shared.known(size_t{7}).deviation, 1e-6);
  RunningStatistics means;
  for (const double sum : sums) means.add(sum / 2);
  const KnownLuminance known = FilmErrors(apart).known(region);
  EXPECT_NEAR(known.mean, means.mean(), 1e-5);
  EXPECT_NEAR(known.deviation, means.standard_error(), 1e-5);
  EXPECT_EQ(known.freedom, replicate_count - 1);
  EXPECT_NEAR(known.interval(0.9).half_width,
              student_t_quantile(0.95, replicate_count - 1) * means.standard_error(), 1e-5);
  // All of it is the picture.
  const KnownLuminance all = FilmErrors(apart).known(PixelRegion{0, 0, width, height});
  EXPECT_NEAR(all.interval().half_width / all.mean, apart.mean_error(), 1e-6);
}

TEST(Film, BlackPicturesHaveNoError) {
  Film film(film_settings(), {ComponentSet::all()});
  for (uint32_t pass = 0; pass < 2; ++pass) film.add_pass(tiled(grey_pass(0), film), pass);
  EXPECT_EQ(film.picture_error(), 0);
}

/// Images tell what passes of odd replicates have, component by component.
TEST(Film, HalvesAreTheMeansOfOddReplicates) {
  const auto passes = made_up_passes(19);
  const Image image = filmed(passes, counting(passes.size())).image();
  // Passes 1, 3, … 17: nine of nineteen.
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      EXPECT_FLOAT_EQ(value_at(image, x, y, "odd.share"), 9 / 19.0f);
      for (int c = 0; c < component_count; ++c) {
        double odd = 0, all = 0;
        for (size_t pass = 0; pass < passes.size(); ++pass) {
          const Spectrum& radiance =
              passes[pass][size_t(y) * width + size_t(x)].radiance[size_t(c)];
          const auto luminance = double(photopic({radiance[0], radiance[1], radiance[2]}));
          all += luminance / 19;
          if (pass % 2 == 1) odd += luminance / 9;
        }
        const std::string name = "odd." + std::string(component_names[size_t(c)]);
        // Rounded to 12 bits below most pixels of a tile; emission is what is left of all.
        EXPECT_NEAR(double(value_at(image, x, y, name)), odd,
                    1e-3 * std::max(odd, 1.0) + 1e-6 * all)
            << name;
      }
    }
  // There is one half alone, or none.
  for (const size_t count : {0, 1})
    EXPECT_LT(filmed(passes, counting(count)).image().find_channel("odd.share"), 0);
  EXPECT_LT(filmed(passes, {0, 2, 4, 16}).image().find_channel("odd.share"), 0);
  // Films of files from before there were halves lack them.
  Film old(film_settings(), {ComponentSet::all(), false, true, false, false});
  for (uint32_t pass = 0; pass < 4; ++pass) old.add_pass(tiled(passes[pass], old), pass);
  EXPECT_LT(old.image().find_channel("odd.share"), 0);
}

/// Whether passes are summed by one film, or by parts that are added in any order, all has the same
/// bits: what is rounded before it is summed, too.
TEST(Film, PartsMakeTheWholeInAnyOrder) {
  constexpr int side = 40, count = 24;
  const FilmLayers layers{ComponentSet::all(), true};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> power(-9, 4);
  Film whole(film_settings(side, side), layers);
  std::vector<Film> parts(5, whole);
  for (uint32_t pass = 0; pass < count; ++pass) {
    std::vector<PassPixel> pixels(size_t{side} * side);
    for (PassPixel& pixel : pixels) {
      for (Spectrum& radiance : pixel.radiance)
        radiance = {std::exp2(power(random)), std::exp2(power(random)), 0.3f, 0};
      pixel.squares = {std::exp2(power(random)), std::exp2(power(random))};
      pixel.bias = Spectrum(std::exp2(power(random)) - 1);
      pixel.samples = 1 + uint32_t(random() % 7);
    }
    whole.add_pass(tiled(pixels, whole), pass);
    parts[random() % parts.size()].add_pass(tiled(pixels, whole), pass);
  }
  std::shuffle(parts.begin(), parts.end(), random);
  for (size_t i = 1; i < parts.size(); ++i) parts[0].add(parts[i]);
  for (size_t pixel = 0; pixel < whole.pixel_count(); ++pixel)
    for (size_t number = 0; number < whole.numbers().count; ++number)
      ASSERT_TRUE(parts[0].sum(pixel, number) == whole.sum(pixel, number))
          << pixel << ' ' << number;
}

/// Errors from rounded numbers are those from exact ones up to the standard error of the rounding,
/// which is at most a unit over the root of the passes: in the dark beside a lamp, too, and with
/// little noise; and light that is always the same has none.
TEST(Film, RoundingLeavesErrorsTheirDigits) {
  constexpr int side = 16, count = 64;
  std::mt19937 random(4);
  std::normal_distribution<float> noise;
  Film film(film_settings(side, side), {ComponentSet::all()});
  const auto brightness = [](size_t i) { return i % 3 == 0 ? 1e3f : i % 3 == 1 ? 1.0f : 0.01f; };
  const auto spread = [](size_t i) { return i % 4 == 0 ? 0 : i % 4 == 1 ? 0.3f : 0.003f; };
  std::vector<std::array<RunningStatistics, 3>> channels(side * side);
  std::vector<RunningStatistics> luminances(side * side);
  std::vector<std::array<double, replicate_count>> replicates(side * side);
  for (uint32_t pass = 0; pass < count; ++pass) {
    std::vector<PassPixel> pixels(side * side);
    for (size_t i = 0; i < pixels.size(); ++i) {
      Spectrum& radiance = pixels[i].radiance[size_t(Component::direct)];
      for (int lane = 0; lane < 3; ++lane)
        radiance.set(lane, brightness(i) * (1 + spread(i) * noise(random)));
      for (int lane = 0; lane < 3; ++lane) channels[i][size_t(lane)].add(double(radiance[lane]));
      const auto luminance = double(photopic({radiance[0], radiance[1], radiance[2]}));
      luminances[i].add(luminance);
      replicates[i][pass % replicate_count] += luminance;
    }
    film.add_pass(tiled(pixels, film), pass);
  }
  std::vector<double> variances;
  for (const auto& sums : replicates) {
    RunningStatistics means;
    for (const double sum : sums) means.add(sum * replicate_count / count);
    variances.push_back(sqr(means.standard_error()));
  }
  // The geometric mean of the luminances is 2.15.
  const double rounding = std::ldexp(2, -luminance_bits) / std::sqrt(count);
  const FilmErrors errors(film);
  for (size_t i = 0; i < variances.size(); ++i) {
    const int x = int(i) % side, y = int(i) / side;
    double around = 0, neighbours = 0;
    for (int v = std::max(0, y - 2); v <= std::min(side - 1, y + 2); ++v)
      for (int u = std::max(0, x - 2); u <= std::min(side - 1, x + 2); ++u)
        around += variances[size_t(v * side + u)], ++neighbours;
    const double pooled =
        0.6 * variances[i] + 0.4 * std::min(10 * variances[i], around / neighbours);
    ChannelSums sums;
    for (size_t lane = 0; lane < 3; ++lane) {
      sums.totals[lane] = film.total(i, int(lane));
      sums.squares[lane] = film.total_squares(i, int(lane));
    }
    sums.luminance_squares = film.luminance_squares(i);
    const Vec3f error = errors.of_pixel(i, sums);
    for (int lane = 0; lane < 3; ++lane) {
      const double exact = spread(i) == 0 ? 0
                                          : channels[i][size_t(lane)].standard_error() *
                                                std::sqrt(pooled) / luminances[i].standard_error();
      EXPECT_TRUE(spread(i) > 0 || error[lane] == 0) << i;
      EXPECT_NEAR(double(error[lane]), exact, 1e-4 * exact + rounding) << i << ' ' << lane;
    }
  }
}

/// In tiles that are all bright but for one pixel: errors of that over the exact ones, by channel.
RunningStatistics errors_in_the_dark(float light, float relative_noise, double& largest) {
  constexpr int tiles = 8, side = tiles * PictureTiles::side, count = 16;
  const auto is_dark = [](size_t i) {
    return int(i) % side % PictureTiles::side == 7 && int(i) / side % PictureTiles::side == 7;
  };
  std::mt19937 random(9);
  std::normal_distribution<float> noise;
  Film film(film_settings(side, side), {ComponentSet::all()});
  std::vector<std::array<RunningStatistics, 3>> channels(side * side);
  std::vector<RunningStatistics> luminances(side * side);
  for (uint32_t pass = 0; pass < count; ++pass) {
    std::vector<PassPixel> pixels(side * side);
    for (size_t i = 0; i < pixels.size(); ++i) {
      Spectrum& radiance = pixels[i].radiance[size_t(Component::direct)];
      for (int lane = 0; lane < 3; ++lane)
        radiance.set(lane, is_dark(i) ? light * (1 + relative_noise * noise(random))
                                      : 1 + 0.1f * noise(random));
      for (int lane = 0; lane < 3; ++lane) channels[i][size_t(lane)].add(double(radiance[lane]));
      luminances[i].add(double(photopic({radiance[0], radiance[1], radiance[2]})));
    }
    film.add_pass(tiled(pixels, film), pass);
  }
  const Image image = film.image();
  RunningStatistics ratios;
  largest = 0;
  for (size_t i = 0; i < channels.size(); ++i) {
    if (!is_dark(i)) continue;
    for (int lane = 0; lane < 3; ++lane) {
      // Two fifths are told by far noisier pixels around: ten times the pixel's own.
      const double exact = channels[i][size_t(lane)].standard_error() * std::sqrt(0.6 + 0.4 * 10);
      const auto error =
          double(image.at(int(i) % side, int(i) / side, image.find_channel("error.R") + lane));
      ratios.add(error / exact);
      largest = std::max(largest, error);
    }
  }
  return ratios;
}

/// A pixel that is 10⁴ times darker than all others of its tile keeps the errors of its channels if
/// its noise is 2 % of its light. Of one that is 10⁵ times darker, with 3 %, they are lost, but are
/// never more than what rounding is of the tile's light.
TEST(Film, ErrorsInTheDarkOfABrightTile) {
  double largest = 0;
  const RunningStatistics fine = errors_in_the_dark(1e-4f, 0.02f, largest);
  EXPECT_NEAR(fine.mean(), 1, 0.01);
  EXPECT_LT(fine.standard_deviation(), 0.05);
  errors_in_the_dark(1e-5f, 0.03f, largest);
  EXPECT_LT(largest, std::ldexp(1, -square_bits / 2));
}

/// Without layers the picture and what is told of its error keep their bits.
TEST(Film, PicturesWithoutLayers) {
  const auto passes = made_up_passes(20);
  FilmLayers layers{ComponentSet::all()};
  layers.in_images = false;
  Film film(film_settings(), layers), first(film_settings(), layers), rest(film_settings(), layers);
  for (uint32_t pass = 0; pass < 20; ++pass) {
    film.add_pass(tiled(passes[pass], film), pass);
    (pass < 5 ? first : rest).add_pass(tiled(passes[pass], film), pass);
  }
  rest.add(first);
  const Film whole = filmed(passes, counting(20));
  EXPECT_FALSE(film.is_like(whole));
  const Image expected = whole.image();
  for (const Film* each : {&film, &rest}) {
    const Image image = each->image();
    // And the share that lamps have in it, which displays ask for.
    EXPECT_EQ(image.channel_names(),
              (std::vector<std::string>{"R", "G", "B", "emission.R", "emission.G", "emission.B",
                                        "emission.A"}));
    for (const std::string& name : image.channel_names())
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
          ASSERT_EQ(value_at(image, x, y, name), value_at(expected, x, y, name)) << name;
    EXPECT_EQ(each->mean_error(), whole.mean_error());
    EXPECT_EQ(each->picture_error(), whole.picture_error());
  }
}

TEST(Film, PicturesTooLargeAreRefusedWithTheirPlace) {
  FilmSettings settings = film_settings(30000, 30000);
  settings.place = place_in("scene.xml", 7, 3);
  try {
    const Film film(settings, {ComponentSet::all()});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.problems()[0].place.line, 7);
    EXPECT_NE(error.problems()[0].message.find("30000 × 30000"), std::string::npos);
    EXPECT_FALSE(error.problems()[0].remedy.empty());
  }
}

}  // namespace
}  // namespace kaustik
