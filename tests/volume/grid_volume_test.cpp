// Grids against brute force: values by their definition, integrals by sums of many values.

#include "kaustik/volume/grid_volume.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

using Filter = GridVolume::Filter;
using Wrap = GridVolume::Wrap;

double number(uint64_t key, int i) {
  return double(Sampler(hash_mix(key, uint64_t(i)), 0).next_1d());
}
Vec3f direction(uint64_t key, int i) {
  return square_to_sphere(Sampler(hash_mix(key, uint64_t(i)), 1).next_2d());
}

/// Random values; most of those of the upper half are zero, so that some bricks are empty.
VolumeSamples random_samples(const std::array<int, 3>& size, int channels = 1) {
  VolumeSamples samples{size, channels, {}, {}};
  const size_t count = size_t(size[0]) * size_t(size[1]) * size_t(size[2]) * size_t(channels);
  for (size_t i = 0; i < count; ++i)
    samples.values.push_back(i > count / 2 && i % 977 > 3 ? 0.0f : float(number(3, int(i))));
  return samples;
}

/// The value at `p` of the cube, in double precision and straight from the samples.
double brute_value(const VolumeSamples& samples, Filter filter, Wrap wrap, const Vec3d& p,
                   int channel = 0) {
  const auto sample = [&](const std::array<int, 3>& at) {
    size_t index = 0;
    for (const int axis : {2, 1, 0}) {
      const int n = samples.size[size_t(axis)];
      int i = at[size_t(axis)];
      if (wrap == Wrap::clamp) i = std::clamp(i, 0, n - 1);
      if (wrap == Wrap::repeat) i = (i % n + n) % n;
      if (wrap == Wrap::mirror) {
        i = (i % (2 * n) + 2 * n) % (2 * n);
        if (i >= n) i = 2 * n - 1 - i;
      }
      index = index * size_t(n) + size_t(i);
    }
    return double(samples.values[index * size_t(samples.channels) + size_t(channel)]);
  };
  std::array<int, 3> first{};
  double share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double at = p[axis] * samples.size[size_t(axis)] - (filter == Filter::nearest ? 0 : 0.5);
    first[size_t(axis)] = int(std::floor(at));
    share[axis] = filter == Filter::nearest ? 0 : at - std::floor(at);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> at = first;
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = corner >> axis & 1;
      weight *= bit ? share[axis] : 1 - share[axis];
      at[size_t(axis)] += bit;
    }
    if (weight > 0) sum += weight * sample(at);
  }
  return sum;
}

TEST(GridVolume, HasItsValuesEverywhere) {
  for (const std::array<int, 3>& size :
       {std::array{1, 1, 1}, std::array{7, 8, 9}, std::array{17, 3, 16}})
    for (const int channels : {1, 3})
      for (const Filter filter : {Filter::trilinear, Filter::nearest})
        for (const Wrap wrap : {Wrap::clamp, Wrap::repeat, Wrap::mirror}) {
          const VolumeSamples samples = random_samples(size, channels);
          const GridVolume grid(samples, filter, wrap, Transform());
          for (int i = 0; i < 300; ++i) {
            const Vec3d p(number(5, i) * 6 - 2.5, number(6, i) * 6 - 2.5, number(7, i) * 6 - 2.5);
            const int channel = i % channels;
            ASSERT_NEAR(grid.value(Vec3f(p), channel),
                        brute_value(samples, filter, wrap, Vec3d(Vec3f(p)), channel),
                        filter == Filter::nearest ? 0 : 1e-5)
                << i << " wrap " << int(wrap) << " size " << size[0];
          }
        }
}

TEST(GridVolume, EndsAtItsBox) {
  const GridVolume grid({{2, 2, 2}, 1, {1, 1, 1, 1, 1, 1, 1, 1}, {}}, Filter::trilinear,
                        Wrap::clamp, Transform::translate({1, 2, 3}));
  EXPECT_EQ(grid.inside({1.5f, 2.5f, 3.5f}), 1);
  EXPECT_EQ(grid.inside({1, 2, 3}), 1);
  for (const Vec3f& p : {Vec3f(0.99f, 2.5f, 3.5f), Vec3f(1.5f, 3.01f, 3.5f), Vec3f(1.5f, 2.5f, 9)})
    EXPECT_EQ(grid.inside(p), 0);
  EXPECT_EQ(grid.value({9, 9, 9}, 0), 1);
  EXPECT_FLOAT_EQ(grid.integral({-5, 2.5f, 3.5f}, {1, 0, 0}, 0, infinity), 1);
  EXPECT_FLOAT_EQ(grid.integral({-5, 2.5f, 3.5f}, {2, 0, 0}, 0, infinity), 0.5f);
  EXPECT_FLOAT_EQ(grid.integral({1.25f, 2.5f, 3.5f}, {0, 0, 1}, 0.125f, 0.25f), 0.125f);
  EXPECT_EQ(grid.integral({-5, 2.5f, 3.5f}, {-1, 0, 0}, 0, infinity), 0);
  EXPECT_EQ(grid.integral({-5, 1.5f, 3.5f}, {1, 0, 0}, 0, infinity), 0);
  EXPECT_EQ(grid.integral({-5, 2.5f, 3.5f}, {1, 0, 0}, 0, 6), 0);
}

