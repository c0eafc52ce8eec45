// Denoising against pictures whose truth is known, by any number of passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "kaustik/base/parallel.h"
#include "kaustik/image/denoise.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr bool slow_build = true;
#else
constexpr bool slow_build = false;
#endif
constexpr int wall_side = 96;

/// A pixel of a wall without noise, and what one pass makes of it.
struct WallPixel {
  float albedo = 0.5f;
  float irradiance = 1;
};
using Wall = std::function<WallPixel(int x, int y)>;
/// The value of one pass over its mean, which is 1; and its standard deviation.
struct PassNoise {
  std::function<double(std::mt19937&)> value;
  double deviation = 1;
};

PassNoise gaussian(double deviation) {
  return {[=](std::mt19937& generator) {
            return std::normal_distribution<double>(1, deviation)(generator);
          },
          deviation};
}

/// Once in a thousand passes a path finds half of all the light.
PassNoise fireflies() {
  constexpr double chance = 1e-3, part = 0.5, noise = 0.3;
  return {[=](std::mt19937& generator) {
            const bool found = std::bernoulli_distribution(chance)(generator);
            return (1 - part) * std::normal_distribution<double>(1, noise)(generator) +
                   (found ? part / chance : 0);
          },
          std::sqrt(noise * noise * (1 - part) * (1 - part) + part * part / chance)};
}

struct Shown {
  Image image;
  std::vector<double> truth;
};

Shown pictured(const Wall& wall, const PassNoise& noise, int passes, uint32_t seed = 1) {
  std::vector<std::string> names = {"R",
                                    "G",
                                    "B",
                                    "direct.R",
                                    "direct.G",
                                    "direct.B",
                                    "albedo.R",
                                    "albedo.G",
                                    "albedo.B",
                                    "N.X",
                                    "N.Y",
                                    "N.Z",
                                    "depth.Z",
                                    "error.R",
                                    "error.G",
                                    "error.B",
                                    "noise.scattered",
                                    "noise.mirrored"};
  if (passes > 1) names.insert(names.end(), {"odd.direct", "odd.share"});
  Shown result{Image(wall_side, wall_side, names), {}};
  Image& image = result.image;
  std::mt19937 generator(seed);
  for (int y = 0; y < wall_side; ++y)
    for (int x = 0; x < wall_side; ++x) {
      const WallPixel pixel = wall(x, y);
      const double truth = double(pixel.albedo) * double(pixel.irradiance);
      double all = 0, odd = 0;
      for (int pass = 0; pass < passes; ++pass) {
        const double value = truth * noise.value(generator);
        all += value;
        if (pass % 2 == 1) odd += value;
      }
      const auto deviation = float(truth * noise.deviation / std::sqrt(passes));
      const auto set = [&](const char* name, double value) {
        image.at(x, y, image.find_channel(name)) = float(value);
      };
      for (const char* name : {"R", "G", "B", "direct.R", "direct.G", "direct.B"})
        set(name, all / passes);
      for (const char* name : {"albedo.R", "albedo.G", "albedo.B"}) set(name, double(pixel.albedo));
      for (const char* name : {"error.R", "error.G", "error.B", "noise.scattered"})
        set(name, double(deviation));
      set("N.Z", 1);
      set("depth.Z", 2);
      if (passes > 1) {
        set("odd.direct", odd / (passes / 2));
        set("odd.share", 0.5);
      }
      result.truth.push_back(truth);
    }
  return result;
}

/// Of pixels that `counts` says.
double relative_mse(
    const Image& image, const std::vector<double>& truth,
    const std::function<bool(int x)>& counts = [](int) { return true; }) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < wall_side; ++y)
    for (int x = 0; x < wall_side; ++x) {
      if (!counts(x)) continue;
      const double wanted = truth[size_t(y) * wall_side + size_t(x)];
      sum += std::pow(double(image.at(x, y, 1)) - wanted, 2) / (wanted * wanted + 0.01);
      ++count;
    }
  return sum / count;
}

