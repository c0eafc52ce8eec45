#include "kaustik/medium/coefficients.h"

#include <fmt/format.h>

#include "kaustik/base/limits.h"

namespace kaustik {
namespace {

/// Null: it is not given as a volume.
const MediumInputs::GivenVolume* only_volume(const MediumInputs& inputs, std::string_view name) {
  const MediumInputs::GivenVolume* given = inputs.volume(name);
  if (given && inputs.arguments.given(name))
    throw Error(ErrorKind::input,
                fmt::format("the medium's '{}' is given both as a value and as a volume", name),
                "keep one", given->place);
  return given;
}

}  // namespace

SpectralValue coefficient(const std::variant<Rgb, SpectralCurve>& color) {
  const SpectralValue value = SpectralValue::material_constant(color);
  Spectrum rgb = value.rgb();
  rgb.set(3, (rgb[0] + rgb[1] + rgb[2]) / 3);
  return value.with_rgb(rgb);
}

SpectralValue coefficient(const MediumInputs& inputs, std::string_view name) {
  const MediumInputs::GivenVolume* given = only_volume(inputs, name);
  if (!given) return coefficient(inputs.arguments.color(name));
  const SpectralValue value = coefficient(given->volume->color());
  const Parameter& row = *inputs.arguments.info().find(name);
  if (double(value.rgb().max_lane()) > row.maximum)
    throw Error(ErrorKind::input,
                fmt::format("the medium's '{}' is {:g}", name, value.rgb().max_lane()),
                fmt::format("give at most {:g}", row.maximum), given->place);
  return value;
}

const GridVolume* given_grid(const MediumInputs& inputs, std::string_view name) {
  const MediumInputs::GivenVolume* given = only_volume(inputs, name);
  return given ? given->volume->grid() : nullptr;
}

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

Parameter albedo_parameter() {
  return color_parameter("albedo", 0.75, "Fraction of the extinction that is scattered.")
      .range(0, 1)
      .or_volume();
}
Parameter sigma_t_parameter() {
  return color_parameter("sigma_t", 1, "Extinction coefficient.").in("1/m").or_volume();
}
Parameter medium_scale_parameter() {
  return number_parameter("scale", 1, "Factor on all coefficients, for other length units.")
      .range(0, 1e30);
}

void check_albedo_grid(const GridVolume& grid, const Place& place) {
  if (grid.channels() != 1 && grid.channels() != 3)
    throw Error(ErrorKind::input, fmt::format("the albedo's grid has {} channels", grid.channels()),
                "give it one channel, or three of linear Rec. 709", place);
  if (grid.least() >= 0 && grid.largest() <= 1) return;
  throw Error(
      ErrorKind::input,
      fmt::format("the albedo's grid has values from {:g} to {:g}", grid.least(), grid.largest()),
      "keep all between 0 and 1: more light cannot be scattered than is taken out", place);
}

}  // namespace kaustik
