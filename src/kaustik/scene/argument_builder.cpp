// The part of SceneBuilder that makes the arguments of objects, of what they give and what stands
// for it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kaustik/base/color.h"
#include "kaustik/base/spectral_value.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/spectrum_types.h"
#include "kaustik/scene/texture_rows.h"

namespace kaustik {
namespace {

/// The parameter that a spectrum `name` is the value of; null if there is none. One without a name
/// is the colour of what holds it.
const Parameter* spectrum_parameter(const TypeInfo& info, const std::string& name) {
  if (const Parameter* row = info.find(name)) return row;
  if (name.empty())
    for (const Parameter& row : info.parameters)
      if (row.kind == ParameterKind::color) return &row;
  return texture_parameter(info, name);
}

/// A colour where a texture could give one number: its luminance, as textures give it.
Value as_taken_by(const Parameter* row, const Value& value) {
  if (!row || row->kind != ParameterKind::number || !row->accepts_texture) return value;
  if (const auto* curve = std::get_if<SpectralCurve>(&value))
    return double(luminance_of(SpectralValue::reflectance(*curve).rgb()));
  const auto* rgb = std::get_if<Rgb>(&value);
  if (!rgb) return value;
  if (rgb->r == rgb->g && rgb->g == rgb->b) return rgb->r;
  const double luminance =
      double(luminance_of(spectrum_from_rgb(float(rgb->r), float(rgb->g), float(rgb->b))));
  return std::clamp(luminance, std::min({rgb->r, rgb->g, rgb->b}),
                    std::max({rgb->r, rgb->g, rgb->b}));
}

/// A mean as the row takes it; nothing if it takes no numbers.
std::optional<Value> mean_for(const Parameter& row, const Spectrum& mean) {
  const auto bounded = [&](float value) {
    return std::clamp(double(value), row.minimum, row.maximum);
  };
  if (row.kind == ParameterKind::number || row.kind == ParameterKind::number_or_name)
    return Value(bounded(luminance_of(mean)));
  if (row.kind == ParameterKind::color)
    return Value(Rgb{bounded(mean[0]), bounded(mean[1]), bounded(mean[2])});
  return std::nullopt;
}

}  // namespace

const std::optional<Value>& SceneBuilder::value_of_spectrum(const Object& spectrum) {
  const auto [known, is_new] = spectra_.try_emplace(&spectrum);
  std::optional<Value>& value = known->second;
  if (!is_new) return value;
  const SpectrumType& type = *spectrum_type_of(spectrum);
  refuse_children(spectrum, {});
  const Arguments arguments = arguments_of(type.info, spectrum);
  if (arguments.is_complete()) collecting(spectrum.place, [&] { value = type.value(arguments); });
  return value;
}

std::vector<Property> SceneBuilder::properties_of(const TypeInfo& info, const Object& object) {
  std::vector<Property> properties =
      spectrum_type_of(object) ? spectrum_properties(info, object) : object.properties;
  for (const Child& child : object.children) {
    if (!spectrum_type_of(*child.object)) continue;
    const Parameter* row = spectrum_parameter(info, child.name);
    if (const std::optional<Value>& value = value_of_spectrum(*child.object))
      properties.push_back({row ? row->name : child.name, *value, child.object->place});
  }
  for (Property& property : properties)
    property.value = as_taken_by(info.find(property.name), property.value);
  for (const Child& child : object.children)
    if (const std::optional<Value> mean = mean_instead_of(info, child))
      properties.push_back({child.name, *mean, child.object->place});
  return properties;
}

std::optional<Value> SceneBuilder::mean_instead_of(const TypeInfo& info, const Child& child) {
  const bool is_texture = child.object->family == "texture" && !spectrum_type_of(*child.object);
  if (!is_texture || is_strict_ || (info.family != "bsdf" && info.family != "emitter"))
    return std::nullopt;
  const Parameter* row = info.find(child.name);
  if (!row || row->no_effect || texture_parameter(info, child.name)) return std::nullopt;
  const std::shared_ptr<Object>& given = texture_within(child.object);
  if (foreign_texture_in(*given) || asks_surface(*given)) return std::nullopt;
  const std::shared_ptr<const Texture> texture = make_texture(given, nullptr);
  const std::optional<Value> mean = texture ? mean_for(*row, texture->mean()) : std::nullopt;
  if (mean && left_out_.insert(given.get()).second)
    unknown_.add(fmt::format("'{}' of {} '{}' takes no texture: the mean of the texture stands "
                             "for it",
                             child.name, info.family, info.name),
                 child.object->place);
  return mean;
}

std::vector<Property> SceneBuilder::within_ranges(const TypeInfo& info,
                                                  std::vector<Property> properties) {
  for (Property& property : properties) {
    const Parameter* row = info.find(property.name);
    const bool is_of_file = property.place.file && property.place.line > 0;
    if (!row || !row->is_clamped || !is_of_file) continue;
    const auto* integer = std::get_if<int64_t>(&property.value);
    const auto* number = std::get_if<double>(&property.value);
    if (!integer && !number) continue;
    const double given = integer ? double(*integer) : *number;
    const double taken = std::clamp(given, row->minimum, row->maximum);
    if (taken == given || !std::isfinite(given)) continue;
    property.value = taken;
    unknown_.add(fmt::format("'{}' of {} '{}' is beyond its range: {:g} is taken",
                             property.spelling(), info.family, info.name, taken),
                 property.place);
  }
  return properties;
}

Arguments SceneBuilder::arguments_of(const TypeInfo& info, const Object& object) {
  const std::vector<Property> properties = properties_of(info, object);
  Arguments arguments(
      info,
      is_strict_ ? properties : within_ranges(info, unknown_.without_unknown(info, properties)),
      object.place, problems_);
  for (const Property& property : arguments.ignored())
    ignore(property, fmt::format("{} '{}'", info.family, info.name));
  return arguments;
}

}  // namespace kaustik