WallPixel plain(int, int) { return {}; }
WallPixel light_ramp(int x, int y) { return {0.5f, 0.2f + 0.01f * float(x) + 0.02f * float(y)}; }
WallPixel bowl(int x, int y) {
  return {0.5f, 1 + 0.5f * std::sin(float(x) * 0.13f) * std::cos(float(y) * 0.11f)};
}
WallPixel lit_edge(int x, int y) { return {0.5f, 3 * x + y < 2 * wall_side ? 1.0f : 0.3f}; }
WallPixel bright_line(int x, int) { return {0.5f, x == wall_side / 2 ? 4.0f : 1.0f}; }
WallPixel faint_line(int x, int) { return {0.5f, x == wall_side / 2 ? 1.3f : 1.0f}; }
WallPixel tiles(int x, int y) { return {(x / 3 + y / 3) % 2 ? 0.15f : 0.7f, 1}; }
/// Of the light, so that no surface tells of it.
WallPixel ripples(int x, int y) {
  return {0.5f, 1 + 0.4f * std::sin(float(x) * 1.1f) * std::sin(float(y) * 0.9f)};
}

struct NamedWall {
  const char* name;
  Wall wall;
};
const std::vector<NamedWall>& walls() {
  static const std::vector<NamedWall> all{
      {"constant", plain},   {"gradient", light_ramp},   {"bowl", bowl},     {"edge", lit_edge},
      {"line", bright_line}, {"faint line", faint_line}, {"texture", tiles}, {"ripples", ripples}};
  return all;
}

void expect_no_farther(const std::vector<int>& pass_counts) {
  for (const auto& [noise_name, noise] :
       {std::pair("gaussian", gaussian(0.8)), std::pair("faint", gaussian(0.05)),
        std::pair("fireflies", fireflies())})
    for (const NamedWall& w : walls())
      for (const int passes : pass_counts) {
        const Shown noisy = pictured(w.wall, noise, passes);
        const double before = relative_mse(noisy.image, noisy.truth);
        const double after = relative_mse(denoise(noisy.image), noisy.truth);
        // The mean over 9216 pixels has a standard error of 1.5 in a hundred.
        EXPECT_LT(after, 1.03 * before) << w.name << ", " << noise_name << ", " << passes;
      }
}

TEST(DenoisedTruth, IsNeverFartherThanThePictureAsRendered) {
  expect_no_farther(slow_build ? std::vector{4} : std::vector{1, 4, 16, 64});
}
TEST(DenoisedTruth, IsNeverFartherThanThePictureAsRenderedLong) { expect_no_farther({2, 256}); }

TEST(DenoisedTruth, IsFarNearerWhereLightIsSmooth) {
  for (const Wall& wall : {Wall(plain), Wall(light_ramp), Wall(tiles)})
    for (const int passes : slow_build ? std::vector{2} : std::vector{1, 2, 4, 16}) {
      const Shown noisy = pictured(wall, gaussian(0.8), passes);
      const double before = relative_mse(noisy.image, noisy.truth);
      EXPECT_LT(relative_mse(denoise(noisy.image), noisy.truth), before / 10) << passes;
    }
}

/// Beside an edge that noise does not hide, and on it.
TEST(DenoisedTruth, EdgesOfTheLightStay) {
  for (const int passes : slow_build ? std::vector{16} : std::vector{4, 16, 64}) {
    const Shown noisy = pictured(
        [](int x, int) {
          return WallPixel{0.5f, x < wall_side / 2 ? 1.0f : 0.2f};
        },
        gaussian(0.5), passes);
    const Image smooth = denoise(noisy.image);
    const auto near_it = [](int x) { return x >= wall_side / 2 - 2 && x < wall_side / 2 + 2; };
    EXPECT_LT(relative_mse(smooth, noisy.truth, near_it),
              0.5 * relative_mse(noisy.image, noisy.truth, near_it))
        << passes;
    double left = 0, right = 0;
    for (int y = 0; y < wall_side; ++y) {
      left += double(smooth.at(wall_side / 2 - 1, y, 1)) / wall_side;
      right += double(smooth.at(wall_side / 2, y, 1)) / wall_side;
    }
    EXPECT_NEAR(left, 0.5, 0.05) << passes;
    EXPECT_NEAR(right, 0.1, 0.05) << passes;
  }
}

TEST(DenoisedTruth, LinesOfLightStay) {
  const Shown noisy = pictured(bright_line, gaussian(0.5), 16);
  const Image smooth = denoise(noisy.image);
  double mean = 0;
  for (int y = 0; y < wall_side; ++y) mean += double(smooth.at(wall_side / 2, y, 1)) / wall_side;
  // The line is 2 beside 0.5: nine tenths of that are there.
  EXPECT_GT(mean, 0.5 + 0.9 * 1.5);
  EXPECT_LT(mean, 2.05);
}

