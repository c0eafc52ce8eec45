#include "kaustik/base/wave_field.h"

#include "kaustik/base/sampler.h"

namespace kaustik {
namespace {

constexpr float length_span = 16;           ///< of the longest waves to the shortest
constexpr float steepness_exponent = 1.3f;  ///< amplitude over length: longer waves are steeper
constexpr float gravity = 9.81f;            ///< m/s²
constexpr float tension = 7.3e-5f;          ///< surface tension of water over its density, m³/s²

/// What is left of a sine in the mean over a disk: its Gaussian of the same variance.
float visibility(float wave_number_sq, float width) {
  return std::exp(-wave_number_sq * width * width / 32);
}

}  // namespace

WaveField::WaveField(const WaveSettings& settings) {
  const Sampler seeds(hash_mix(0x77617665, settings.seed), 0);
  float variance = 0;
  for (int i = 0; i < settings.count; ++i) {
    Sampler sampler = seeds.split(Split::wave, uint32_t(i));
    const Vec2f u = sampler.next_2d();
    const float share = (float(i) + u.x) / float(settings.count);
    const float length = settings.wavelength * std::pow(length_span, -share);
    const float angle = (settings.direction + settings.spread * (2 * u.y - 1)) * (pi / 180);
    const float k = 2 * pi / length;
    const float speed = std::sqrt(k * (gravity + tension * k * k));
    const float amplitude = std::pow(length, steepness_exponent);
    waves_.push_back({Vec2f(std::cos(angle), std::sin(angle)) * k, amplitude,
                      2 * pi * sampler.next_1d() - speed * settings.time});
    variance += 0.5f * amplitude * amplitude;
  }
  const float scale = variance > 0 ? settings.amplitude / std::sqrt(variance) : 0;
  for (Wave& wave : waves_) {
    wave.amplitude *= scale;
    largest_ += wave.amplitude;
  }
}

float WaveField::height(const Vec2f& at, float width) const {
  float sum = 0;
  for (const Wave& w : waves_)
    sum += w.amplitude * visibility(w.wave_vector.length2(), width) *
           std::sin(w.wave_vector.dot(at) + w.phase);
  return sum;
}

Vec2f WaveField::slope(const Vec2f& at, float width) const {
  Vec2f sum(0, 0);
  for (const Wave& w : waves_)
    sum += w.wave_vector * (w.amplitude * visibility(w.wave_vector.length2(), width) *
                            std::cos(w.wave_vector.dot(at) + w.phase));
  return sum;
}

}  // namespace kaustik
