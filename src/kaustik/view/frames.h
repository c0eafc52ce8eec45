#pragma once
#include <cstdint>
#include <string>

#include "kaustik/base/vec.h"
#include "kaustik/image/image.h"

namespace kaustik::view {

/// How pixels are sent, rows from the top.
enum class FrameFormat : uint8_t {
  rgb9e5,  ///< four bytes a pixel: EXT_texture_shared_exponent, what is negative becomes 0
  f32      ///< three floats a pixel, little endian
};

struct EncodedFrame {
  std::string bytes;
  int width = 0, height = 0;
  float scale = 1;  ///< pixels are those of the picture divided by it, a power of two
};

/// Red, green and blue of an image's layer ("": the picture), each pixel the mean of a square of
/// `reduction` × `reduction` pixels of the image, or of what of it is there at the right and lower
/// edges. Throws Error(input) if there is no such layer.
EncodedFrame encoded_frame(const Image& image, const std::string& layer, FrameFormat format,
                           int reduction = 1);

/// The least reduction that makes a picture no wider than `most`.
int reduction_for(int width, int most);

/// Of colours from 0 to 65408: 9 bits each and an exponent of 5 bits for all three. Larger ones and
/// infinity become 65408, negative ones and NaN 0.
uint32_t rgb9e5_from(const Vec3f& color);
Vec3f color_from_rgb9e5(uint32_t bits);

}  // namespace kaustik::view
