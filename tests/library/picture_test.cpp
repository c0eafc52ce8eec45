// Pictures of hosts: planes, files, displays, and estimates with their errors.

#include "kaustik/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "rooms.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::library_test {
namespace {

using test::TemporaryFolder;

SessionSettings by_paths(uint32_t count, uint32_t samples, uint64_t seed = 0) {
  SessionSettings settings = passes(count, samples);
  settings.integrator = "path";
  settings.seed = seed;
  return settings;
}

TEST(LibraryPicture, PlanesAndCopies) {
  const Picture picture = rendered(room("path", 7, 5), by_paths(2, 2));
  EXPECT_EQ(picture.width(), 7);
  EXPECT_EQ(picture.height(), 5);
  EXPECT_EQ(picture.passes(), 2u);
  EXPECT_FALSE(picture.is_incomplete());
  const std::vector<std::string> layers = picture.layers();
  EXPECT_EQ(layers[0], "");
  for (const char* layer : {"direct", "albedo", "error"})
    EXPECT_TRUE(std::find(layers.begin(), layers.end(), layer) != layers.end()) << layer;
  for (const std::string layer : {"", "direct", "albedo"}) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    // Upside down, with a fourth float per pixel and a gap after each row.
    constexpr size_t row = 7 * 4 + 3;
    std::vector<float> target(row * 5, -1);
    picture.copy_rgb(target.data() + row * 4, 4 * sizeof(float), -ptrdiff_t(row * sizeof(float)),
                     layer);
    std::vector<float> packed(7 * 5 * 3);
    picture.copy_rgb(packed.data(), 0, 0, layer);
    for (size_t y = 0; y < 5; ++y)
      for (size_t x = 0; x < 7; ++x)
        for (size_t c = 0; c < 3; ++c) {
          const float expected = picture.plane(prefix + std::string(1, "RGB"[c]))[y * 7 + x];
          EXPECT_EQ(packed[(y * 7 + x) * 3 + c], expected);
          EXPECT_EQ(target[(4 - y) * row + x * 4 + c], expected);
          EXPECT_EQ(target[(4 - y) * row + x * 4 + 3], -1);
        }
  }
  EXPECT_EQ(error_of([&] { picture.plane("indigo"); }).kind(), ErrorKind::input);
  EXPECT_FALSE(picture.has_channel("indigo"));
  EXPECT_TRUE(picture.has_channel("error.G"));
  std::vector<float> unused(7 * 5 * 3);
  EXPECT_THROW(picture.copy_rgb(unused.data(), 0, 0, "indigo"), Error);
  EXPECT_THROW(picture.copy_rgb(nullptr), Error);
  SessionSettings plain = by_paths(2, 2);
  plain.layers = false;
  const Picture flat = rendered(room("path", 7, 5), plain);
  EXPECT_FALSE(flat.has_channel("direct.R"));
  EXPECT_GT(flat.pixel(3, 3).standard_error, 0) << "estimates need no layers";
}

TEST(LibraryPicture, GoesToFilesAndDisplays) {
  const TemporaryFolder folder;
  const Picture picture = rendered(half_sky(8, 6), by_paths(2, 16));
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tif", "a.png", "a.jpg", "a.ppm"}) {
    picture.write(folder.path(name));
    EXPECT_GT(std::filesystem::file_size(folder.path(name)), 100u) << name;
  }
  for (const char* name : {"a.txt", "no folder/a.png", ""})
    EXPECT_THROW(picture.write(folder.path(name)), Error) << name;
  WriteSettings settings;
  settings.tone.name = "linear";
  settings.tone.parameters = {"exposure=1"};
  picture.write(folder.path("b.png"), settings);
  settings.tone.parameters = {"contrast=1"};
  EXPECT_THROW(picture.write(folder.path("c.png"), settings), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.path("c.png")));
  settings = {};
  settings.jpeg_quality = 0;
  EXPECT_THROW(picture.write(folder.path("c.jpg"), settings), Error);
  settings = {};
  settings.layer = "indigo";
  EXPECT_THROW(picture.write(folder.path("c.pfm"), settings), Error);

  const ShownPicture shown = picture.tonemap({"linear", {}});
  EXPECT_EQ(shown.width, 8);
  EXPECT_EQ(shown.rgb.size(), size_t{8} * 6 * 3);
  // Grey.
  EXPECT_NEAR(shown.rgb[0], shown.rgb[1], 2);
  EXPECT_GT(shown.rgb[0], 20);
  EXPECT_EQ(picture.tonemap().rgb.size(), shown.rgb.size());
  EXPECT_EQ(picture.tonemap({}, "albedo").rgb.size(), shown.rgb.size());
  EXPECT_THROW(picture.tonemap({"no such", {}}), Error);
  EXPECT_THROW(picture.tonemap({}, "indigo"), Error);
}