/// No light is lost where single paths bring much of it.
TEST(DenoisedTruth, FirefliesKeepTheirLight) {
  const Shown noisy = pictured(plain, fireflies(), 16);
  const Image smooth = denoise(noisy.image);
  double before = 0, after = 0;
  for (const float value : noisy.image.channel(1))
    before += double(value) / (wall_side * wall_side);
  for (const float value : smooth.channel(1)) after += double(value) / (wall_side * wall_side);
  EXPECT_NEAR(after, before, 0.02 * before);
}

TEST(DenoisedTruth, AnyNumberOfThreadsGivesTheSameBits) {
  const Shown noisy = pictured(ripples, gaussian(0.8), 16);
  const auto by = [&](int threads) {
    Image result;
    with_threads(threads, [&] { result = denoise(noisy.image); });
    return result;
  };
  const Image one = by(1), three = by(3);
  for (int c = 0; c < one.channel_count(); ++c)
    EXPECT_TRUE(std::ranges::equal(one.channel(c), three.channel(c))) << one.channel_names()[c];
}

/// Halves that tell nothing, or what cannot be.
TEST(DenoisedTruth, OddHalvesMakeNoOddPictures) {
  for (const auto& [name, value] :
       {std::pair("odd.share", 0.0f), std::pair("odd.share", 1.0f), std::pair("odd.share", -3.0f),
        std::pair("odd.share", 1e-30f), std::pair("odd.direct", -1.0f),
        std::pair("odd.direct", 1e30f), std::pair("odd.direct", std::nanf(""))}) {
    Image image = pictured(plain, gaussian(0.8), 16).image;
    const auto values = image.channel(image.find_channel(name));
    std::fill(values.begin(), values.end(), value);
    const Image smooth = denoise(image);
    for (const char* channel : {"R", "G", "B", "denoised_error.G"}) {
      if (smooth.find_channel(channel) < 0) continue;
      for (const float v : smooth.channel(smooth.find_channel(channel)))
        ASSERT_TRUE(std::isfinite(v)) << name << value << channel;
    }
  }
}

/// Halves need not have as many passes: regions have more of their own.
TEST(DenoisedTruth, HalvesMayHaveOtherShares) {
  Shown noisy = pictured(plain, gaussian(0.8), 16);
  const double before = relative_mse(noisy.image, noisy.truth);
  const int share = noisy.image.find_channel("odd.share");
  const int odd = noisy.image.find_channel("odd.direct");
  std::mt19937 generator(7);
  for (int y = 0; y < wall_side; ++y)
    for (int x = wall_side / 2; x < wall_side; ++x) {
      // Three quarters of the passes, with the noise that goes with them.
      const double mean = double(noisy.image.at(x, y, 1));
      noisy.image.at(x, y, share) = 0.75f;
      noisy.image.at(x, y, odd) =
          float(mean + std::normal_distribution<double>(
                           0, 0.4 * std::sqrt(1 / 12.0 - 1 / 16.0))(generator));
    }
  EXPECT_LT(relative_mse(denoise(noisy.image), noisy.truth), before / 10);
}

/// Share of the pixels whose error, times 1.96, holds the truth.
double share_held(const Image& image, const std::vector<double>& truth) {
  int held = 0;
  const int error = image.find_channel("denoised_error.G");
  for (int y = 0; y < wall_side; ++y)
    for (int x = 0; x < wall_side; ++x)
      held += std::abs(double(image.at(x, y, 1)) - truth[size_t(y) * wall_side + size_t(x)]) <=
              1.96 * double(image.at(x, y, error));
  return double(held) / (wall_side * wall_side);
}

/// Of normal noise 0.95 would be right. Where light varies smoothly the bias that is left is as
/// fine as what tells of it.
TEST(DenoisedTruth, IsHeldByTheErrorOfThePicture) {
  for (const NamedWall& w : walls())
    for (const int passes : slow_build ? std::vector{4} : std::vector{2, 4, 16, 64}) {
      const Shown noisy = pictured(w.wall, gaussian(0.8), passes);
      const double held = share_held(denoise(noisy.image), noisy.truth);
      EXPECT_GT(held, 0.75) << w.name << ", " << passes;
      if (std::string(w.name) == "constant" || std::string(w.name) == "texture") {
        EXPECT_GT(held, 0.92) << w.name << ", " << passes;
      }
    }
}

}  // namespace
}  // namespace kaustik
