#include "kaustik/transport/splat_buffer.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "kaustik/scene/filter_kinds.h"

namespace kaustik {
namespace {

constexpr int size = 16;

FilmSettings film_with(const PixelFilter& filter) {
  FilmSettings film;
  film.size = film.crop_size = {size, size};
  film.filter = filter;
  return film;
}

/// Sum over pixels of what one splat of value 1 leaves.
double total(const FilmSettings& film, const Vec2f& raster) {
  SplatBuffer buffer(film, ComponentSet::all());
  buffer.add(raster, Component::direct, Spectrum(1, 1, 1, 0), {});
  double sum = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) sum += double(buffer.value(x, y, Component::direct)[1]);
  return sum;
}

std::vector<Vec2f> inner_points(uint32_t count) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> uniform(6, 10);
  std::vector<Vec2f> points;
  for (uint32_t i = 0; i < count; ++i) points.emplace_back(uniform(generator), uniform(generator));
  return points;
}

TEST(SplatBuffer, WeightsOfPartitioningFiltersSumToOne) {
  for (const FilmSettings& film : {film_with(box_filter(0.5f)), film_with(box_filter(1.5f)),
                                   film_with(tent_filter(1)), film_with(tent_filter(2))})
    for (const Vec2f& point : inner_points(200)) EXPECT_NEAR(total(film, point), 1, 1e-5);
}

// A Gaussian's samples at integer distances sum to 1 only in the mean over positions; the ripple is
// 2 exp(−2π²σ²) along each axis (Poisson's sum).
TEST(SplatBuffer, WeightsOfGaussiansSumToOneInTheMean) {
  const FilmSettings film = film_with(gaussian_filter(0.5f, 2));
  constexpr int steps = 32;
  double sum = 0;
  for (int y = 0; y < steps; ++y)
    for (int x = 0; x < steps; ++x) {
      const double t = total(film, {8 + (float(x) + 0.5f) / steps, 8 + (float(y) + 0.5f) / steps});
      EXPECT_NEAR(t, 1, 0.033);
      sum += t;
    }
  EXPECT_NEAR(sum / (steps * steps), 1, 1e-4);
}

TEST(SplatBuffer, WeightsFollowTheFilter) {
  const FilmSettings film = film_with(tent_filter(1));
  SplatBuffer buffer(film, ComponentSet::all());
  buffer.add({5.75f, 3.5f}, Component::caustic, {2, 4, 8, 0}, {});
  EXPECT_FLOAT_EQ(buffer.value(5, 3, Component::caustic)[0], 2 * 0.75f);
  EXPECT_FLOAT_EQ(buffer.value(6, 3, Component::caustic)[0], 2 * 0.25f);
  EXPECT_FLOAT_EQ(buffer.value(5, 3, Component::caustic)[2], 8 * 0.75f);
  EXPECT_EQ(buffer.value(4, 3, Component::caustic)[0], 0);
  EXPECT_EQ(buffer.value(5, 3, Component::direct)[0], 0);
}

TEST(SplatBuffer, EdgesKeepWhatFallsInside) {
  const FilmSettings film = film_with(tent_filter(1));
  EXPECT_NEAR(total(film, {0, 8.5f}), 0.5, 1e-6);  // half of it lies beyond the edge
  EXPECT_NEAR(total(film, {-0.4f, 8.5f}), 0.1, 1e-6);
  EXPECT_EQ(total(film, {-0.6f, 8.5f}), 0);
  EXPECT_NEAR(total(film, {float(size), float(size)}), 0.25, 1e-6);
  for (const float far : {-1e9f, 1e9f}) EXPECT_EQ(total(film, {far, far}), 0);
}

// The buffer is an edge: what comes in lanes is kept as RGB.
TEST(SplatBuffer, TurnsWavelengthsIntoColours) {
  SplatBuffer buffer(film_with(box_filter(0.5f)), ComponentSet::all());
  const Wavelengths four(440, 500, 580, 660);
  const Spectrum lanes(1, 2, 3, 4), rgb = rgb_from_lanes(lanes, four);
  buffer.add({3.5f, 3.5f}, Component::direct, lanes, four);
  for (int lane = 0; lane < 3; ++lane)
    EXPECT_NEAR(buffer.value(3, 3, Component::direct)[lane], rgb[lane], 1e-6f) << lane;
  EXPECT_GT(std::fabs(rgb[0] - lanes[0]), 0.1f);
}

TEST(SplatBuffer, DropsAndCountsWhatIsNotFinite) {
  SplatBuffer buffer(film_with(box_filter(0.5f)), ComponentSet::all());
  buffer.add({3.5f, 3.5f}, Component::direct, Spectrum(infinity, 0, 0, 0), {});
  buffer.add({3.5f, 3.5f}, Component::direct,
             Spectrum(0, std::numeric_limits<float>::quiet_NaN(), 0, 0), {});
  buffer.add({3.5f, 3.5f}, Component::direct, Spectrum(), {});
  EXPECT_EQ(buffer.dropped(), 2u);
  EXPECT_TRUE(buffer.value(3, 3, Component::direct).is_zero());
  buffer.clear();
  EXPECT_EQ(buffer.dropped(), 0u);
}

TEST(SplatBuffer, IgnoresComponentsThatNobodyWants) {
  ComponentSet wanted;
  wanted.add(Component::caustic);
  SplatBuffer buffer(film_with(box_filter(0.5f)), wanted);
  EXPECT_TRUE(buffer.wants(Component::caustic));
  EXPECT_FALSE(buffer.wants(Component::direct));
  buffer.add({3.5f, 3.5f}, Component::direct, Spectrum(1), {});
  buffer.add({3.5f, 3.5f}, Component::caustic, Spectrum(1), {});
  EXPECT_TRUE(buffer.value(3, 3, Component::direct).is_zero());
  EXPECT_FLOAT_EQ(buffer.value(3, 3, Component::caustic)[0], 1);
  buffer.clear();
  EXPECT_TRUE(buffer.value(3, 3, Component::caustic).is_zero());
}

