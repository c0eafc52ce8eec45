// What the footprint does to textures: means stay, noise falls as it must, details fade.

#include <gtest/gtest.h>

#include <random>

#include "kaustik/base/statistics.h"
#include "kaustik/base/wave_field.h"
#include "kaustik/material/mip_pyramid.h"
#include "kaustik/material/noise.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

std::vector<Spectrum> random_texels(int width, int height, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Spectrum> texels;
  for (int i = 0; i < width * height; ++i)
    texels.push_back(spectrum_from_rgb(float(random() & 0xffff) / 65536, 0.5f, 0));
  return texels;
}

double mean_of(const std::vector<Spectrum>& texels) {
  double sum = 0;
  for (const Spectrum& t : texels) sum += double(t[0]);
  return sum / double(texels.size());
}

TEST(MipPyramid, IsExactAtTexelCentresForAPoint) {
  const auto texels = random_texels(7, 5, 1);
  const MipPyramid pyramid(7, 5, texels, Wrap::repeat);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x) {
      const Vec2f uv((float(x) + 0.5f) / 7, (float(y) + 0.5f) / 5);
      EXPECT_NEAR(pyramid.filtered(uv, {0, 0})[0], texels[size_t(y * 7 + x)][0], 2e-6f);
      EXPECT_EQ(pyramid.nearest(uv), texels[size_t(y * 7 + x)]);
    }
}

TEST(MipPyramid, KeepsTheMeanOfAnySize) {
  for (const Vec2i& size :
       {Vec2i(1, 1), Vec2i(64, 64), Vec2i(37, 21), Vec2i(1, 100), Vec2i(5, 1)}) {
    const auto texels = random_texels(size.x, size.y, 2);
    const MipPyramid pyramid(size.x, size.y, texels, Wrap::repeat);
    EXPECT_NEAR(double(pyramid.mean()[0]), mean_of(texels), 1e-5);
    for (const float u : {0.1f, 0.77f, -3.2f})
      EXPECT_NEAR(double(pyramid.filtered({u, 1 - u}, {4, 4})[0]), mean_of(texels), 1e-5);
    // Over any footprint the mean over the square is the picture's.
    for (const float texels_wide : {0.0f, 1.5f, 3.0f, 11.0f}) {
      const Vec2f width(texels_wide / float(size.x), texels_wide / float(size.y));
      double sum = 0;
      constexpr int n = 240;
      for (int i = 0; i < n * n; ++i)
        sum += double(
            pyramid.filtered({(float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n}, width)[0]);
      EXPECT_NEAR(sum / (n * n), mean_of(texels), 4e-3) << size.x << " " << texels_wide;
    }
  }
}

/// Variance of lookups over that of the texels.
double remaining_variance(const MipPyramid& pyramid, float texels_wide, double variance) {
  RunningStatistics values;
  std::mt19937 random(5);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
  for (int i = 0; i < 200000; ++i)
    values.add(
        double(pyramid.filtered({uniform(), uniform()}, Vec2f(texels_wide, texels_wide) / 512)[0]));
  return values.variance() / variance;
}

// White noise: each reduction averages four texels, and bilinear interpolation at a random place
// leaves (2/3)² of the variance.
TEST(MipPyramid, VarianceFallsWithTheAreaOfTheFootprint) {
  const auto texels = random_texels(512, 512, 3);
  const MipPyramid pyramid(512, 512, texels, Wrap::repeat);
  const double variance = 1.0 / 12, bilinear = 4.0 / 9;
  for (int level = 0; level < 4; ++level) {
    const double expected = bilinear * std::pow(0.25, level);
    const double found = remaining_variance(pyramid, float(1 << level), variance);
    EXPECT_NEAR(found / expected, 1, 0.05) << level;
    // The twin: a footprint that is not looked at leaves all of it.
    if (level > 0) {
      EXPECT_GT(remaining_variance(pyramid, 0, variance) / expected, 3);
    }
  }
}

TEST(MipPyramid, SurvivesAnyFootprint) {
  const MipPyramid pyramid(3, 2, random_texels(3, 2, 4), Wrap::mirror);
  for (const float width : {1e-30f, 1e30f, infinity})
    for (const float u : {-1e30f, 0.0f, 1e30f}) {
      const Spectrum s = pyramid.filtered({u, 0.5f}, {width, 0});
      EXPECT_TRUE(s.is_finite());
      EXPECT_GE(s[0], 0);
      EXPECT_LE(s[0], 1);
    }
}

TEST(Noise, GradientIsTheSlope) {
  std::mt19937 random(6);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f * 20 - 10; };
  const FractalNoise fractal{4, 0.6f, 9};
  for (int i = 0; i < 2000; ++i) {
    const Vec3f p(uniform(), uniform(), uniform());
    for (const float width : {0.0f, 0.4f}) {
      const NoiseValue at = fractal(p, width);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3f a = p, b = p;
        a[axis] -= 2e-3f;
        b[axis] += 2e-3f;
        const float slope =
            (fractal(b, width).value - fractal(a, width).value) / (b[axis] - a[axis]);
        EXPECT_NEAR(slope, at.gradient[axis], 0.02f);
      }
    }
  }
}