/// Half of a sky of 1 is reflected. Over seeds the interval of 90 % holds that as often as it
/// should (a binomial of 60 leaves 46 … 60 with a chance of 0.2 %), and a wrong truth hardly ever.
TEST(LibraryPicture, IntervalsHoldTheTruth) {
  int held = 0, held_wrong = 0, held_pixel = 0;
  constexpr int seeds = 60;
  for (int seed = 0; seed < seeds; ++seed) {
    const Picture picture = rendered(half_sky(6, 4), by_paths(16, 1, uint64_t(seed)));
    const Estimate region = picture.region({1, 1, 4, 2});
    const Interval interval = region.interval(0.9);
    held += interval.low <= 0.5 && 0.5 <= interval.high;
    held_wrong += interval.low <= 0.55 && 0.55 <= interval.high;
    const Interval pixel = picture.pixel(2, 2).interval(0.9);
    held_pixel += pixel.low <= 0.5 && 0.5 <= pixel.high;
  }
  EXPECT_GE(held, 46);
  EXPECT_LT(held_wrong, 20);
  EXPECT_GE(held_pixel, 46);
}

TEST(LibraryPicture, EstimatesOfPixelsAndRegionsAgree) {
  const Picture picture = rendered(half_sky(5, 4), by_paths(8, 2));
  double sum = 0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) sum += picture.pixel(x, y).value;
  EXPECT_NEAR(picture.mean().value, sum / 20, 1e-9);
  EXPECT_NEAR(picture.region({3, 2, 1, 1}).value, picture.pixel(3, 2).value, 1e-9);
  EXPECT_NEAR(picture.pixel(3, 2).value, double(picture.plane("G")[2 * 5 + 3]), 1e-6);
  EXPECT_LT(picture.mean().standard_error, picture.pixel(3, 2).standard_error);
  EXPECT_EQ(picture.mean().degrees_of_freedom, 7);
  EXPECT_GT(picture.relative_error(), 0);
  const Estimate e = picture.mean();
  const Interval narrow = e.interval(0.5), wide = e.interval(0.99);
  EXPECT_LT(wide.low, narrow.low);
  EXPECT_NEAR((narrow.low + narrow.high) / 2, e.value, 1e-12);
  for (const double chance : {0.0, 1.0, -1.0, std::nan("")})
    EXPECT_THROW(e.interval(chance), Error) << chance;
  for (const Region& region :
       {Region{0, 0, 6, 4}, Region{-1, 0, 1, 1}, Region{0, 0, 0, 1}, Region{4, 3, 1, 2},
        Region{INT32_MAX, 0, 1, 1}, Region{0, 0, INT32_MAX, INT32_MAX}})
    EXPECT_THROW(picture.region(region), Error);
  EXPECT_THROW(picture.pixel(5, 0), Error);
  EXPECT_THROW(picture.pixel(0, -1), Error);
}

/// What is known of a bias, and how well, widens an interval by what Student's t says of both.
TEST(LibraryPicture, BiasWidensAnInterval) {
  const auto half_width = [](const Estimate& estimate) {
    const Interval interval = estimate.interval();
    return (interval.high - interval.low) / 2;
  };
  const Estimate noise{1, 0.3, 0, 15, 0}, both{1, 0.3, 0, 15, 0.4}, biased{1, 0.3, 5, 15, 0.4};
  EXPECT_NEAR(half_width(noise), 0.3 * 2.1314, 1e-4);
  EXPECT_NEAR(half_width(both), 0.5 * 2.1314, 1e-4);
  // Of one side alone, where the bias is far larger than what is not known.
  EXPECT_NEAR(half_width(biased), 5 + 0.5 * 1.7531, 1e-4);
}

TEST(LibraryPicture, OnePassTellsNothingOfItsError) {
  const Picture picture = rendered(half_sky(5, 4), by_paths(1, 4));
  EXPECT_TRUE(std::isinf(picture.mean().standard_error));
  EXPECT_TRUE(std::isinf(picture.pixel(0, 0).interval().high));
  EXPECT_TRUE(std::isinf(picture.relative_error()));
  Session session(half_sky(5, 4), by_paths(2, 4));
  session.run();
  const Picture without = session.snapshot().value();
  EXPECT_FALSE(without.has_errors());
  EXPECT_EQ(error_of([&] { without.pixel(0, 0); }).kind(), ErrorKind::misuse);
  EXPECT_EQ(values(without), values(session.picture()));
}

}  // namespace
}  // namespace kaustik::library_test
