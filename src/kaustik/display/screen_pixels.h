#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/base/vec.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik {

/// A picture as screens take it: 8-bit sRGB, three bytes per pixel, row by row from the top left.
struct ScreenPixels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
  const uint8_t* at(int x, int y) const {
    return rgb.data() + 3 * (size_t(y) * size_t(width) + size_t(x));
  }
};

/// "R", "G", "B" of the image's picture with no more pixels than `size`: each is the mean of a box
/// of the image's pixels, those left out that are not finite. Keeps the metadata.
Image shrunk(const Image& image, Vec2i size);

/// The image made smaller and then shown by `tone`, in at most `size` pixels.
ScreenPixels screen_pixels(const Image& image, const ToneOperator& tone, Vec2i size);

}  // namespace kaustik
