// Films with regions that have passes of their own: the mean, its errors, their intervals.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

#include "kaustik/render/film_errors.h"
#include "tests/render/region_testing.h"
#include "tests/support/same_bits.h"

namespace kaustik {
namespace {

using namespace test;

TEST(Regions, PixelsAreTheMeanOfAllTheirPasses) {
  const FilmAndPasses made = film_with_regions();
  const Image image = made.film.image();
  std::set<size_t> counts;
  for (int y = 0; y < picture_height; ++y)
    for (int x = 0; x < picture_width; ++x) {
      const size_t pixel = size_t(y) * picture_width + size_t(x);
      const auto& values = made.values[pixel];
      counts.insert(values.size());
      ASSERT_EQ(made.film.pass_count(pixel), values.size());
      RunningStatistics all;
      for (const auto& value : values) all.add(double(value.value));
      const Vec3f rgb(channel_at(image, x, y, "R"), channel_at(image, x, y, "G"),
                      channel_at(image, x, y, "B"));
      ASSERT_NEAR(photopic(rgb), all.mean(), 1e-5) << x << ", " << y;
      ASSERT_NEAR(channel_at(image, x, y, "depth.Z"), channel_at(image, x, y, "G"), 1e-5);
      ASSERT_EQ(float(made.film.total(pixel, 1) / double(values.size())), rgb.y);
      // Each replicate has at most a pass or two.
      const KnownLuminance known = FilmErrors(made.film).known(PixelRegion{x, y, 1, 1});
      ASSERT_NEAR(known.mean, all.mean(), 1e-5);
    }
  EXPECT_EQ(counts, (std::set<size_t>{5, 8, 12, 15}));
}

TEST(Regions, OutsideOfThemNoBitIsAnother) {
  const FilmAndPasses made = film_with_regions();
  FilmAndPasses plain;
  MadeUpPasses passes(1);
  for (uint32_t i = 0; i < 5; ++i)
    plain.add_whole(i, passes.next(size_t(picture_width) * picture_height));
  const Image image = made.film.image(), expected = plain.film.image();
  ASSERT_EQ(image.channel_names(), expected.channel_names());
  size_t changed = 0;
  for (int c = 0; c < image.channel_count(); ++c) {
    // Errors go by the pixels around, too.
    const bool is_error = image.channel_names()[size_t(c)].starts_with("error");
    for (int y = 0; y < picture_height; ++y)
      for (int x = 0; x < picture_width; ++x) {
        const int reach = is_error ? 2 : 0;
        const PixelRegion around{x - reach, y - reach, 2 * reach + 1, 2 * reach + 1};
        if (around.meets(first_region) || around.meets(second_region))
          changed += image.at(x, y, c) != expected.at(x, y, c) ? 1 : 0;
        else
          ASSERT_EQ(image.at(x, y, c), expected.at(x, y, c)) << x << ", " << y;
      }
  }
  EXPECT_GT(changed, size_t(first_region.pixel_count()));
}

/// Of a region that lies on four parts with other passes each, whose replicates share their noise.
TEST(Regions, ErrorsOfAMeanAcrossBordersComeFromItsReplicates) {
  const FilmAndPasses made = film_with_regions();
  const PixelRegion asked{4, 2, 20, 12};
  // The mean is a weighted sum of all values; what a replicate is off by is its share of it.
  std::array<double, replicate_count> off{};
  double mean = 0;
  for (int y = asked.y; y < asked.y + asked.height; ++y)
    for (int x = asked.x; x < asked.x + asked.width; ++x) {
      const auto& values = made.values[size_t(y) * picture_width + size_t(x)];
      for (const auto& value : values)
        mean += double(value.value) / double(values.size()) / double(asked.pixel_count());
    }
  for (const size_t count : {5u, 8u, 12u, 15u}) {
    double sum = 0, squares = 0;
    size_t pixels = 0;
    std::array<double, replicate_count> sums{}, passes{};
    for (int y = asked.y; y < asked.y + asked.height; ++y)
      for (int x = asked.x; x < asked.x + asked.width; ++x) {
        const auto& values = made.values[size_t(y) * picture_width + size_t(x)];
        if (values.size() != count) continue;
        ++pixels;
        passes = {};
        for (const auto& value : values) {
          sums[value.replicate] += double(value.value);
          passes[value.replicate] += 1;
          sum += double(value.value);
        }
      }
    ASSERT_GT(pixels, 0u);
    const double n = double(count);
    for (const double of_replicate : passes) squares += of_replicate * of_replicate / (n * n);
    const double scale = count == 5 ? 5.0 / 4 : 1 / (1 - squares);
    for (size_t r = 0; r < replicate_count; ++r)
      off[r] +=
          std::sqrt(scale) * (sums[r] - passes[r] * sum / n) / n / double(asked.pixel_count());
  }
  double variance = 0;
  for (const double of_replicate : off) variance += of_replicate * of_replicate;
  const KnownLuminance known = FilmErrors(made.film).known(asked);
  EXPECT_NEAR(known.mean, mean, 1e-6);
  EXPECT_NEAR(known.deviation, std::sqrt(variance), 1e-6);
  EXPECT_GE(known.freedom, 4);
  EXPECT_LE(known.freedom, 15);
}

struct Held {
  int pixels = 0, means = 0, apart = 0, pictures = 0;
};

/// How many intervals hold the truth, which is 3 (and half of that in red).
Held intervals_that_hold(int seeds, float shared, uint32_t whole, uint32_t regional) {
  constexpr int side = 9;
  constexpr PixelRegion inside{3, 2, 5, 7}, across{1, 1, 8, 6};
  const double truth = double(photopic(Vec3f(4.5f, 3, 3.125f)));
  Held held;
  for (int seed = 0; seed < seeds; ++seed) {
    Film film(settings_of_film(side, side), {ComponentSet::all()});
    MadeUpPasses passes(uint32_t(seed) + 77, shared);
    for (uint32_t i = 0; i < whole; ++i)
      film.add_pass(pass_of(passes.next(size_t(side) * side), {side, side}), i);
    for (uint32_t i = 0; i < regional; ++i)
      add_regional(film, inside, passes.next(size_t(inside.pixel_count())), whole);
    const FilmErrors errors(film);
    const auto holds = [&](const ConfidenceInterval& interval) {
      return std::fabs(interval.mean - truth) <= interval.half_width ? 1 : 0;
    };
    held.pixels += holds(errors.known(size_t{5} * side + 5).interval());
    const KnownLuminance mean = errors.known(across);
    held.means += holds(mean.interval());
    held.pictures += std::fabs(errors.known(PixelRegion{0, 0, side, side}).mean - truth) <=
                             film.mean_error() * errors.known(PixelRegion{0, 0, side, side}).mean
                         ? 1
                         : 0;
    // As if the region were independent of what is around it.
    const double share = double(5 * 5) / double(across.pixel_count());
    const double within = errors.known(PixelRegion{3, 2, 5, 5}).deviation * share;
    const double around = errors.known(PixelRegion{1, 1, 8, 1}).deviation * (1 - share);
    held.apart +=
        holds({mean.mean, student_t_quantile(0.975, mean.freedom) * std::hypot(within, around)});
  }
  return held;
}

void expect_coverage(int seeds, double least, double most) {
  const auto share = [&](int held) { return double(held) / seeds; };
  for (const auto& [whole, regional, shared] :
       {std::tuple{8u, 8u, 1.0f}, std::tuple{4u, 28u, 0.0f}, std::tuple{20u, 5u, 1.0f}}) {
    const Held held = intervals_that_hold(seeds, shared, whole, regional);
    std::printf(
        "  %u passes and %u of the region, shared noise %.0f: pixel %.3f, mean across %.3f, "
        "picture %.3f\n",
        whole, regional, double(shared), share(held.pixels), share(held.means),
        share(held.pictures));
    for (const int each : {held.pixels, held.means, held.pictures}) {
      EXPECT_GE(share(each), least);
      EXPECT_LE(share(each), most);
    }
  }
  // What shares its noise is not independent: that must show.
  if (slow_build) return;
  const double apart = share(intervals_that_hold(seeds, 3, 8, 8).apart);
  std::printf("  as if parts were independent %.3f\n", apart);
  EXPECT_LT(apart, least);
}

/// Three standard deviations of the counts.
TEST(Regions, IntervalsHoldTheTruthAcrossBorders) {
  if (slow_build)
    expect_coverage(40, 0.84, 1);
  else
    expect_coverage(250, 0.908, 0.992);
}

/// As of pictures: docs/theory/errors.md.
TEST(Regions, IntervalsHoldTheTruthAcrossBordersLong) { expect_coverage(3000, 0.93, 0.97); }

TEST(Regions, ThatCoverThePictureMakeItsErrorKnown) {
  for (const int height : {picture_height, picture_height - 1}) {
    FilmAndPasses all;
    MadeUpPasses passes(1);
    all.add_whole(0, passes.next(size_t(picture_width) * picture_height));
    const PixelRegion region{0, 0, picture_width, height};
    for (int i = 0; i < 15; ++i) all.add(region, passes.next(size_t(region.pixel_count())), 1);
    EXPECT_EQ(std::isfinite(all.film.mean_error()), height == picture_height);
    EXPECT_EQ(std::isfinite(all.film.picture_error()), height == picture_height);
  }
}

}  // namespace
}  // namespace kaustik
