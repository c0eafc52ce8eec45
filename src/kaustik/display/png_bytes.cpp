#include "kaustik/display/png_bytes.h"

#include "kaustik/base/srgb.h"
#include "kaustik/image/image_io.h"

namespace kaustik {

std::vector<uint8_t> png_bytes(const ScreenPixels& pixels) {
  Image image(pixels.width, pixels.height, {"R", "G", "B"});
  for (size_t i = 0; i < image.pixel_count(); ++i)
    for (int c = 0; c < 3; ++c)
      image.channel(c)[i] = linear_from_srgb(float(pixels.rgb[3 * i + size_t(c)]) / 255);
  return encode_shown_image(image, "picture.png");
}

}  // namespace kaustik
