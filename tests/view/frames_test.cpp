// Pixels as they are sent.

#include "kaustik/view/frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "kaustik/base/error.h"

namespace kaustik::view {
namespace {

TEST(Frames, KnownCodesOfSharedExponents) {
  EXPECT_EQ(rgb9e5_from({0, 0, 0}) & 0x7ffffffu, 0u);
  // One is 256 · 2^(16 − 24): the largest component has its highest bit set.
  EXPECT_EQ(rgb9e5_from({1, 0, 0}), 16u << 27 | 256u);
  EXPECT_EQ(rgb9e5_from({1, 0.5f, 0.25f}), 16u << 27 | 64u << 18 | 128u << 9 | 256u);
  EXPECT_EQ(rgb9e5_from({65408, 65408, 65408}), 31u << 27 | 511u << 18 | 511u << 9 | 511u);
  EXPECT_EQ(rgb9e5_from({infinity, 0, 0}), 31u << 27 | 511u);
  EXPECT_EQ(rgb9e5_from({-1, std::nanf(""), 1}), 16u << 27 | 256u << 18);
  // Rounding up to 512 units takes the next exponent.
  EXPECT_EQ(color_from_rgb9e5(rgb9e5_from({0.9999f, 0, 0})).x, 1);
}

TEST(Frames, SharedExponentsRoundToHalfAUnit) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> exponent(-30, 15.9f);
  for (int i = 0; i < 20'000; ++i) {
    const Vec3f color(std::exp2(exponent(generator)), std::exp2(exponent(generator)),
                      std::exp2(exponent(generator)));
    const Vec3f back = color_from_rgb9e5(rgb9e5_from(color));
    const float largest = std::max({color.x, color.y, color.z});
    // Nine bits of the largest, or the least exponent's units.
    const float half_unit = std::max(largest / 256, std::ldexp(1.0f, -24)) * 0.5f;
    for (int lane = 0; lane < 3; ++lane)
      ASSERT_NEAR(back[lane], color[lane], half_unit * 1.001f) << color.x << ' ' << color.y;
  }
}

Image ramp(int width, int height) {
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = float(100 * y + 10 * x + c);
  return image;
}

std::vector<float> floats_of(const EncodedFrame& frame) {
  std::vector<float> values(frame.bytes.size() / 4);
  std::memcpy(values.data(), frame.bytes.data(), frame.bytes.size());
  return values;
}

TEST(Frames, FloatsAreThePixels) {
  const EncodedFrame frame = encoded_frame(ramp(3, 2), "", FrameFormat::f32);
  EXPECT_EQ(frame.scale, 1);
  EXPECT_EQ(floats_of(frame), (std::vector<float>{0, 1, 2, 10, 11, 12, 20, 21, 22,  //
                                                  100, 101, 102, 110, 111, 112, 120, 121, 122}));
}

TEST(Frames, ReducedByMeansOfWhatIsThere) {
  const EncodedFrame frame = encoded_frame(ramp(3, 3), "", FrameFormat::f32, 2);
  EXPECT_EQ(frame.width, 2);
  EXPECT_EQ(frame.height, 2);
  const std::vector<float> values = floats_of(frame);
  EXPECT_EQ(values[0], 55);   // 0, 10, 100, 110
  EXPECT_EQ(values[3], 70);   // 20, 120
  EXPECT_EQ(values[6], 205);  // 200, 210
  EXPECT_EQ(values[9], 220);
  EXPECT_EQ(reduction_for(640, 640), 1);
  EXPECT_EQ(reduction_for(640, 639), 2);
  EXPECT_EQ(reduction_for(640, 1), 640);
  EXPECT_EQ(reduction_for(10, 400), 1);
}

TEST(Frames, ScalesKeepTheDigitsOfDarkAndOfBrightPictures) {
  for (const float level : {1e-9f, 1.0f, 1e8f}) {
    Image image = ramp(4, 4);
    for (int c = 0; c < 3; ++c)
      for (float& value : image.channel(c)) value = (value + 1) * level;
    const EncodedFrame frame = encoded_frame(image, "", FrameFormat::rgb9e5);
    int exponent = 0;
    EXPECT_EQ(std::frexp(frame.scale, &exponent), 0.5f);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        uint32_t bits = 0;
        std::memcpy(&bits, frame.bytes.data() + 4 * (4 * y + x), 4);
        const float red = color_from_rgb9e5(bits).x * frame.scale;
        EXPECT_NEAR(red, image.at(x, y, 0), image.at(x, y, 2) / 500);
      }
  }
}

TEST(Frames, LayersByTheirNames) {
  Image image(1, 1, {"R", "G", "B", "direct.R", "direct.G", "direct.B", "depth.Z"});
  for (int c = 0; c < 7; ++c) image.at(0, 0, c) = float(c);
  EXPECT_EQ(floats_of(encoded_frame(image, "direct", FrameFormat::f32)),
            (std::vector<float>{3, 4, 5}));
  EXPECT_EQ(floats_of(encoded_frame(image, "depth", FrameFormat::f32)),
            (std::vector<float>{6, 6, 6}));
  EXPECT_THROW(encoded_frame(image, "caustic", FrameFormat::f32), Error);
}

}  // namespace
}  // namespace kaustik::view