struct Splat {
  Vec2f raster;
  Component component;
  Spectrum value;
};

/// Over a wide range of magnitudes, so that the order would show in floats.
std::vector<Splat> splats(int count) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<float> where(-2, size + 2), exponent(-6, 6);
  std::vector<Splat> list;
  for (int i = 0; i < count; ++i)
    list.push_back({{where(generator), where(generator)},
                    Component(i % component_count),
                    Spectrum(std::pow(10.0f, exponent(generator)), 1, 1e-7f, 0)});
  return list;
}

void expect_same_bits(const SplatBuffer& a, const SplatBuffer& b) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < component_count; ++c)
        ASSERT_EQ(a.value(x, y, Component(c)), b.value(x, y, Component(c)));
}

TEST(SplatBuffer, OrderAndThreadsMakeNoDifference) {
  const FilmSettings film = film_with(gaussian_filter(0.5f, 2));
  const std::vector<Splat> list = splats(5000);
  SplatBuffer forward(film, ComponentSet::all()), backward(film, ComponentSet::all()),
      parallel(film, ComponentSet::all());
  for (const Splat& s : list) forward.add(s.raster, s.component, s.value, {});
  for (auto s = list.rbegin(); s != list.rend(); ++s)
    backward.add(s->raster, s->component, s->value, {});
  {
    std::vector<std::jthread> threads;
    for (size_t t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (size_t i = t; i < list.size(); i += 4)
          parallel.add(list[i].raster, list[i].component, list[i].value, {});
      });
  }
  expect_same_bits(forward, backward);
  expect_same_bits(forward, parallel);
}

/// Numbers of all sizes and both signs, as the film's are; their sum stays in its range.
std::vector<double> splat_numbers(size_t count) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> exponent(-20, 13), uniform(-1, 1);
  std::vector<double> values(count);
  for (double& value : values)
    value = std::copysign(std::pow(10.0, exponent(generator)), uniform(generator));
  return values;
}

TEST(SplatSums, AreThoseOfFixed) {
  SplatSums sums;
  Fixed sum = 0;
  for (const double value : splat_numbers(10000)) {
    sums.add(7, fixed_from(value));
    sum += fixed_from(value);
  }
  EXPECT_TRUE(sums.load(7) == sum);
  EXPECT_TRUE(sums.load(6) == 0 && sums.load(8) == 0);
}

TEST(SplatSums, CarryAndBorrow) {
  SplatSums sums;
  const auto add = [&](double value) {
    sums.add(0, fixed_from(value));
    return double_from(sums.load(0));
  };
  EXPECT_EQ(add(0.75), 0.75);
  EXPECT_EQ(add(0.75), 1.5);
  const size_t small = sums.bytes();
  EXPECT_EQ(add(4294967294), 4294967295.5);
  EXPECT_EQ(sums.bytes(), small);
  EXPECT_EQ(add(0.5), 4294967296.0);
  EXPECT_EQ(sums.bytes(), small + sizeof(uint32_t) * SplatSums::count);
  EXPECT_EQ(add(-4294967296.25), -0.25);
  EXPECT_EQ(add(0.25), 0);
  EXPECT_EQ(add(1e18), 1e18);
  EXPECT_EQ(add(-3e18), -2e18);
}

TEST(SplatSums, ThreadsMakeNoDifference) {
  const std::vector<double> values = splat_numbers(20000);
  Fixed sum = 0;
  for (const double value : values) sum += fixed_from(value);
  for (int round = 0; round < 5; ++round) {
    SplatSums sums;
    {
      std::vector<std::jthread> threads;
      for (size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
          for (size_t i = t; i < values.size(); i += 4) sums.add(1, fixed_from(values[i]));
        });
    }
    EXPECT_TRUE(sums.load(1) == sum);
  }
}

TEST(SplatBuffer, TakesMemoryWhereSomethingHasCome) {
  FilmSettings film = film_with(box_filter(0.5f));
  film.size = film.crop_size = {100, 40};
  SplatBuffer buffer(film, ComponentSet::all());
  const size_t empty = buffer.bytes();
  EXPECT_LT(empty, 1500u);
  buffer.add({90.5f, 20.5f}, Component::caustic, Spectrum(1, 2, 3, 0), {});
  EXPECT_EQ(buffer.bytes(), empty + sizeof(SplatSums));
  buffer.add({85.5f, 17.5f}, Component::caustic, Spectrum(1, 2, 3, 0), {});
  EXPECT_EQ(buffer.bytes(), empty + sizeof(SplatSums));
  buffer.add({90.5f, 20.5f}, Component::direct, Spectrum(1, 2, 3, 0), {});
  buffer.add({0.5f, 0.5f}, Component::direct, Spectrum(4, 5, 6, 0), {});
  EXPECT_EQ(buffer.bytes(), empty + 3 * sizeof(SplatSums));
  const PictureTiles tiles({100, 40});
  buffer.clear(tiles.tile_at(90, 20));
  EXPECT_EQ(buffer.bytes(), empty + sizeof(SplatSums));
  EXPECT_TRUE(buffer.value(90, 20, Component::caustic).is_zero());
  EXPECT_EQ(buffer.value(0, 0, Component::direct), Spectrum(4, 5, 6, 0));
}

}  // namespace
}  // namespace kaustik
