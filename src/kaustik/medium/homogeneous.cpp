#include <fmt/format.h>

#include "kaustik/base/color.h"
#include "kaustik/base/limits.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

const TypeInfo& info() {
  static const TypeInfo info{
      "medium",
      "homogeneous",
      "Haze, water, milk: absorbs and scatters light, the same everywhere. Give 'albedo' and "
      "'sigma_t', or 'sigma_a' and 'sigma_s'; a nested <phase> says where it scatters to.",
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

/// The argument as a factor per lane; the lane that carries no light gets the mean of the others,
/// which makes it harmless where lanes are sampled.
Spectrum coefficient(const Arguments& arguments, std::string_view name) {
  Spectrum result = reflectance_spectrum(arguments.color(name));
  result.set(3, (result[0] + result[1] + result[2]) / 3);
  return result;
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

std::shared_ptr<const Medium> create(const MediumInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const bool by_parts = arguments.given("sigma_a") || arguments.given("sigma_s");
  for (const char* name : {"albedo", "sigma_t"})
    if (by_parts && arguments.given(name))
      throw Error(ErrorKind::input, "the medium is described twice",
                  "give either 'albedo' and 'sigma_t' or 'sigma_a' and 'sigma_s'",
                  arguments.place_of(name));
  Spectrum extinction, albedo;
  if (by_parts) {
    const Spectrum scattering =
        arguments.given("sigma_s") ? coefficient(arguments, "sigma_s") : Spectrum();
    extinction =
        scattering + (arguments.given("sigma_a") ? coefficient(arguments, "sigma_a") : Spectrum());
    albedo = share(scattering, extinction);
  } else {
    extinction = coefficient(arguments, "sigma_t");
    albedo = coefficient(arguments, "albedo");
  }
  extinction *= float(arguments.number("scale"));
  check_extinction(extinction, arguments);
  return std::make_shared<Medium>(extinction, albedo, inputs.phase);
}

}  // namespace

MediumType homogeneous_type() { return {info(), create}; }

}  // namespace kaustik
