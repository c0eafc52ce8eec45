#include "kaustik/image/vision.h"

#include "kaustik/image/eye_model.h"
#include "kaustik/image/photometry.h"
#include "tests/image/support.h"

namespace kaustik {
namespace {

TEST(Vision, visible_difference_has_the_values_of_its_five_pieces) {
  EXPECT_NEAR(visible_difference(0), 1.3804e-3, 1e-6);  // 10^−2.86
  EXPECT_NEAR(visible_difference(1e-5), 1.3804e-3, 1e-6);
  EXPECT_NEAR(visible_difference(1e-3), 1.8400e-3, 1e-6);  // 0.385^2.18 = 0.12483
  EXPECT_NEAR(visible_difference(0.1), 0.040272, 1e-5);    // 10^−1.395
  EXPECT_NEAR(visible_difference(1), 0.39129, 1e-4);       // 0.65^2.7 = 0.31252
  EXPECT_NEAR(visible_difference(100), 5.5590, 1e-3);      // 10^0.745
}

TEST(Vision, visible_difference_rises_without_gaps) {
  double last = 0;
  for (double x = -6; x < 5; x += 0.001) {
    const double d = visible_difference(std::pow(10, x));
    // The published pieces meet to 3 %; the one of the rods ends a little too high.
    ASSERT_GT(d, last * 0.97);
    if (last > 0) {
      ASSERT_LT(d, last * 1.03);
    }
    last = d;
  }
}

TEST(Vision, acuity) {
  EXPECT_NEAR(visual_acuity(1), 31.53, 0.01);     // 17.25 · atan 0.35 + 25.72
  EXPECT_NEAR(visual_acuity(1000), 49.09, 0.02);  // 17.25 · atan 4.55 + 25.72
  EXPECT_NEAR(visual_acuity(1e-3), 3.01, 0.01);   // 17.25 · atan −3.85 + 25.72
  EXPECT_EQ(visual_acuity(0), visual_acuity(1e-6));
  EXPECT_GT(visual_acuity(0), 0);
}

TEST(Vision, rods_see_blue_and_hardly_red) {
  EXPECT_NEAR(scotopic(Vec3f(1)), 1, 1e-6);
  EXPECT_NEAR(scotopic(Vec3f(3)), 3, 1e-5);
  // Red has XYZ (0.4124, 0.2126, 0.0193): 0.2126 · (1.33 · 1.5624 − 1.68) = 0.0846; white has
  // (0.9505, 1, 1.0891): 1.33 · 3.1979 − 1.68 = 2.5732.
  EXPECT_NEAR(scotopic(Vec3f(1, 0, 0)), 0.0846 / 2.5732, 1e-4);
  // Blue has (0.1805, 0.0722, 0.9505): 0.0722 · (1.33 · 6.6665 − 1.68) = 0.5188.
  EXPECT_NEAR(scotopic(Vec3f(0, 0, 1)), 0.5188 / 2.5732, 2e-4);
  EXPECT_EQ(scotopic(Vec3f(0)), 0);
  EXPECT_EQ(scotopic(Vec3f(-1, 0, 0)), 0);
}

TEST(Vision, colours_fade_between_5_6_and_0_0056_candelas) {
  const Vec3f red(1, 0.1f, 0.1f);
  const Vec3f unit = red / luminance(red);
  EXPECT_EQ(seen_color(unit * 6.0f), unit * 6.0f);
  const Vec3f dark = seen_color(unit * 0.005f);
  EXPECT_EQ(dark.x, dark.y);
  EXPECT_EQ(dark.y, dark.z);
  EXPECT_LT(luminance(dark), 0.005f * 0.6f);  // red becomes nearly black
  const Vec3f white = seen_color(Vec3f(0.001f / white_efficacy));
  EXPECT_NEAR(luminance(white), 0.001f, 1e-8);
  const float middle = (5.6f + 5.6e-3f) / 2;
  EXPECT_NEAR(cone_share(middle), 0.5, 1e-6);
  const Vec3f half = seen_color(unit * middle);
  EXPECT_NEAR(half.x, (unit * middle).x / 2 + scotopic(unit * middle) / 2, 1e-7);
}

/// A picture whose pixels are the cells of `columns` × `rows` degrees.
Picture degrees_picture(int columns, int rows, const std::function<float(int, int)>& grey) {
  Image image(columns, rows, {"Y"});
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) image.at(x, y, 0) = grey(x, y);
  return Picture(image, "", {float(columns), float(rows)});
}

TEST(Veil, an_even_picture_stays_as_it_is) {
  Picture picture = degrees_picture(20, 10, [](int, int) { return 3.0f; });
  const Grid<Vec3f> foveal = foveal_means(picture);
  add_veil(picture, veil(foveal, picture));
  for (const Vec3f& colour : picture.pixels) ASSERT_NEAR(colour.x, 3, 1e-5);
}

TEST(Veil, falls_with_the_square_of_the_angle) {
  // Three cells, one degree apart; weights 1 and 1/4 but for cosines of 1 and 2 degrees.
  const Picture picture = degrees_picture(3, 1, [](int x, int) { return x == 0 ? 100.0f : 8.0f; });
  const Grid<Vec3f> scattered = veil(foveal_means(picture), picture);
  ASSERT_EQ(scattered.cells.size(), 3u);
  EXPECT_NEAR(scattered.cells[0].x, 0.087 * 8, 1e-4);
  EXPECT_NEAR(scattered.cells[1].x, 0.087 * 54, 1e-3);
  EXPECT_NEAR(scattered.cells[2].x, 0.087 * (8 + 100 / 4.0) / 1.25, 5e-3);
}

TEST(Veil, one_cell_has_none_and_large_pictures_are_joined) {
  Picture small = degrees_picture(1, 1, [](int, int) { return 2.0f; });
  add_veil(small, veil(foveal_means(small), small));
  EXPECT_EQ(small.pixels[0].x, 2);
  Image image(400, 300, {"Y"});
  for (float& value : image.channel(0)) value = 1;
  const Picture wide(image, "", {179, 170});
  const Grid<Vec3f> scattered = veil(foveal_means(wide), wide);
  EXPECT_LE(scattered.cells.size(), 12000u);
  for (const Vec3f& colour : scattered.cells) ASSERT_NEAR(colour.x, 0.087, 1e-5);
}

/// Half the difference of the extremes along the middle row of a grating, over its mean.
double contrast_seen(float candelas, int period) {
  constexpr int size = 128;  // over 4°: 32 pixels per degree
  Image image(size, size, {"Y"});
  const float mean = candelas / white_efficacy;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      image.at(x, y, 0) = mean * (1 + 0.5f * std::sin(2 * pi * (float(x) + 0.5f) / float(period)));
  Picture picture(image, "", {4, 4});
  blur_to_acuity(picture, foveal_means(picture));
  float low = infinity, high = -infinity;
  for (int x = size / 4; x < 3 * size / 4; ++x) {
    const float value = picture.pixels[size_t(size / 2 * size + x)].x;
    low = std::min(low, value), high = std::max(high, value);
  }
  return double(high - low) / 2 / double(mean);
}

TEST(Acuity, what_is_too_fine_for_the_light_is_lost) {
  // 1 cd/m²: 31 cycles per degree, finer than the pixels; 0.001 cd/m²: 3.
  EXPECT_NEAR(contrast_seen(1, 4), 0.35, 0.01);  // 8 cycles per degree, as sampled by the pixels
  EXPECT_LT(contrast_seen(0.001f, 4), 0.01);
  EXPECT_GT(contrast_seen(0.001f, 64), 0.4);  // half a cycle per degree
}

TEST(Acuity, bright_pictures_keep_their_bits_and_dark_ones_their_mean) {
  Picture bright = degrees_picture(32, 16, [](int x, int y) { return float(1 + (x + y) % 2); });
  const std::vector<Vec3f> before = bright.pixels;
  blur_to_acuity(bright, foveal_means(bright));
  EXPECT_EQ(bright.pixels, before);

  Image image(64, 64, {"Y"});
  for (float& value : image.channel(0)) value = 1e-6f;
  Picture dark(image, "", {1, 1});
  blur_to_acuity(dark, foveal_means(dark));
  for (const Vec3f& colour : dark.pixels) ASSERT_NEAR(colour.x, 1e-6f, 1e-12f);
}

}  // namespace
}  // namespace kaustik
