// Lines through grids in pieces, against the grid itself.

#include "kaustik/volume/grid_crossing.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

using Filter = GridVolume::Filter;

/// 40 × 33 × 17 values that differ by place; a corner is empty.
VolumeSamples rough_samples() {
  VolumeSamples samples{{40, 33, 17}, 1, {}, {}};
  for (int z = 0; z < 17; ++z)
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 40; ++x) {
        const uint64_t place = uint64_t(x + 40 * (y + 33 * z));
        const float value = Sampler(hash_mix(71, place), 0).next_1d();
        samples.values.push_back(x > 15 && y > 15 ? 0 : float(x) / 40 + value);
      }
  return samples;
}

struct CrossedLine {
  Vec3f origin, direction;
  float to;
};
std::vector<CrossedLine> crossed_lines(const Transform& placed) {
  std::vector<CrossedLine> lines;
  for (int i = 0; i < 100; ++i) {
    Sampler sampler(hash_mix(72, uint64_t(i)), 0);
    const Vec2f xy = sampler.next_2d(), z = sampler.next_2d();
    const Vec3f at = Vec3f(xy.x, xy.y, z.x), along = square_to_sphere(sampler.next_2d());
    for (const auto& [back, to] : {std::pair(0.0f, infinity), {2.0f, 2.2f}, {3.0f, infinity}})
      lines.push_back({placed.point(at - along * back), placed.vector(along), to});
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f along(0, 0, 0), at(0.4f, 0.3f, 0.6f);
      along[axis] = sign;
      lines.push_back({placed.point(at - along * 2.0f), placed.vector(along), infinity});
    }
  lines.push_back({placed.point({3, 3, 3}), placed.vector({1, 0, 0}), infinity});
  return lines;
}

TEST(GridCrossing, PiecesMakeUpTheLine) {
  const Transform placed = Transform::translate({50, -20, 7}) * Transform::rotate({1, 2, 3}, 40) *
                           Transform::scale({2, 2, 2});
  for (const Filter filter : {Filter::trilinear, Filter::nearest}) {
    const GridVolume grid(rough_samples(), filter, GridVolume::Wrap::clamp, placed);
    int pieces = 0;
    for (const CrossedLine& line : crossed_lines(placed)) {
      GridCrossing crossing(grid, line.origin, line.direction, line.to);
      GridCrossing::Piece piece{};
      double sum = 0;
      for (float end = 0; crossing.next(piece); end = piece.end, ++pieces) {
        ASSERT_GE(piece.begin, end);
        ASSERT_GT(piece.end, piece.begin);
        ASSERT_LE(crossing.distance(piece.end), line.to * 1.00001f);
        const float integral = crossing.integral(piece), length = piece.end - piece.begin;
        sum += double(integral);
        EXPECT_GE(integral, 0.999f * piece.least * length - 1e-6f);
        EXPECT_LE(integral, 1.001f * piece.largest * length + 1e-6f);
        const GridVolume::Reach reach = crossing.reach(piece, 0.5f * integral);
        if (integral > 1e-3f) {
          ASSERT_TRUE(reach.is_reached);
          const float from = crossing.distance(piece.begin);
          EXPECT_NEAR(
              grid.integral(line.origin, line.direction, from, crossing.distance(reach.distance)),
              0.5f * integral, 1e-3f);
        }
        EXPECT_FALSE(crossing.reach(piece, 1.01f * integral + 1e-3f).is_reached);
      }
      EXPECT_NEAR(sum, double(grid.integral(line.origin, line.direction, 0, line.to)), 2e-4);
    }
    EXPECT_GT(pieces, 500);
  }
}

/// Bounds are those of the region: what lies between samples of neighbouring regions included.
TEST(GridCrossing, BoundsHoldForTheValues) {
  int close = 0;
  const GridVolume grid(rough_samples(), Filter::trilinear, GridVolume::Wrap::repeat, Transform());
  for (const CrossedLine& line : crossed_lines(Transform())) {
    GridCrossing crossing(grid, line.origin, line.direction, line.to);
    GridCrossing::Piece piece{};
    while (crossing.next(piece)) {
      for (int i = 0; i < 20; ++i) {
        const float place = piece.begin + (piece.end - piece.begin) * (float(i) + 0.5f) / 20;
        const float value = grid.value(line.origin + line.direction * crossing.distance(place), 0);
        ASSERT_GE(value, piece.least - 2e-4f);
        ASSERT_LE(value, piece.largest + 2e-4f);
        close += value > 0.8f * piece.largest;
      }
    }
  }
  EXPECT_GT(close, 50) << "bounds that nothing comes near";
}

