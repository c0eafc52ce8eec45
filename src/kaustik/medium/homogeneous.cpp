#include "kaustik/medium/homogeneous.h"

#include <algorithm>
#include <optional>

#include "kaustik/medium/coefficients.h"
#include "kaustik/medium/heterogeneous.h"
#include "kaustik/medium/medium_kinds.h"
#include "kaustik/medium/medium_presets.h"

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

std::vector<std::string> material_choices() {
  std::vector<std::string> names = medium_preset_names();
  names.insert(names.begin(), "none");
  return names;
}

const TypeInfo& homogeneous_info() {
  static const TypeInfo info{
      "medium",
      "homogeneous",
      "Haze, water, milk: absorbs and scatters light evenly in space. Give 'albedo' and 'sigma_t', "
      "or 'sigma_a' and 'sigma_s', or a 'material'. A nested phase function gives the directions.",
      {albedo_parameter(), sigma_t_parameter(),
       optional(
           color_parameter("sigma_a", 0, "Absorption, instead of albedo and sigma_t.").in("1/m")),
       optional(
           color_parameter("sigma_s", 0, "Scattering, instead of albedo and sigma_t.").in("1/m")),
       choice_parameter(
           "material", "none", material_choices(),
           "Measured substance, instead of coefficients. They are per millimetre, so 'scale' is "
           "1000 in a scene in metres. It scatters evenly, by the reduced coefficient."),
       medium_scale_parameter(), ignored_parameter("sample_emitters", ParameterKind::boolean),
       ignored_parameter("has_spectral_extinction", ParameterKind::boolean),
       ignored_parameter("strategy", ParameterKind::text)}};
  return info;
}

Spectrum share(const Spectrum& part, const Spectrum& whole) {
  Spectrum result;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    if (whole[lane] > 0) result.set(lane, std::min(1.0f, part[lane] / whole[lane]));
  return result;
}

/// What a medium scatters and absorbs; before `scale`.
struct Parts {
  SpectralValue scattered, absorbed;
};

/// Null: the medium is described by albedo and extinction. Throws where it is described twice.
std::optional<Parts> given_parts(const MediumInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const MediumPreset* const preset = find_medium_preset(arguments.text("material"));
  const bool by_parts = arguments.given("sigma_a") || arguments.given("sigma_s");
  if (preset && by_parts)
    throw Error(ErrorKind::input, "the medium is described twice",
                "keep 'material', or 'sigma_a' and 'sigma_s'", arguments.place_of("material"));
  if (!preset && !by_parts) return std::nullopt;
  for (const char* name : {"albedo", "sigma_t"})
    if (arguments.given(name) || inputs.volume(name))
      throw Error(ErrorKind::input, "the medium is described twice",
                  "give either 'albedo' and 'sigma_t', or 'sigma_a' and 'sigma_s', or 'material'",
                  arguments.place_of(name));
  if (preset) return Parts{coefficient(preset->reduced_sigma_s()), coefficient(preset->sigma_a)};
  const auto part = [&](const char* name) {
    return arguments.given(name) ? coefficient(arguments.color(name)) : SpectralValue();
  };
  return Parts{part("sigma_s"), part("sigma_a")};
}

std::shared_ptr<const Medium> create_homogeneous(const MediumInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const std::optional<Parts> parts = given_parts(inputs);
  if (given_grid(inputs, "sigma_t"))
    throw Error(ErrorKind::input, "a homogeneous medium cannot have a grid of 'sigma_t'",
                "make the medium one of type 'heterogeneous'", inputs.volume("sigma_t")->place);
  if (given_grid(inputs, "albedo")) return make_heterogeneous(inputs);
  const auto scale = float(arguments.number("scale"));
  SpectralValue extinction, scattering;
  if (parts) {
    const SpectralValue& scattered = parts->scattered;
    const SpectralValue all = scattered + parts->absorbed;
    extinction = all * scale;
    const Spectrum rgb = extinction.rgb() * share(scattered.rgb(), all.rgb());
    scattering = (scattered * scale).with_rgb(rgb);
  } else {
    extinction = coefficient(inputs, "sigma_t") * scale;
    scattering = extinction * coefficient(inputs, "albedo");
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
  return o && looks_ == o->looks_ && has_phase_of(*o);
}

Spectrum HomogeneousMedium::transmittance(float length, const Wavelengths& wavelengths) const {
  return left_after(length, extinction_.at(wavelengths));
}

int HomogeneousMedium::flying_lane(const Spectrum& shares, float u) {
  return choose_lane(lane_probabilities(shares), u);
}

Medium::Flight HomogeneousMedium::sample_flight(float length, const Spectrum& shares,
                                                const Wavelengths& wavelengths,
                                                const Vec2f& u) const {
  const Spectrum extinction = extinction_.at(wavelengths);
  const float chosen = extinction[flying_lane(shares, u.x)];
  Flight flight;
  if (chosen > 0) flight.distance = -std::log1p(-u.y) / chosen;
  flight.scattered = flight.distance < length;
  if (!flight.scattered) flight.distance = length;
  const Spectrum left = left_after(flight.distance, extinction);
  flight.weight = flight.scattered ? collided(left, shares, wavelengths) : passed(left, shares);
  return flight;
}

Spectrum HomogeneousMedium::collided(const Spectrum& left, const Spectrum& shares,
                                     const Wavelengths& wavelengths) const {
  const Spectrum density = lane_probabilities(shares) * extinction_.at(wavelengths) * left;
  const float sum = density.sum();
  return sum > 0 ? scattering_.at(wavelengths) * left * (1 / sum) : Spectrum();
}

Spectrum HomogeneousMedium::passed(const Spectrum& left, const Spectrum& shares) {
  const float chance = (lane_probabilities(shares) * left).sum();
  return chance > 0 ? left * (1 / chance) : Spectrum();
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
