#include "kaustik/display/screen_pixels.h"

#include <algorithm>

namespace kaustik {
namespace {

/// Mean over the pixels [x0, x1) × [y0, y1) that are finite; black if none is.
Vec3f box_mean(const RgbView& rgb, int width, Vec2i from, Vec2i to) {
  double sum[3] = {};
  size_t count = 0;
  for (int y = from.y; y < to.y; ++y)
    for (int x = from.x; x < to.x; ++x) {
      const Vec3f pixel = rgb[size_t(y) * size_t(width) + size_t(x)];
      if (!is_finite(pixel)) continue;
      for (int c = 0; c < 3; ++c) sum[c] += double(pixel[c]);
      ++count;
    }
  const double share = 1 / double(std::max<size_t>(1, count));
  return {float(sum[0] * share), float(sum[1] * share), float(sum[2] * share)};
}

}  // namespace

Image shrunk(const Image& image, Vec2i size) {
  const Vec2i target(std::clamp(size.x, 1, image.width()), std::clamp(size.y, 1, image.height()));
  const RgbView rgb = rgb_view(image);
  Image result(target.x, target.y, {"R", "G", "B"});
  const auto border = [](int i, int count, int of) { return int(int64_t(i) * of / count); };
  for (int y = 0; y < target.y; ++y)
    for (int x = 0; x < target.x; ++x) {
      const Vec3f mean = box_mean(
          rgb, image.width(),
          {border(x, target.x, image.width()), border(y, target.y, image.height())},
          {border(x + 1, target.x, image.width()), border(y + 1, target.y, image.height())});
      for (int c = 0; c < 3; ++c) result.at(x, y, c) = mean[c];
    }
  for (const auto& [key, value] : image.metadata()) result.set_metadata(key, value);
  return result;
}

ScreenPixels screen_pixels(const Image& image, const ToneOperator& tone, Vec2i size) {
  Image shown = tone_map(shrunk(image, size), tone);
  // What is drawn beside the picture makes it larger.
  if (shown.width() > size.x || shown.height() > size.y) shown = shrunk(shown, size);
  return {shown.width(), shown.height(), srgb_bytes(shown)};
}

}  // namespace kaustik