/// Over all numbers that choose among them, and then what they leave is spread evenly.
TEST(GridCrossing, SamplesHaveTheValueForTheirMean) {
  constexpr int count = 1 << 14;
  for (const Filter filter : {Filter::trilinear, Filter::nearest}) {
    const GridVolume grid(rough_samples(), filter, GridVolume::Wrap::repeat, Transform());
    const CrossedLine line = crossed_lines(Transform()).front();
    GridCrossing crossing(grid, line.origin, line.direction, line.to);
    GridCrossing::Piece piece{};
    int differ = 0;
    while (crossing.next(piece)) {
      const float place = 0.5f * (piece.begin + piece.end);
      double sum = 0, sum_of_low = 0;  // of all samples, and of those that leave a number below ½
      std::vector<double> left_in(8, 0.0);
      float u_of_first = 0;
      const float first = *crossing.sample(place, u_of_first);
      for (int i = 0; i < count; ++i) {
        float u = (float(i) + 0.5f) / count;
        const float sample = *crossing.sample(place, u);
        sum += double(sample);
        if (u < 0.5f) sum_of_low += double(sample);
        differ += sample != first;
        ASSERT_GE(u, 0);
        ASSERT_LT(u, 1);
        ++left_in[size_t(u * 8)];
      }
      const Vec3f at = line.origin + line.direction * crossing.distance(place);
      EXPECT_NEAR(sum / count, double(grid.value(at, 0)), 2e-3);
      // What is left knows nothing of the sample.
      EXPECT_NEAR(sum_of_low / count, 0.5 * sum / count, 2e-3);
      for (const double in_bin : left_in) EXPECT_NEAR(in_bin / count, 1.0 / 8, 2e-3);
    }
    EXPECT_EQ(differ > 0, filter == Filter::trilinear);
  }
}

TEST(GridCrossing, SkipsWhatIsEmpty) {
  VolumeSamples samples{{64, 1, 1}, 1, std::vector<float>(64, 0.0f), {}};
  samples.values[40] = 2;
  const GridVolume grid(samples, Filter::nearest, GridVolume::Wrap::clamp, Transform());
  GridCrossing crossing(grid, {-1, 0.5f, 0.5f}, {1, 0, 0}, infinity);
  GridCrossing::Piece piece{};
  ASSERT_TRUE(crossing.next(piece));
  EXPECT_FLOAT_EQ(crossing.distance(piece.begin), 1.5f);
  EXPECT_FLOAT_EQ(crossing.distance(piece.end), 1.75f);
  EXPECT_FLOAT_EQ(crossing.integral(piece), 2.0f / 64);
  EXPECT_EQ(piece.largest, 2);
  EXPECT_FALSE(crossing.next(piece));
}

/// The density that is taken out of a coloured grid has bounds of its own.
TEST(GridCrossing, KnowsTheBoundsOfASeparatedDensity) {
  VolumeSamples samples{{20, 1, 1}, 3, {}, {}};
  for (int x = 0; x < 20; ++x)
    for (const float part : {0.5f, 0.25f, 1.0f}) samples.values.push_back(part * float(x + 1));
  const GridVolume colored(samples, Filter::nearest, GridVolume::Wrap::clamp, Transform());
  const auto parts = colored.separated();
  ASSERT_TRUE(parts);
  GridCrossing crossing(parts->density, {-1, 0.5f, 0.5f}, {1, 0, 0}, infinity);
  GridCrossing::Piece piece{};
  ASSERT_TRUE(crossing.next(piece));
  EXPECT_EQ(piece.least, 1);
  EXPECT_EQ(piece.largest, 16);
  ASSERT_TRUE(crossing.next(piece));
  EXPECT_EQ(piece.least, 17);
  EXPECT_EQ(piece.largest, 20);
}

}  // namespace
}  // namespace kaustik
