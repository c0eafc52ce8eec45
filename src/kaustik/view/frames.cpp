#include "kaustik/view/frames.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

namespace kaustik::view {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are sent as they are in memory");

constexpr int mantissa_bits = 9, exponent_bias = 15;
constexpr float largest_rgb9e5 = 65408;

std::vector<Vec3f> reduced_pixels(const RgbView& view, int width, int height, int reduction,
                                  int reduced_width, int reduced_height) {
  std::vector<Vec3f> pixels(size_t(reduced_width) * size_t(reduced_height), Vec3f(0, 0, 0));
  if (reduction == 1) {
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = view[i];
    return pixels;
  }
  for (int y = 0; y < height; ++y) {
    Vec3f* const row = pixels.data() + size_t(y / reduction) * size_t(reduced_width);
    for (int x = 0; x < width; ++x)
      row[x / reduction] += view[size_t(y) * size_t(width) + size_t(x)];
  }
  for (int y = 0; y < reduced_height; ++y)
    for (int x = 0; x < reduced_width; ++x) {
      const int columns = std::min(reduction, width - x * reduction);
      const int rows = std::min(reduction, height - y * reduction);
      pixels[size_t(y) * size_t(reduced_width) + size_t(x)] *= 1 / float(columns * rows);
    }
  return pixels;
}

/// The power of two that brings the largest value just below what the format can hold: what is dark
/// beside it keeps the most of its digits.
float scale_of(const std::vector<Vec3f>& pixels) {
  float largest = 0;
  for (const Vec3f& pixel : pixels)
    for (int lane = 0; lane < 3; ++lane)
      if (std::isfinite(pixel[lane])) largest = std::max(largest, pixel[lane]);
  if (!(largest > 0)) return 1;
  // 65408 is a little less than 2^16.
  int exponent = std::clamp(std::ilogb(largest) - 15, -100, 100);
  if (std::ldexp(largest, -exponent) > largest_rgb9e5) ++exponent;
  return std::ldexp(1.0f, exponent);
}

}  // namespace

uint32_t rgb9e5_from(const Vec3f& color) {
  Vec3f clamped;
  float largest = 0;
  for (int lane = 0; lane < 3; ++lane) {
    // NaN fails the comparison.
    clamped[lane] = color[lane] > 0 ? std::min(color[lane], largest_rgb9e5) : 0;
    largest = std::max(largest, clamped[lane]);
  }
  // Of the float: what is below the least exponent shares that.
  const int log2 = int(std::bit_cast<uint32_t>(largest) >> 23) - 127;
  int exponent = std::max(-exponent_bias - 1, log2) + 1 + exponent_bias;
  const auto unit_of = [](int shared) {
    return std::bit_cast<float>(uint32_t(127 + mantissa_bits + exponent_bias - shared) << 23);
  };
  float per_unit = unit_of(exponent);
  if (largest * per_unit + 0.5f >= float(1 << mantissa_bits)) per_unit = unit_of(++exponent);
  uint32_t bits = uint32_t(exponent) << 27;
  for (int lane = 0; lane < 3; ++lane)
    bits |= uint32_t(clamped[lane] * per_unit + 0.5f) << (mantissa_bits * lane);
  return bits;
}

Vec3f color_from_rgb9e5(uint32_t bits) {
  const float unit = std::ldexp(1.0f, int(bits >> 27) - exponent_bias - mantissa_bits);
  Vec3f color;
  for (int lane = 0; lane < 3; ++lane)
    color[lane] = float((bits >> (mantissa_bits * lane)) & 511u) * unit;
  return color;
}

int reduction_for(int width, int most) { return std::max(1, (width + most - 1) / most); }

EncodedFrame encoded_frame(const Image& image, const std::string& layer, FrameFormat format,
                           int reduction) {
  const RgbView view = rgb_view(image, layer);
  EncodedFrame frame;
  frame.width = (image.width() + reduction - 1) / reduction;
  frame.height = (image.height() + reduction - 1) / reduction;
  const std::vector<Vec3f> pixels =
      reduced_pixels(view, image.width(), image.height(), reduction, frame.width, frame.height);
  if (format == FrameFormat::f32) {
    frame.bytes.resize(pixels.size() * 12);
    static_assert(sizeof(Vec3f) == 12);
    std::memcpy(frame.bytes.data(), pixels.data(), frame.bytes.size());
    return frame;
  }
  frame.scale = scale_of(pixels);
  const float inverse = 1 / frame.scale;
  frame.bytes.resize(pixels.size() * 4);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const uint32_t bits = rgb9e5_from(pixels[i] * inverse);
    std::memcpy(frame.bytes.data() + 4 * i, &bits, 4);
  }
  return frame;
}

}  // namespace kaustik::view
