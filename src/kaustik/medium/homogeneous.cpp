#include "kaustik/medium/homogeneous.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/limits.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

/// Probabilities of the lanes in proportion to `shares`; even where there are none.
Spectrum lane_probabilities(const Spectrum& shares) {
  const float sum = shares.sum();
  return sum > 0 && std::isfinite(sum) ? shares / sum : Spectrum(1.0f / Spectrum::lane_count);
}

int choose_lane(const Spectrum& probabilities, float u) {
  int last = 0;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    if (!(probabilities[lane] > 0)) continue;
    last = lane;
    if (u < probabilities[lane]) return lane;
    u -= probabilities[lane];
  }
  return last;
}

/// Share of the light that collides within `distance`: 1 − exp(−σ d), exact for thin media.
float collision_chance(float extinction, float distance) {
  return extinction > 0 ? -std::expm1(-extinction * distance) : 0.0f;
}

Spectrum left_after(float distance, const Spectrum& extinction) {
  Spectrum result(1);
  // A lane that absorbs nothing stays 1 at an infinite distance too, where 0 · ∞ has no value.
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (extinction[lane] > 0) result.set(lane, std::exp(-extinction[lane] * distance));
  return result;
}

const TypeInfo& homogeneous_info() {
  static const TypeInfo info{
      "medium",
      "homogeneous",
      "Haze, water, milk: absorbs and scatters light, the same everywhere. Give 'albedo' and "
      "'sigma_t', or 'sigma_a' and 'sigma_s'; a nested phase function says where it scatters to.",
      {color_parameter("albedo", 0.75, "Share of the light taken out that is scattered.")
           .range(0, 1),
       color_parameter("sigma_t", 1, "Extinction: what is taken out of a beam.").in("1/m"),
       optional(
           color_parameter("sigma_a", 0, "Absorption, instead of albedo and sigma_t.").in("1/m")),
       optional(
           color_parameter("sigma_s", 0, "Scattering, instead of albedo and sigma_t.").in("1/m")),
       number_parameter("scale", 1, "Factor on all coefficients, for other units of length.")
           .range(0, 1e30),
       ignored_parameter("sample_emitters", ParameterKind::boolean),
       ignored_parameter("has_spectral_extinction", ParameterKind::boolean)}};
  return info;
}

/// The argument as a factor; in RGB mode the lane that carries no light gets the mean of the
/// others, which makes it harmless where lanes are sampled.
SpectralValue coefficient(const Arguments& arguments, std::string_view name) {
  const SpectralValue value = SpectralValue::material_constant(arguments.color(name));
  Spectrum rgb = value.rgb();
  rgb.set(3, (rgb[0] + rgb[1] + rgb[2]) / 3);
  return value.with_rgb(rgb);
}

Spectrum share(const Spectrum& part, const Spectrum& whole) {
  Spectrum result;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (whole[lane] > 0) result.set(lane, std::min(1.0f, part[lane] / whole[lane]));
  return result;
}

/// Light has to fly a distance that floats carry.
void check_extinction(const Spectrum& extinction, const Arguments& arguments) {
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const float value = extinction[lane];
    const bool is_small = double(value) < 1 / largest_length;
    if (value == 0 || (!is_small && double(value) <= 1 / smallest_length)) continue;
    throw Error(ErrorKind::input,
                fmt::format("the medium's extinction of {:g} per metre is too {} for single floats",
                            value, is_small ? "small" : "large"),
                fmt::format("give zero, or from {:g} to {:g}: see 'scale' and the coefficients",
                            1 / largest_length, 1 / smallest_length),
                arguments.given("scale") ? arguments.place_of("scale") : arguments.place());
  }
}

