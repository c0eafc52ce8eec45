#include "kaustik/light/emission_pattern.h"

#include "kaustik/base/sampler.h"

namespace kaustik {

Spectrum mean_radiance(const EmissionPattern& pattern, const Shape& shape) {
  constexpr uint32_t side = 256, count = side * side;
  Spectrum sum;
  for (uint32_t row = 0; row < side; ++row) {
    Spectrum of_row;  // a sum of few numbers loses few of their digits
    for (uint32_t i = row * side; i < (row + 1) * side; ++i)
      of_row += pattern.radiance(
          shape.sample_area(Sampler::of(Quadrature::light_texture, i).next_2d()).point, {});
    sum += of_row;
  }
  if (sum.is_zero()) sum = spectrum_from_rgb(1, 1, 1) * pattern.maximum();
  return sum * (1.0f / float(count));
}

}  // namespace kaustik
