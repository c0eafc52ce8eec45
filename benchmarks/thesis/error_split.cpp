#include "error_split.h"

#include <algorithm>

#include "kaustik/base/vec.h"

namespace kaustik::thesis {

ErrorSplit split_error(std::span<const Image> pictures, const Image& reference,
                       const std::string& layer) {
  const RgbView truth = rgb_view(reference, layer);
  std::vector<RgbView> views;
  for (const Image& picture : pictures) views.push_back(rgb_view(picture, layer));
  const double n = double(views.size());
  struct Pixel {
    double noise = 0, bias = 0;
  };
  std::vector<Pixel> pixels(reference.pixel_count());
  for (size_t i = 0; i < pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0, squares = 0;
      for (const RgbView& view : views) {
        sum += view.planes[c][i];
        squares += sqr(double(view.planes[c][i]));
      }
      const double mean = sum / n, r = truth.planes[c][i];
      const double variance = std::max(0.0, squares - sum * mean) / (n - 1);
      const double scale = 1 / (3 * (r * r + 0.01));
      pixels[i].noise += variance * scale;
      pixels[i].bias += (sqr(mean - r) - variance / n) * scale;
    }
  // Both parts over the same pixels, or they would not add up to the error.
  const auto kept = pixels.begin() + std::ptrdiff_t(pixels.size() - pixels.size() / 1000);
  std::nth_element(pixels.begin(), kept - 1, pixels.end(), [](const Pixel& a, const Pixel& b) {
    return a.noise + a.bias < b.noise + b.bias;
  });
  ErrorSplit split;
  for (auto pixel = pixels.begin(); pixel != kept; ++pixel) {
    split.noise += pixel->noise / double(kept - pixels.begin());
    split.bias += pixel->bias / double(kept - pixels.begin());
  }
  return split;
}

}  // namespace kaustik::thesis
