#include "kaustik/render/sample_sum.h"

#include <cmath>

namespace kaustik {

int add_sample(const SampleSink& sink, PassPixel& sum) {
  int dropped = 0;
  std::array<Spectrum, component_count> finite{};
  for (int c = 0; c < component_count; ++c) {
    const Spectrum radiance = sink.rgb(sink.radiance(Component(c)));
    if (radiance.is_finite())
      sum.radiance[size_t(c)] += finite[size_t(c)] = radiance;
    else
      ++dropped;
  }
  const std::array<float, noise_kinds> values = by_noise_kind(finite);
  for (size_t k = 0; k < noise_kinds; ++k) sum.squares[k] += sqr(values[k]);
  const Spectrum bias = sink.rgb(sink.bias());
  if (bias.is_finite())
    sum.bias += bias;
  else
    ++dropped;
  if (!finite[size_t(Component::emission)].is_zero()) sum.first_hit.lamps += 1;
  const FirstHit& hit = sink.first_hit();
  if (!hit.albedo.is_finite() || !is_finite(hit.normal) || !std::isfinite(hit.depth))
    return dropped + 1;
  // As white light shows it.
  sum.first_hit.albedo += sink.rgb(hit.albedo * white_light(sink.wavelengths()));
  sum.first_hit.normal += hit.normal;
  sum.first_hit.depth += hit.depth;
  return dropped;
}

}  // namespace kaustik