TEST(Noise, HasMeanZeroAndNoPeriod) {
  RunningStatistics values, products;
  std::mt19937 random(7);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
  for (int i = 0; i < 100000; ++i) {
    const Vec3f p = Vec3f(uniform(), uniform(), uniform()) * 200;
    const float value = gradient_noise(p, 3).value;
    EXPECT_LE(std::fabs(value), 1.1f);
    values.add(double(value));
    products.add(double(value * gradient_noise(p + Vec3f(256, 0, 0), 3).value));
  }
  EXPECT_GT(z_test_p_value(values, 0), 1e-3);
  EXPECT_GT(values.variance(), 0.04);
  EXPECT_LT(std::fabs(products.mean()), 0.05 * values.variance());
}

TEST(Noise, IsTheSameAloneAndInThrees) {
  RunningStatistics products[3];
  std::mt19937 random(11);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
  for (uint32_t i = 0; i < 100000; ++i) {
    const Vec3f p = Vec3f(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f) * 200;
    const float value = gradient_noise(p, i).value;
    EXPECT_EQ(gradient_noise_value(p, i), value);
    const Vec3f three = noise_vector(p, i);
    EXPECT_EQ(three.x, value);
    for (int axis = 0; axis < 3; ++axis)
      products[axis].add(double(three[axis] * three[(axis + 1) % 3]));
  }
  for (const RunningStatistics& product : products) EXPECT_GT(z_test_p_value(product, 0), 1e-4);
}

TEST(Noise, HasTheGradientOfItsValue) {
  std::mt19937 random(5);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
  constexpr float step = 1.0f / 256;
  for (uint32_t i = 0; i < 10000; ++i) {
    const Vec3f p = Vec3f(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f) * 8;
    const Vec3f gradient = gradient_noise(p, i).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f a = p, b = p;
      a[axis] -= step;
      b[axis] += step;
      const float difference = gradient_noise_value(b, i) - gradient_noise_value(a, i);
      EXPECT_NEAR(difference / (b[axis] - a[axis]), gradient[axis], 1e-3f);
    }
  }
}

TEST(WaveField, HasTheHeightThatWasAskedFor) {
  WaveSettings settings;
  settings.amplitude = 0.02f;
  const WaveField waves(settings);
  RunningStatistics squares;
  std::mt19937 random(8);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f * 400; };
  for (int i = 0; i < 200000; ++i) {
    const float h = waves.height({uniform(), uniform()});
    EXPECT_LE(std::fabs(h), waves.largest_height());
    squares.add(double(h * h));
  }
  EXPECT_NEAR(squares.mean(), 0.0004, 0.0004 * 0.02);
}

TEST(WaveField, SlopeIsThatOfTheHeight) {
  const WaveField waves{WaveSettings()};
  for (int i = 0; i < 500; ++i) {
    const Vec2f p(0.37f * float(i % 23), 0.21f * float(i / 23));
    const float step = 1e-3f;
    for (const float width : {0.0f, 0.1f}) {
      const Vec2f slope = waves.slope(p, width);
      EXPECT_NEAR(
          slope.x,
          (waves.height(p + Vec2f(step, 0), width) - waves.height(p - Vec2f(step, 0), width)) /
              (2 * step),
          2e-3f);
      EXPECT_NEAR(
          slope.y,
          (waves.height(p + Vec2f(0, step), width) - waves.height(p - Vec2f(0, step), width)) /
              (2 * step),
          2e-3f);
    }
  }
}

