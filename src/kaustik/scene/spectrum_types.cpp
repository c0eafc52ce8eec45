#include "kaustik/scene/spectrum_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/number_list.h"
#include "kaustik/base/spectral_value.h"
#include "kaustik/scene/find_row.h"

namespace kaustik {
namespace {

constexpr double first_visible_nm = Wavelengths::first_nm, last_visible_nm = Wavelengths::last_nm;

[[noreturn]] void refuse(const Arguments& arguments, const std::string& name,
                         const std::string& message, const std::string& remedy) {
  throw Error(ErrorKind::input, message, remedy, arguments.place_of(name));
}

std::vector<double> number_list(const Arguments& arguments, const std::string& name) {
  auto [numbers, wrong_word] = parse_number_list(arguments.text(name));
  if (!wrong_word.empty())
    refuse(arguments, name,
           fmt::format("'{}' holds '{}', which is no finite number", name, wrong_word),
           "list numbers, as in \"0.1, 0.5, 0.2\"");
  if (numbers.size() < 2)
    refuse(arguments, name, fmt::format("'{}' has fewer than two numbers", name),
           "list one for each wavelength, at least two");
  return numbers;
}

/// From `wavelength_min` to `wavelength_max`.
std::pair<double, double> wavelength_range(const Arguments& arguments) {
  const double low = arguments.number("wavelength_min"), high = arguments.number("wavelength_max");
  if (!(low < high))
    refuse(arguments, "wavelength_max",
           fmt::format("'wavelength_max' is {}, not above 'wavelength_min', {}", high, low),
           "give the longer wavelength as the maximum, in nanometres");
  return {low, high};
}

Parameter wavelength_parameter(const std::string& name, double value, const std::string& sentence) {
  return number_parameter(name, value, sentence).range(1, 1e6).in("nm");
}

/// In steps of 1 nm as far as anybody sees, with both ends; 0 if that is nothing.
template <typename Function>
Value sampled(double low, double high, const Function& function) {
  low = std::max(low, first_visible_nm);
  high = std::min(high, last_visible_nm);
  if (!(low < high)) return 0.0;
  SpectralCurve curve;
  for (double nm = low; nm < high; nm = std::floor(nm) + 1)
    curve.samples.emplace_back(nm, function(nm));
  curve.samples.emplace_back(high, function(high));
  return curve;
}

Value value_of_blackbody(const Arguments& arguments) {
  const auto [low, high] = wavelength_range(arguments);
  const SpectralFunctionPointer planck = blackbody(arguments.number("temperature"));
  const double scale = arguments.number("scale");
  return sampled(low, high, [&](double nm) { return scale * planck->at(nm); });
}

const TypeInfo& blackbody_info() {
  static const TypeInfo info{
      "texture",
      "blackbody",
      "Radiance of a black body by Planck's law, W/(sr·m²·nm).",
      {required(number_parameter("temperature", 5000, "Temperature of the black body."))
           .range(1, 1e6)
           .in("K"),
       number_parameter("scale", 1, "Factor on the radiance.").range(0, 1e30),
       wavelength_parameter("wavelength_min", 360, "Shorter wavelengths are left out."),
       wavelength_parameter("wavelength_max", 830, "Longer wavelengths are left out.")}};
  return info;
}

Value value_of_d65(const Arguments& arguments) {
  const double scale = arguments.number("scale");
  if (!arguments.has("color")) return scale;
  const std::variant<Rgb, SpectralCurve> color = arguments.color("color");
  if (const auto* rgb = std::get_if<Rgb>(&color))
    return Rgb{rgb->r * scale, rgb->g * scale, rgb->b * scale};
  const SpectralFunctionPointer share = tabulated_within(std::get<SpectralCurve>(color));
  return sampled(first_visible_nm, last_visible_nm, [&](double nm) {
    const auto x = float(nm);
    return scale * share->at(nm) * double(d65_at_wavelengths({x, x, x, x})[0]);
  });
}

const TypeInfo& d65_info() {
  static const TypeInfo info{
      "texture",
      "d65",
      "White light: the CIE's daylight D65 with luminance 1.",
      {number_parameter("scale", 1, "Factor on the radiance. A nested texture is not scaled.")
           .range(0, 1e30),
       optional(
           color_parameter(
               "color", 1,
               "Colour that multiplies daylight. A nested texture of any name may replace it."))
           .textured()}};
  return info;
}

Value value_of_regular(const Arguments& arguments) {
  const auto [low, high] = wavelength_range(arguments);
  const std::vector<double> values = number_list(arguments, "values");
  SpectralCurve curve;
  const double step = (high - low) / double(values.size() - 1);
  for (size_t i = 0; i < values.size(); ++i)
    curve.samples.emplace_back(i + 1 < values.size() ? low + step * double(i) : high, values[i]);
  return curve;
}

const TypeInfo& regular_info() {
  static const TypeInfo info{
      "texture",
      "regular",
      "A curve with values at equal distances, linear between them and zero outside.",
      {required(wavelength_parameter("wavelength_min", 360, "Wavelength of the first value.")),
       required(wavelength_parameter("wavelength_max", 830, "Wavelength of the last value.")),
       required(text_parameter("values", "", "Values, at least two."))}};
  return info;
}

Value value_of_irregular(const Arguments& arguments) {
  const std::vector<double> wavelengths = number_list(arguments, "wavelengths"),
                            values = number_list(arguments, "values");
  if (wavelengths.size() != values.size())
    refuse(arguments, "values",
           fmt::format("there are {} values at {} wavelengths", values.size(), wavelengths.size()),
           "give one value for each wavelength");
  SpectralCurve curve;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!(wavelengths[i] > (i > 0 ? wavelengths[i - 1] : 0.0)))
      refuse(arguments, "wavelengths",
             i > 0 ? fmt::format("wavelength {} follows {}", wavelengths[i], wavelengths[i - 1])
                   : fmt::format("wavelength {} is not positive", wavelengths[i]),
             "list wavelengths in nanometres, each once, in increasing order");
    curve.samples.emplace_back(wavelengths[i], values[i]);
  }
  return curve;
}

