#include "kaustik/scene/picture_as_exr.h"

#include "kaustik/image/image_io.h"
#include "kaustik/material/bitmap_picture.h"
#include "kaustik/scene/arguments_alone.h"

namespace kaustik {

std::vector<uint8_t> picture_as_exr(const Object& bitmap, const Rgb& factor) {
  PictureReader pictures;
  const Image picture = bitmap_picture(arguments_alone(bitmap), pictures);
  const RgbView colours = rgb_view(picture);
  const bool is_grey = colours.planes[0].data() == colours.planes[1].data() &&
                       colours.planes[0].data() == colours.planes[2].data() &&
                       factor.r == factor.g && factor.r == factor.b;
  Image scaled(picture.width(), picture.height(),
               is_grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"});
  const float factors[3] = {float(factor.r), float(factor.g), float(factor.b)};
  for (int c = 0; c < scaled.channel_count(); ++c) {
    const std::span<const float> from = colours.planes[size_t(c)];
    const std::span<float> to = scaled.channel(c);
    for (size_t i = 0; i < to.size(); ++i) to[i] = from[i] * factors[c];
  }
  WriteOptions options;
  options.exr_half = false;
  return encode_image(scaled, "picture.exr", options);
}

}  // namespace kaustik
