#include "kaustik/image/metrics.h"

#include <limits>
#include <random>

#include "tests/image/support.h"

namespace kaustik {
namespace {

using testing::expect_input_error;

Image filled(int width, int height, const Vec3f& colour) {
  Image image(width, height, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c)
    std::fill(image.channel(c).begin(), image.channel(c).end(), colour[c]);
  return image;
}

TEST(Metrics, equal_images_have_no_error) {
  const Image image = testing::test_picture(20, 10, 4);
  const ImageComparison result = compare_images(image, image);
  EXPECT_EQ(result.mse, 0);
  EXPECT_EQ(result.relative_mse, 0);
  EXPECT_EQ(result.relative_mse_trimmed, 0);
  EXPECT_EQ(result.mean_ratio, Vec3d(1, 1, 1));
  EXPECT_EQ(result.pixel_count, 200u);
}

TEST(Metrics, values_computed_by_hand) {
  Image image = filled(2, 1, {1, 2, 0}), reference = filled(2, 1, {1, 1, 0});
  image.at(1, 0, 0) = 3;
  // Squares: pixel 0: 0, 1, 0; pixel 1: 4, 1, 0.
  const ImageComparison result = compare_images(image, reference);
  EXPECT_NEAR(result.mse, 6.0 / 6, 1e-12);
  EXPECT_NEAR(result.relative_mse, 6.0 / 6 / 1.01, 1e-12);
  EXPECT_EQ(result.relative_mse_trimmed, result.relative_mse);  // 0.1 % of 2 pixels is none
  EXPECT_EQ(result.mean_ratio, Vec3d(2, 2, 1));
  EXPECT_EQ(result.mean, Vec3d(2, 2, 0));
  EXPECT_EQ(result.reference_mean, Vec3d(1, 1, 0));
}

TEST(Metrics, black_references_count_by_the_offset) {
  const ImageComparison result =
      compare_images(filled(3, 3, {0.1f, 0.1f, 0.1f}), filled(3, 3, {0, 0, 0}));
  EXPECT_NEAR(result.relative_mse, 1, 1e-6);
  EXPECT_EQ(result.mean_ratio.x, std::numeric_limits<double>::infinity());
}

TEST(Metrics, trimming_drops_the_worst_thousandth_and_no_more) {
  const Image reference = filled(50, 40, {1, 1, 1});
  Image image = filled(50, 40, {1.1f, 1.1f, 1.1f});
  // Two fireflies among 2000 pixels: both go.
  image.at(7, 7, 0) = 1000;
  image.at(9, 30, 2) = 500;
  const double rest = 0.01 / 1.01;
  EXPECT_NEAR(compare_images(image, reference).relative_mse_trimmed, rest, 1e-6);
  EXPECT_GT(compare_images(image, reference).relative_mse, 100);
  // A third one stays.
  image.at(11, 11, 1) = 100;
  EXPECT_GT(compare_images(image, reference).relative_mse_trimmed, 1);
}

TEST(Metrics, a_planted_error_of_two_percent_shows) {
  const Image reference = testing::test_picture(100, 50, 1);
  Image image = reference;
  for (float& value : image.channel(1)) value *= 1.02f;
  const ImageComparison result = compare_images(image, reference);
  EXPECT_NEAR(result.mean_ratio.x, 1, 1e-12);
  EXPECT_NEAR(result.mean_ratio.y, 1.02, 1e-6);
  EXPECT_NEAR(result.mean_ratio.z, 1, 1e-12);
  EXPECT_GT(result.relative_mse, 0);
  EXPECT_LT(result.relative_mse, 0.02 * 0.02 / 3);
}

// A reference of independent noise of known strength: its comparison with the truth is what it says
// of itself.
TEST(Metrics, a_reference_tells_its_own_error) {
  const Image truth = testing::test_picture(100, 100, 1);
  Image reference(100, 100, {"R", "G", "B", "error.R", "error.G", "error.B"});
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int c = 0; c < 3; ++c)
    for (size_t i = 0; i < reference.pixel_count(); ++i) {
      const float value = truth.channel(c)[i], deviation = 0.002f * float(c + 1);
      reference.channel(c)[i] = value + deviation * normal(random);
      reference.channel(c + 3)[i] = deviation;
    }
  const double own = own_relative_mse(reference);
  EXPECT_NEAR(own / compare_images(truth, reference).relative_mse_trimmed, 1, 0.05);
  expect_input_error([&] { own_relative_mse(truth); }, "error");
}

TEST(Metrics, non_finite_pixels_are_counted_and_left_out) {
  const Image reference = filled(10, 10, {1, 1, 1});
  Image image = reference;
  image.at(3, 3, 0) = std::numeric_limits<float>::quiet_NaN();
  image.at(4, 4, 1) = std::numeric_limits<float>::infinity();
  const ImageComparison result = compare_images(image, reference);
  EXPECT_EQ(result.non_finite_pixels, 2u);
  EXPECT_EQ(result.pixel_count, 98u);
  EXPECT_EQ(result.mse, 0);
  EXPECT_EQ(result.mean, Vec3d(1, 1, 1));
}

TEST(Metrics, wrong_pairs_are_refused) {
  expect_input_error([] { compare_images(filled(2, 3, Vec3f(1)), filled(3, 2, Vec3f(1))); },
                     "2 x 3");
  expect_input_error([] { difference_image(filled(2, 3, Vec3f(1)), filled(3, 2, Vec3f(1))); },
                     "2 x 3");
  const Image nan = filled(2, 2, Vec3f(std::numeric_limits<float>::quiet_NaN()));
  expect_input_error([&] { compare_images(nan, nan); }, "finite");
  expect_input_error([&] { difference_image(nan, nan, 0); }, "scale");
  expect_input_error([&] { compare_images(nan, nan, "direct"); }, "direct");
}

TEST(Metrics, difference_pictures) {
  const Image reference = filled(5, 1, Vec3f(0.9f));
  Image image = reference;
  for (int c = 0; c < 3; ++c) {
    image.at(1, 0, c) = 1.4f;   // + 0.5
    image.at(2, 0, c) = 0.65f;  // − 0.25
    image.at(3, 0, c) = 100;
    image.at(4, 0, c) = infinity;
  }
  const Image picture = difference_image(image, reference);
  const RgbView rgb = rgb_view(picture);
  const Vec3f wanted[] = {{1, 1, 1}, {1, 0.5f, 0.5f}, {0.75f, 0.75f, 1}, {1, 0, 0}, {0, 1, 0}};
  for (size_t i = 0; i < 5; ++i)
    EXPECT_TRUE(rgb[i].equalWithAbsError(wanted[i], 1e-5f)) << i << ": " << rgb[i];
  const Image fine = difference_image(image, reference, 0.5f);
  EXPECT_TRUE(rgb_view(fine)[2].equalWithAbsError(Vec3f(0.5f, 0.5f, 1), 1e-5f));
}

}  // namespace
}  // namespace kaustik