TEST(WaveField, FiltersAsAMeanOverADisk) {
  const WaveField waves{WaveSettings()};
  RunningStatistics error, whole;
  const float width = 0.08f;
  for (int i = 0; i < 100; ++i) {
    const Vec2f p(0.41f * float(i % 10), 0.29f * float(i / 10));
    double sum = 0;
    constexpr int n = 400;
    for (int j = 0; j < n; ++j) {
      const float r = 0.5f * width * std::sqrt((float(j) + 0.5f) / n), phi = 2.39996323f * float(j);
      sum += double(waves.height(p + Vec2f(std::cos(phi), std::sin(phi)) * r));
    }
    error.add(std::pow(sum / n - double(waves.height(p, width)), 2));
    whole.add(std::pow(double(waves.height(p)) - double(waves.height(p, width)), 2));
  }
  // What a Gaussian does instead of a disk is small beside what filtering does.
  EXPECT_LT(error.mean(), 0.05 * whole.mean());
}

// ---- every procedural texture ----

struct Named {
  std::string name;
  std::shared_ptr<const Texture> texture;
  float scale;  ///< of its largest features, m
};
std::vector<Named> procedural_textures() {
  return {
      {"noise", make_texture("noise"), 0.1f},
      {"marble", make_texture("marble"), 0.4f},
      {"wood", make_texture("wood"), 0.1f},
      {"planks", make_texture("wood", {property("plank_width", 0.1)}), 0.5f},
      {"tiles", make_texture("tiles"), 0.2f},
      {"bricks", make_texture("tiles", {property("offset", 0.5), property("joint", 0.02)}), 0.2f},
      {"waves", make_texture("waves"), 0.5f}};
}

TextureCoordinates somewhere(std::mt19937& random, float extent, float width) {
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
  TextureCoordinates at;
  at.position = Vec3f(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f) * extent;
  at.uv = Vec2f(uniform(), uniform()) * extent;
  at.normal = {0, 0, 1};
  at.width = width;
  at.uv_width = {width, width};
  return at;
}

TEST(ProceduralTextures, TellTheirMeanAndMaximum) {
  for (const Named& t : procedural_textures()) {
    SCOPED_TRACE(t.name);
    std::mt19937 random(10);
    RunningStatistics green;
    for (int i = 0; i < 20000; ++i) {
      const Spectrum s = t.texture->eval(somewhere(random, 40 * t.scale, 0), {});
      ASSERT_TRUE(s.is_finite());
      for (int lane = 0; lane < 3; ++lane) ASSERT_GE(s[lane], 0);
      ASSERT_LE(s.max_lane(), t.texture->maximum() + 1e-6f);
      green.add(double(s[1]));
    }
    EXPECT_NEAR(green.mean(), double(t.texture->mean()[1]), 0.02) << green.mean();
    EXPECT_GT(green.variance(), 1e-5) << "the texture shows nothing";
  }
}

TEST(ProceduralTextures, FadeToTheirMean) {
  for (const Named& t : procedural_textures()) {
    SCOPED_TRACE(t.name);
    RunningStatistics fine, middle, coarse;
    std::mt19937 random(11);
    for (int i = 0; i < 4000; ++i) {
      TextureCoordinates at = somewhere(random, 40 * t.scale, 0);
      fine.add(double(t.texture->eval(at, {})[1]));
      at.width = 0.5f * t.scale;
      at.uv_width = {at.width, at.width};
      middle.add(double(t.texture->eval(at, {})[1]));
      at.width = 20 * t.scale;
      at.uv_width = {at.width, at.width};
      coarse.add(double(t.texture->eval(at, {})[1]));
    }
    EXPECT_LT(middle.variance(), fine.variance());
    EXPECT_LT(coarse.variance(), 0.02 * fine.variance());
    EXPECT_NEAR(coarse.mean(), fine.mean(), 0.03);
  }
}

TEST(ProceduralTextures, FilterAsAMeanOfManyPoints) {
  // Tiles are filtered exactly along each axis; half a joint's width about an edge.
  const auto tiles = make_texture("tiles", {property("variation", 0.0)});
  std::mt19937 random(12);
  const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
  for (int i = 0; i < 40; ++i) {
    TextureCoordinates at = somewhere(random, 2, 0.05f);
    const float filtered = tiles->eval(at, {})[1];
    RunningStatistics points;
    TextureCoordinates p = at;
    p.width = 0;
    for (int j = 0; j < 20000; ++j) {
      p.position = at.position + Vec3f(uniform() - 0.5f, uniform() - 0.5f, 0) * 0.05f;
      points.add(double(tiles->eval(p, {})[1]));
    }
    EXPECT_NEAR(double(filtered), points.mean(), 5 * points.standard_error() + 1e-5);
  }
}

