#include <webp/decode.h>

#include <new>

#include "kaustik/image/formats.h"

namespace kaustik::formats {

Image decode_webp(ByteView file, const ReadOptions& options) {
  WebPBitstreamFeatures features;
  const VP8StatusCode status = WebPGetFeatures(file.data(), file.size(), &features);
  if (status == VP8_STATUS_NOT_ENOUGH_DATA) throw BadImage("the file is truncated");
  if (status != VP8_STATUS_OK) throw BadImage("it is no WebP picture");
  if (features.has_animation) throw BadImage("it is an animation: save one picture of it");
  const int channels = features.has_alpha ? 4 : 3;
  // Lossless pictures of one colour take no bytes per pixel, and the library up to 12 of memory.
  constexpr double most_pixels_per_byte = 1e7;
  check_promise({features.width, features.height, channels, 12 + channels, most_pixels_per_byte},
                file.size(), options);
  const size_t row_bytes = size_t(features.width) * size_t(channels);
  WorkBytes pixels(row_bytes * size_t(features.height));
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) throw BadImage("the WebP library is of another version");
  config.output.colorspace = channels == 4 ? MODE_RGBA : MODE_RGB;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {pixels.data(), int(row_bytes), pixels.size()};
  const VP8StatusCode decoded = WebPDecode(file.data(), file.size(), &config);
  if (decoded == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
  if (decoded != VP8_STATUS_OK) throw BadImage("the file is truncated or damaged");
  Image image(features.width, features.height, channel_names_for(channels));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      set_pixel(image, x, y, pixels.data() + size_t(y) * row_bytes + size_t(x) * size_t(channels));
  image.set_srgb_encoded(true);
  return image;
}

}  // namespace kaustik::formats
