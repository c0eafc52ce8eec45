#include "benchmarks/comparisons/picture_strip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/image/color_scale.h"
#include "kaustik/image/photometry.h"
#include "kaustik/image/tone_mapping.h"

namespace kaustik::bench {
namespace {

constexpr double white_quantile = 0.98;
constexpr float least_error = 1e-6f;

/// Colours of an image by place.
class Colors {
 public:
  explicit Colors(const Image& image)
      : image_(image),
        channels_{image.find_channel("R"), image.find_channel("G"), image.find_channel("B")} {}
  Vec3f at(int x, int y) const {
    return {image_.at(x, y, channels_[0]), image_.at(x, y, channels_[1]),
            image_.at(x, y, channels_[2])};
  }

 private:
  const Image& image_;
  std::array<int, 3> channels_;
};

float white_of(const Image& reference) {
  const Colors colors(reference);
  std::vector<float> luminances;
  for (int y = 0; y < reference.height(); ++y)
    for (int x = 0; x < reference.width(); ++x) luminances.push_back(photopic(colors.at(x, y)));
  const auto at =
      luminances.begin() + std::ptrdiff_t(white_quantile * double(luminances.size() - 1));
  std::nth_element(luminances.begin(), at, luminances.end());
  return *at > 0 ? *at : 1.0f;
}

Vec3f error_color(const Vec3f& color, const Vec3f& reference) {
  float sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += sqr(color[c] - reference[c]) / (3 * (sqr(reference[c]) + 0.01f));
  return viridis(1 - std::log10(std::max(sum, least_error)) / std::log10(least_error));
}

}  // namespace

Image picture_strip(const std::vector<Image>& pictures, const Image& reference) {
  const int width = reference.width(), height = reference.height();
  Image strip(width * int(pictures.size() + 1), 2 * height, {"R", "G", "B"});
  const auto put = [&](int x, int y, const Vec3f& color) {
    for (int c = 0; c < 3; ++c) strip.at(x, y, c) = std::clamp(color[c], 0.0f, 1.0f);
  };
  const float white = white_of(reference);
  const Colors wanted(reference);
  const int last = int(pictures.size());
  for (int column = 0; column <= last; ++column) {
    const Colors colors(column < last ? pictures[size_t(column)] : reference);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Vec3f color = colors.at(x, y);
        put(column * width + x, y, into_gamut(color / white));
        put(column * width + x, height + y,
            column < last ? error_color(color, wanted.at(x, y))
                          : viridis((float(x) + 0.5f) / float(width)));
      }
  }
  return strip;
}

}  // namespace kaustik::bench