const TypeInfo& irregular_info() {
  static const TypeInfo info{
      "texture",
      "irregular",
      "A curve with values at given wavelengths, linear between them and zero outside.",
      {required(text_parameter("wavelengths", "", "Wavelengths in nm, ascending, at least two.")),
       required(text_parameter("values", "", "One value for each wavelength."))}};
  return info;
}

Value value_of_uniform(const Arguments& arguments) { return arguments.number("value"); }

const TypeInfo& uniform_info() {
  static const TypeInfo info{
      "texture",
      "uniform",
      "One number for all colour channels. On a lamp it is white, as in Mitsuba's RGB mode.",
      {required(number_parameter("value", 1, "The number.")),
       ignored_parameter("wavelength_min", ParameterKind::number),
       ignored_parameter("wavelength_max", ParameterKind::number)}};
  return info;
}

/// A grey as one number, which parameters that are no colours take, too.
Value value_of_color(const Arguments& arguments, const char* name) {
  const std::variant<Rgb, SpectralCurve> color = arguments.color(name);
  if (const auto* curve = std::get_if<SpectralCurve>(&color)) return *curve;
  const Rgb& rgb = std::get<Rgb>(color);
  return rgb.r == rgb.g && rgb.g == rgb.b ? Value(rgb.r) : Value(rgb);
}

Value value_of_srgb(const Arguments& arguments) { return value_of_color(arguments, "color"); }

const TypeInfo& srgb_info() {
  static const TypeInfo info{"texture",
                             "srgb",
                             "A linear Rec. 709 colour.",
                             {required(color_parameter("color", 1, "The colour.")),
                              ignored_parameter("unbounded", ParameterKind::boolean)}};
  return info;
}

Value value_of_rawconstant(const Arguments& arguments) {
  return value_of_color(arguments, "value");
}

const TypeInfo& rawconstant_info() {
  static const TypeInfo info{"texture",
                             "rawconstant",
                             "One number or three, taken as they are.",
                             {required(color_parameter("value", 1, "The number, or a vector."))}};
  return info;
}

/// What it holds of textures that are no spectra; null: none.
const std::shared_ptr<Object>* find_texture(const Object& object) {
  for (const Child& child : object.children)
    if (child.object->family == "texture" && !find_row(spectrum_types(), child.object->type))
      return &child.object;
  return nullptr;
}

}  // namespace

const std::vector<SpectrumType>& spectrum_types() {
  static const std::vector<SpectrumType> types = {
      {blackbody_info(), value_of_blackbody}, {d65_info(), value_of_d65},
      {irregular_info(), value_of_irregular}, {rawconstant_info(), value_of_rawconstant},
      {regular_info(), value_of_regular},     {srgb_info(), value_of_srgb},
      {uniform_info(), value_of_uniform}};
  return types;
}

const SpectrumType* spectrum_type_of(const Object& object) {
  if (object.family != "texture") return nullptr;
  const SpectrumType* type = find_row(spectrum_types(), object.type);
  return type && &type->info == &d65_info() && find_texture(object) ? nullptr : type;
}

const std::shared_ptr<Object>& texture_within(const std::shared_ptr<Object>& object) {
  if (object->family != "texture" || object->type != d65_info().name) return object;
  const std::shared_ptr<Object>* texture = find_texture(*object);
  return texture ? *texture : object;
}

std::vector<Property> spectrum_properties(const TypeInfo& info, const Object& spectrum) {
  std::vector<Property> properties = spectrum.properties;
  for (Property& property : properties) {
    const Parameter* row = info.find(property.name);
    const auto* vector = std::get_if<Vec3d>(&property.value);
    if (row && row->kind == ParameterKind::color && vector)
      property.value = Rgb{vector->x, vector->y, vector->z};
  }
  return properties;
}

}  // namespace kaustik
