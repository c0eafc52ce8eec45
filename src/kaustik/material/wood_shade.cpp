#include "kaustik/material/wood_shade.h"

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

constexpr float fibre_strength = 0.9f, pore_strength = 1.2f;
/// Per ring: the coarsest fibres, and pores.
constexpr float fibre_frequency = 5, pore_frequency = 9;

float pore_of(float noise) { return std::max(0.0f, noise - 0.3f); }

/// Late wood gets denser through the year and ends sharply; years differ, by a uniform number.
float ring_shade(float within_year, float of_year) {
  const float late =
      smooth_step(0.1f, 0.95f, within_year) * (1 - smooth_step(0.94f, 1.0f, within_year));
  return 0.08f + 0.75f * late * (0.55f + 0.45f * of_year);
}

/// Over places in a year and over years.
float mean_over_rings(const NoisyRamp& ramp) {
  constexpr int places = 256, years = 16;
  double sum = 0;
  for (int i = 0; i < places; ++i)
    for (int j = 0; j < years; ++j)
      sum += double(ramp(ring_shade((float(i) + 0.5f) / places, (float(j) + 0.5f) / years)));
  return float(sum / (places * years));
}

/// The fine value as far as it is seen, the coarse one for the rest.
template <class Fine>
float seen(float coarse, float visibility, const Fine& fine) {
  return visibility < 1e-4f ? coarse : coarse * (1 - visibility) + fine() * visibility;
}

}  // namespace

WoodShade::WoodShade(float ring_width, float grain, uint32_t seed)
    : ring_(ring_width), grain_(grain), seed_(seed), fibres_{3, 0.7f, seed + 101} {
  const auto octave = [&](int i) {
    const float strength = grain * fibre_strength * fibres_.share(i);
    return [strength](float noise) { return strength * noise; };
  };
  without_finest_ = NoisyRamp().with(octave(2));
  without_pores_ = without_finest_.with(octave(1)).with(
      [grain](float noise) { return grain * pore_strength * pore_of(noise); });
  without_grain_ = without_pores_.with(octave(0));
  mean_ = mean_over_rings(without_grain_);
}

float WoodShade::operator()(const Vec3f& p, float width) const {
  const float rings_wide = width / ring_;
  const auto visible = [&](float frequency) { return noise_visibility(frequency * rings_wide); };
  const Vec3f fibre = fibre_place(p);
  const auto octave = [&](int i) { return grain_ * fibre_strength * fibres_.octave(i, fibre); };
  return seen(mean_, visible(1), [&] {
    const float ring = rings(p, width);
    return seen(without_grain_(ring), visible(fibre_frequency), [&] {
      const float coarse = ring + octave(0);
      return seen(without_pores_(coarse), visible(2 * fibre_frequency), [&] {
        const float fine = coarse + octave(1) + grain_ * pore_strength * pores(p);
        return seen(without_finest_(fine), visible(4 * fibre_frequency),
                    [&] { return std::clamp(fine + octave(2), 0.0f, 1.0f); });
      });
    });
  });
}

float WoodShade::rings(const Vec3f& p, float width) const {
  const float inverse = 1 / ring_;
  // Trunks are neither round nor straight.
  const Vec3f slow(p.x * inverse * 0.012f, p.y * inverse * 0.09f, p.z * inverse * 0.09f);
  const float bent = FractalNoise{3, 0.5f, seed_ + 7}.value(slow, 0.09f * width * inverse);
  const float radius = std::hypot(p.y, p.z) * inverse + 4.5f * bent;
  const float year = std::floor(radius);
  // Years that are told apart; farther out floats have lost them.
  const int number = lattice_cell(std::clamp(year, -1e6f, 1e6f));
  return ring_shade(radius - year, cell_random(number, 0, 9, seed_));
}

float WoodShade::pores(const Vec3f& p) const {
  const float f = pore_frequency / ring_;
  return pore_of(gradient_noise_value({p.x * f * 0.035f, p.y * f, p.z * f}, seed_ + 131));
}

Vec3f WoodShade::fibre_place(const Vec3f& p) const {
  // Fibres are thin and long; what counts for fading is their width.
  const float f = fibre_frequency / ring_;
  return {p.x * f * 0.02f, p.y * f, p.z * f};
}

float WoodShade::fibres(const Vec3f& p, float width) const {
  return fibres_.value(fibre_place(p), fibre_frequency / ring_ * width);
}

}  // namespace kaustik