struct Line {
  Vec3f origin, direction;
  float from, to;
};

/// Lines that come from outside or begin within, that run along axes, edges of cells and diagonals.
std::vector<Line> some_lines() {
  std::vector<Line> lines;
  for (int i = 0; i < 60; ++i) {
    const Vec3f at(float(number(11, i)), float(number(12, i)), float(number(13, i)));
    const Vec3f along = direction(14, i) * (i % 3 == 0 ? 2.5f : 1.0f);
    lines.push_back({at, along, 0, infinity});
    lines.push_back({at - along * 2, along, 0, 3});
    lines.push_back({at - along * 2, along, 1.75f, 2.25f});
  }
  for (const float s : {-1.0f, 1.0f})
    for (int axis = 0; axis < 3; ++axis)
      for (const float at : {0.5f, 0.25f, 0.0f, 1.0f, 0.3f}) {
        Line line{{at, at, at}, {0, 0, 0}, 0, infinity};
        line.direction[axis] = s;
        line.origin[axis] = 0.5f - 2 * s;
        lines.push_back(line);
      }
  lines.push_back({{-1, -1, -1}, {1, 1, 1}, 0, infinity});
  lines.push_back({{2, -1, 0.5f}, {-1, 1, 0}, 0, infinity});
  lines.push_back({{0.5f, 0.5f, 0.5f}, {1e-12f, 1, 0}, 0, infinity});
  return lines;
}

double brute_integral(const VolumeSamples& samples, Filter filter, const Line& line) {
  const double from = double(line.from), to = std::min(double(line.to), 4.0);
  const int steps = 20'000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const Vec3d p =
        Vec3d(line.origin) + Vec3d(line.direction) * (from + (to - from) * (i + 0.5) / steps);
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) inside = inside && p[axis] >= 0 && p[axis] <= 1;
    if (inside) sum += brute_value(samples, filter, Wrap::clamp, p);
  }
  return sum * (to - from) / steps;
}

TEST(GridVolume, IntegratesAlongLines) {
  for (const std::array<int, 3>& size : {std::array{1, 1, 1}, std::array{9, 17, 24}})
    for (const Filter filter : {Filter::trilinear, Filter::nearest}) {
      const VolumeSamples samples = random_samples(size);
      const GridVolume grid(samples, filter, Wrap::clamp, Transform());
      for (const Line& line : some_lines()) {
        const double expected = brute_integral(samples, filter, line);
        // Along the faces of cells the nearest sample is either, and at the box's edge all or none.
        const bool is_on_faces = filter == Filter::nearest || line.origin.x == 0 ||
                                 line.origin.y == 0 || line.origin.x == 1 || line.origin.y == 1;
        if (is_on_faces && line.direction.x * line.direction.y * line.direction.z == 0) continue;
        // By steps the ends of the box are known to 1e-4.
        ASSERT_NEAR(double(grid.integral(line.origin, line.direction, line.from, line.to)),
                    expected, 3e-4)
            << line.origin << " + t " << line.direction << " size " << size[0];
      }
    }
}

/// Where the value is linear in space its integral has a closed form; samples reach from the middle
/// of the first cell to that of the last.
TEST(GridVolume, IntegratesALinearValueExactly) {
  VolumeSamples samples{{40, 10, 20}, 1, {}, {}};
  const auto linear = [](const Vec3d& p) { return 1 + 2 * p.x + 0.5 * p.y + 3 * p.z; };
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 40; ++x)
        samples.values.push_back(float(linear({(x + 0.5) / 40, (y + 0.5) / 10, (z + 0.5) / 20})));
  const GridVolume grid(samples, Filter::trilinear, Wrap::clamp, Transform());
  for (int i = 0; i < 200; ++i) {
    const auto inner = [&](uint64_t key, double margin) {
      return margin + (1 - 2 * margin) * number(key, i);
    };
    const Vec3f a(Vec3d(inner(21, 0.0125), inner(22, 0.05), inner(23, 0.025)));
    const Vec3f b(Vec3d(inner(24, 0.0125), inner(25, 0.05), inner(26, 0.025)));
    const Vec3d middle = (Vec3d(a) + Vec3d(b)) * 0.5;
    EXPECT_NEAR(double(grid.integral(a, b - a, 0, 1)) / linear(middle), 1, 2e-6) << i;
  }
}