std::shared_ptr<const Medium> create_homogeneous(const MediumInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const bool by_parts = arguments.given("sigma_a") || arguments.given("sigma_s");
  for (const char* name : {"albedo", "sigma_t"})
    if (by_parts && arguments.given(name))
      throw Error(ErrorKind::input, "the medium is described twice",
                  "give either 'albedo' and 'sigma_t' or 'sigma_a' and 'sigma_s'",
                  arguments.place_of(name));
  const auto scale = float(arguments.number("scale"));
  SpectralValue extinction, scattering;
  if (by_parts) {
    const auto part = [&](const char* name) {
      return arguments.given(name) ? coefficient(arguments, name) : SpectralValue();
    };
    const SpectralValue scattered = part("sigma_s"), all = scattered + part("sigma_a");
    extinction = all * scale;
    const Spectrum rgb = extinction.rgb() * share(scattered.rgb(), all.rgb());
    scattering = (scattered * scale).with_rgb(rgb);
  } else {
    extinction = coefficient(arguments, "sigma_t") * scale;
    scattering = extinction * coefficient(arguments, "albedo");
  }
  check_extinction(extinction.rgb(), arguments);
  if (extinction.rgb().is_zero()) return nullptr;
  return std::make_shared<HomogeneousMedium>(extinction, scattering, inputs.phase);
}

}  // namespace

HomogeneousMedium::HomogeneousMedium(const SpectralValue& extinction,
                                     const SpectralValue& scattering,
                                     std::shared_ptr<const PhaseFunction> phase)
    : Medium(std::move(phase), !scattering.rgb().is_zero()),
      extinction_(extinction),
      scattering_(scattering),
      mean_extinction_(extinction.rgb().sum() / float(Spectrum::lane_count)) {
  const Wavelengths some(430, 490, 560, 630);
  looks_ = {extinction.rgb(), scattering.rgb(), extinction.at(some), scattering.at(some)};
}

bool HomogeneousMedium::is_like(const Medium& other) const {
  if (this == &other) return true;
  const auto* o = dynamic_cast<const HomogeneousMedium*>(&other);
  return o && looks_ == o->looks_ && phase().mean_cosine() == o->phase().mean_cosine();
}

Spectrum HomogeneousMedium::transmittance(float length, const Wavelengths& wavelengths) const {
  return left_after(length, extinction_.at(wavelengths));
}

Medium::Flight HomogeneousMedium::sample_flight(float length, const Spectrum& shares,
                                                const Wavelengths& wavelengths,
                                                const Vec2f& u) const {
  const Spectrum probabilities = lane_probabilities(shares);
  const Spectrum extinction = extinction_.at(wavelengths);
  const float chosen = extinction[choose_lane(probabilities, u.x)];
  Flight flight;
  if (chosen > 0) flight.distance = -std::log1p(-u.y) / chosen;
  flight.scattered = flight.distance < length;
  if (!flight.scattered) flight.distance = length;
  const Spectrum left = left_after(flight.distance, extinction);
  if (flight.scattered)
    flight.weight =
        scattering_.at(wavelengths) * left * (1 / (probabilities * extinction * left).sum());
  else
    flight.weight = left * (1 / (probabilities * left).sum());
  return flight;
}

Medium::Flight HomogeneousMedium::sample_collision(float length, const Spectrum& shares,
                                                   const Wavelengths& wavelengths,
                                                   const Vec2f& u) const {
  Flight flight;
  const Spectrum extinction = extinction_.at(wavelengths), scattering = scattering_.at(wavelengths);
  const Spectrum scattered = shares * scattering;
  if (!(scattered.sum() > 0) || !(length > 0)) return flight;
  const Spectrum probabilities = lane_probabilities(scattered);
  const int lane = choose_lane(probabilities, u.x);
  const float chosen = extinction[lane];
  flight.distance = std::min(-std::log1p(-u.y * collision_chance(chosen, length)) / chosen, length);
  flight.scattered = true;
  const Spectrum left = left_after(flight.distance, extinction);
  float density = 0;
  for (int i = 0; i < Spectrum::lane_count; ++i)
    if (probabilities[i] > 0)
      density +=
          probabilities[i] * extinction[i] * left[i] / collision_chance(extinction[i], length);
  flight.weight = scattering * left * (1 / density);
  return flight;
}

MediumType homogeneous_type() { return {homogeneous_info(), create_homogeneous}; }

}  // namespace kaustik