TEST(ProceduralTextures, SlopesAreThoseOfAHeight) {
  // Around a small loop the height comes back to where it was: the gradient is one of something.
  for (const Named& t : procedural_textures()) {
    if (t.name == "tiles" || t.name == "bricks") continue;  // with steps where tiles end
    std::mt19937 random(13);
    for (int i = 0; i < 200; ++i) {
      TextureCoordinates at = somewhere(random, 10 * t.scale, 0.02f * t.scale);
      const Vec3f middle = at.position;
      double around = 0, length = 0;
      constexpr int n = 64;
      const float r = 0.01f * t.scale;
      for (int j = 0; j < n; ++j) {
        const float phi = 2 * pi * float(j) / n;
        at.position = middle + Vec3f(std::cos(phi), std::sin(phi), 0) * r;
        const Vec3f tangent(-std::sin(phi), std::cos(phi), 0);
        const double rise = double(dot(t.texture->height_gradient(at).position, tangent));
        around += rise;
        length += std::fabs(rise);
      }
      EXPECT_LE(std::fabs(around), 0.2 * length + 1e-3) << t.name;
    }
  }
}

TEST(ProceduralTextures, AreTheSameOnEveryMachineAndSeedsDiffer) {
  for (const char* type : {"noise", "marble", "wood", "tiles", "waves"}) {
    const auto a = make_texture(type), b = make_texture(type),
               other = make_texture(type, {property("seed", int64_t(5))});
    std::mt19937 random(14);
    int differ = 0;
    for (int i = 0; i < 100; ++i) {
      const TextureCoordinates at = somewhere(random, 3, 0);
      EXPECT_EQ(a->eval(at, {}), b->eval(at, {}));
      differ += a->eval(at, {}) == other->eval(at, {}) ? 0 : 1;
    }
    EXPECT_GT(differ, 50) << type;
  }
}

TEST(ProceduralTextures, SurviveAnyCoordinates) {
  for (const Named& t : procedural_textures())
    for (const float far : {1e9f, -1e30f, 1e38f})
      for (const float width : {0.0f, 1e-20f, 1e20f}) {
        TextureCoordinates at;
        at.uv = {far, -far};
        at.position = {far, 0.3f, far};
        at.normal = {0, 0, 1};
        at.width = width;
        at.uv_width = {width, width};
        EXPECT_TRUE(t.texture->eval(at, {}).is_finite()) << t.name << far << " " << width;
      }
}

TEST(ProceduralTextures, ArePlacedByToWorld) {
  const Transform placed = Transform::translate({1, 2, 3}) * Transform::scale({2, 2, 2});
  for (const char* type : {"noise", "marble", "wood", "tiles", "waves"}) {
    const auto plain = make_texture(type);
    const auto moved = make_texture(type, {property("to_world", placed)});
    TextureCoordinates at;
    at.position = {0.11f, 0.23f, 0.31f};
    at.normal = {0, 0, 1};
    at.width = 0.001f;
    TextureCoordinates there = at;
    there.position = placed.point(at.position);
    there.width = 0.002f;
    for (int lane = 0; lane < 3; ++lane)
      EXPECT_NEAR(plain->eval(at, {})[lane], moved->eval(there, {})[lane], 1e-4f) << type;
    // Twice as large at the same height: half as steep.
    const Vec3f a = plain->height_gradient(at).position, b = moved->height_gradient(there).position;
    EXPECT_LT(length(a * 0.5f - b), 1e-3f + 0.02f * length(a)) << type;
  }
}

TEST(Checkerboard, FiltersExactly) {
  const auto board =
      make_texture("checkerboard", {property("color0", 1.0), property("color1", 0.0)});
  TextureCoordinates at;
  at.uv = {0.5f, 0.25f};  // on an edge
  at.uv_width = {0.2f, 0.01f};
  EXPECT_NEAR(board->eval(at, {})[0], 0.5f, 1e-5f);
  at.uv = {0.45f, 0.25f};
  EXPECT_NEAR(board->eval(at, {})[0], 0.75f, 1e-5f);
  at.uv_width = {16, 16};
  EXPECT_NEAR(board->eval(at, {})[0], 0.5f, 1e-3f);
}

}  // namespace
}  // namespace kaustik