/// Rotated, sheared, mirrored and far away: what a line gathers in the world is what it gathers in
/// the cube.
TEST(GridVolume, LiesWhereItIsPlaced) {
  const double rows[4][4] = {{1, 0.3, 0, 0}, {0, 1, 0, 0}, {0.2, 0, 1, 0}, {0, 0, 0, 1}};
  const Transform placed = Transform::translate({50, -20, 7}) * Transform::rotate({1, 2, 3}, 40) *
                           Transform(rows) * Transform::scale({2, -3, 0.5});
  const VolumeSamples samples = random_samples({9, 8, 11});
  const GridVolume there(samples, Filter::trilinear, Wrap::clamp, placed);
  const GridVolume here(samples, Filter::trilinear, Wrap::clamp, Transform());
  for (const Line& line : some_lines()) {
    const Vec3f origin = placed.point(line.origin), along = placed.vector(line.direction);
    const float expected = here.integral(line.origin, line.direction, line.from, line.to);
    if (line.direction.x * line.direction.y * line.direction.z == 0) continue;
    EXPECT_NEAR(there.integral(origin, along, line.from, line.to), expected, 2e-4);
    const Vec3f p = line.origin + line.direction * 0.3f;
    EXPECT_NEAR(there.value(placed.point(p), 0), here.value(p, 0), 2e-4);
  }
}

TEST(GridVolume, ReachesWhatIntegralsSay) {
  for (const Filter filter : {Filter::trilinear, Filter::nearest}) {
    const GridVolume grid(random_samples({9, 17, 24}), filter, Wrap::clamp, Transform());
    int reached = 0;
    for (const Line& line : some_lines()) {
      const float to = std::min(line.to, 100.0f);
      const float whole = grid.integral(line.origin, line.direction, 0, to);
      const GridVolume::Reach beyond =
          grid.reach(line.origin, line.direction, to, whole * 1.0001f + 1e-6f);
      EXPECT_FALSE(beyond.is_reached);
      EXPECT_FLOAT_EQ(beyond.integral, whole);
      for (const float share : {0.0f, 1e-6f, 0.1f, 0.5f, 0.9f, 0.999f}) {
        if (!(whole > 1e-4f)) continue;
        const auto found = grid.reach(line.origin, line.direction, to, share * whole);
        ASSERT_TRUE(found.is_reached) << share;
        const float t = found.distance;
        EXPECT_TRUE(t >= 0 && t <= to * 1.000001f);
        EXPECT_NEAR(grid.integral(line.origin, line.direction, 0, t), share * whole,
                    2e-5f * whole + 1e-6f);
        ++reached;
      }
    }
    EXPECT_GT(reached, 500);
  }
}

TEST(GridVolume, MeasuresWhatIntegralsSay) {
  const GridVolume grid(random_samples({9, 17, 24}), Filter::trilinear, Wrap::clamp, Transform());
  for (const Line& line : some_lines()) {
    std::vector<LineKnot> knots;
    grid.measure(line.origin, line.direction, line.to, knots);
    for (size_t i = 0; i < knots.size(); ++i) {
      if (i > 0) {
        EXPECT_GE(knots[i].distance, knots[i - 1].distance);
      }
      EXPECT_NEAR(knots[i].integral,
                  grid.integral(line.origin, line.direction, 0, knots[i].distance), 2e-5f);
    }
  }
}

TEST(GridVolume, StopsWhereItHasEnough) {
  const GridVolume grid(random_samples({9, 17, 24}), Filter::trilinear, Wrap::clamp, Transform());
  const Vec3f origin(-1, -1, -1), along(1, 1, 1);
  const float whole = grid.integral(origin, along, 0, infinity);
  const float some = grid.integral(origin, along, 0, infinity, 0.1f * whole);
  EXPECT_GT(some, 0.1f * whole);
  EXPECT_LT(some, 0.5f * whole);
}

TEST(GridVolume, SeparatesWhatIsOneColour) {
  VolumeSamples samples{{2, 1, 2}, 3, {}, {}};
  for (const float density : {0.5f, 0.0f, 2.0f, 1.0f})
    for (const float color : {0.8f, 0.4f, 0.2f}) samples.values.push_back(density * color);
  const GridVolume grid(samples, Filter::trilinear, Wrap::clamp, Transform());
  const auto parts = grid.separated();
  ASSERT_TRUE(parts);
  EXPECT_LT(max_abs(parts->color - Vec3f(1, 0.5f, 0.25f)), 1e-6f);
  EXPECT_EQ(parts->density.channels(), 1);
  const Vec3f p(0.4f, 0.5f, 0.6f);
  EXPECT_NEAR(parts->density.inside(p), grid.value(p, 0), 1e-6f);
  EXPECT_GT(parts->density.integral({-1, 0.5f, 0.5f}, {1, 0, 0}, 0, infinity), 0.1f);
  samples.values[4] = 0.1f;
  EXPECT_FALSE(GridVolume(samples, Filter::trilinear, Wrap::clamp, Transform()).separated());
}

}  // namespace
}  // namespace kaustik
