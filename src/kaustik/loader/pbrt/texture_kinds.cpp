// What pbrt's textures are made of here, kind by kind.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kaustik/base/color.h"
#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/picture_textures.h"
#include "kaustik/loader/pbrt/texture_mixes.h"
#include "kaustik/loader/pbrt/textures.h"

namespace kaustik::pbrt {
namespace {

/// A curve as the colour that it has in white light.
Rgb colour_of(const Value& value) {
  if (const auto* curve = std::get_if<SpectralCurve>(&value)) return rgb_from_reflectance(*curve);
  return as_colour(value).value_or(Rgb{1, 1, 1});
}

Input times(Input input, const Value& factor, const Place& place) {
  if (input.texture) {
    auto scaled = described("texture", "scale", place);
    set(*scaled, "scale", factor);
    hold(*scaled, "value", input.texture);
    return {{}, scaled};
  }
  if (const auto number = as_number(factor)) {
    multiply_value(*input.value, *number);
    return input;
  }
  const Rgb a = colour_of(*input.value), b = colour_of(factor);
  return {Value(Rgb{a.r * b.r, a.g * b.g, a.b * b.b}), nullptr};
}

}  // namespace

Input Textures::part(const TextureDefinition& definition, const char* name, double otherwise) {
  const Input given = definition.is_float ? number(definition.parameters, name, definition.owner)
                                          : colour(definition.parameters, name, definition.owner);
  return given.is_given() ? given : Input{otherwise, nullptr};
}

const std::map<std::string_view, Textures::Maker>& Textures::makers() {
  using T = Textures;
  static const std::map<std::string_view, Maker> rows = {
      {"bilerp", &T::make_bilinear},   {"checkerboard", &T::make_checkerboard},
      {"constant", &T::make_constant}, {"directionmix", &T::make_mix},
      {"dots", &T::make_dots},         {"fbm", &T::make_noise},
      {"imagemap", &T::make_image},    {"marble", &T::make_noise},
      {"mix", &T::make_mix},           {"ptex", &T::make_ptex},
      {"scale", &T::make_scale},       {"windy", &T::make_noise},
      {"wrinkled", &T::make_noise},
  };
  return rows;
}

Input Textures::make(const TextureDefinition& definition) {
  const auto maker = makers().find(definition.type);
  if (maker != makers().end()) return (this->*maker->second)(definition);
  deviations_.missing(
      definition.owner.object,
      fmt::format("there is no texture of type {}: it is grey", shown(definition.type)),
      definition.parameters.place(), did_you_mean(definition.type, names_in(makers())));
  return {0.5, nullptr};
}

Input Textures::make_constant(const TextureDefinition& definition) {
  return part(definition, "value", 1);
}

Input Textures::make_image(const TextureDefinition& definition) {
  return make_picture(definition, 1);
}

Input Textures::make_dots(const TextureDefinition& definition) {
  deviations_.approximated(definition.owner.object, "dots are left out: all is as outside",
                           definition.parameters.place());
  definition.parameters.accept({"inside", "mapping", "uscale", "vscale", "udelta", "vdelta"});
  return part(definition, "outside", 0);
}

Input Textures::make_ptex(const TextureDefinition& definition) {
  deviations_.missing(definition.owner.object, "Ptex files can't be read: it is grey",
                      definition.parameters.place(), "convert it to a picture over uv");
  definition.parameters.accept({"filename", "encoding", "scale"});
  return {0.5, nullptr};
}

Input Textures::make_scale(const TextureDefinition& definition) {
  const Place& place = definition.parameters.place();
  // v3 calls the two tex1 and tex2.
  const bool is_old = definition.parameters.has("tex1") || definition.parameters.has("tex2");
  Input value = part(definition, is_old ? "tex1" : "tex", 1);
  Input factor = is_old ? part(definition, "tex2", 1)
                        : number(definition.parameters, "scale", definition.owner);
  if (!factor.is_given()) factor.value = 1.0;
  if (value.value && factor.texture) std::swap(value, factor);
  if (const auto number = factor.value ? as_number(*factor.value) : std::nullopt;
      number && *number < 0) {
    factor.value = -*number;
    deviations_.approximated(definition.owner.object,
                             "its factor is negative, and counts as positive: relief is turned "
                             "inside out",
                             place);
  }
  if (factor.value) return times(value, *factor.value, place);
  if (is_old && !definition.is_float)
    deviations_.approximated(definition.owner.object,
                             "of its two textures the second makes the first one darker, but does "
                             "not colour it",
                             place);
  return mixed({0.0, nullptr}, value, factor, place);
}

Input Textures::make_mix(const TextureDefinition& definition) {
  const Place& place = definition.parameters.place();
  const Input first = part(definition, "tex1", 0), second = part(definition, "tex2", 1);
  Input amount = number(definition.parameters, "amount", definition.owner);
  if (definition.type == "directionmix") {
    definition.parameters.accept({"dir"});
    deviations_.approximated(definition.owner.object,
                             "its two textures are mixed evenly, whatever the direction", place);
    amount = {0.5, nullptr};
  }
  if (!amount.is_given()) amount.value = 0.5;
  return mixed(first, second, amount, place);
}

Input Textures::make_checkerboard(const TextureDefinition& definition) {
  const Place& place = definition.parameters.place();
  const Input first = part(definition, "tex1", 1), second = part(definition, "tex2", 0);
  if (definition.parameters.integer("dimension", 2) == 3)
    deviations_.approximated(definition.owner.object,
                             "its cubes in space are squares on the surface", place);
  definition.parameters.accept({"aamode"});
  auto board = described("texture", "checkerboard", place);
  set(*board, "color0", first);
  set(*board, "color1", second);
  // Ours has two squares in a unit.
  set(*board, "to_uv", Transform::scale({0.5, 0.5, 1}) * mapping(definition));
  return {{}, board};
}

Input Textures::make_bilinear(const TextureDefinition& definition) {
  const Place& place = definition.parameters.place();
  std::vector<float> pixels;
  // The rows of a picture begin at its upper edge, where v is 1.
  for (const auto& [name, otherwise] :
       {std::pair("v01", 1.0), {"v11", 1.0}, {"v00", 0.0}, {"v10", 0.0}}) {
    const Input corner = part(definition, name, otherwise);
    const auto colour = corner.value ? as_colour(*corner.value) : std::nullopt;
    if (!colour)
      deviations_.approximated(definition.owner.object, "a corner that is no plain colour is grey",
                               place);
    const Rgb c = colour.value_or(Rgb{0.5, 0.5, 0.5});
    pixels.insert(pixels.end(), {float(c.r), float(c.g), float(c.b)});
  }
  auto corners = described("texture", "bitmap", place);
  set(*corners, "data", Value(Array::of<float>({2, 2, 3}, std::move(pixels))));
  set(*corners, "raw", true);
  set(*corners, "wrap_mode", std::string("clamp"));
  // From the middle of a pixel to that of the next.
  set(*corners, "to_uv",
      Transform::translate({0.25, 0.75, 0}) * Transform::scale({0.5, -0.5, 1}) *
          mapping(definition));
  return {{}, corners};
}

Input Textures::make_noise(const TextureDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const Place& place = list.place();
  deviations_.approximated(
      definition.owner.object,
      fmt::format("the noise of {} is Kaustik's own, of about its size", shown(definition.type)),
      place);
  const bool is_marble = definition.type == "marble" && !definition.is_float;
  auto noise = described("texture", is_marble ? "marble" : "noise", place);
  const double scale = list.number("scale", 1);
  list.accept({"variation", "mapping"});
  set(*noise, "scale", std::clamp(1 / std::max(scale, 1e-6), 1e-6, 1e6));
  const int octaves = std::clamp(list.integer("octaves", 8), 1, 16);
  const double roughness = std::clamp(list.number("roughness", 0.5), 0.0, 1.0);
  if (!is_marble) {
    set(*noise, "octaves", int64_t{octaves});
    set(*noise, "roughness", roughness);
  }
  return {{}, noise};
}

Input Textures::make_picture(const TextureDefinition& definition, double power) {
  const ParameterList& list = definition.parameters;
  list.accept({"maxanisotropy", "trilinear", "filter"});
  PictureTexture wanted;
  wanted.file = list.text("filename");
  wanted.filter = list.text("filter", "bilinear");
  wanted.wrap = list.text("wrap", "repeat");
  wanted.encoding = list.text("encoding");
  // v3: whether it is encoded.
  if (list.has("gamma")) wanted.encoding = list.flag("gamma", true) ? "sRGB" : "linear";
  wanted.mapping = mapping(definition);
  wanted.power = power;
  wanted.is_number = definition.is_float;
  wanted.is_inverted = list.flag("invert", false);
  const std::shared_ptr<Object> bitmap =
      make_bitmap(wanted, files_, deviations_, definition.owner.object, list.place());
  const double scale = list.number("scale", 1);
  if (scale == 1) return {{}, bitmap};
  if (wanted.is_inverted)
    deviations_.approximated(definition.owner.object, "it is inverted, and then scaled",
                             list.place_of("invert"));
  return times({{}, bitmap}, std::clamp(std::pow(std::max(scale, 0.0), power), 0.0, 1e6),
               list.place());
}

std::shared_ptr<Object> Textures::picture(const std::string& file, bool raw, const Owner& owner,
                                          const Place& place) {
  laid_by(SurfaceMappings::by_uv);
  PictureTexture wanted;
  wanted.file = file;
  wanted.is_raw = raw;
  return make_bitmap(wanted, files_, deviations_, owner.object, place);
}

Transform Textures::mapping(const TextureDefinition& definition) {
  const ParameterList& list = definition.parameters;
  const std::string kind = list.text("mapping", "uv");
  const auto number = [&](const char* name, double otherwise) {
    return list.number(name, otherwise);
  };
  const double delta_u = number("udelta", 0), delta_v = number("vdelta", 0);
  if (const auto in_space = mapping_kind_named(kind)) {
    SurfaceMapping made;
    made.kind = *in_space;
    made.world_from_texture = definition.to_world;
    made.along_u = list.point("v1").value_or(made.along_u);
    made.along_v = list.point("v2").value_or(made.along_v);
    made.delta_u = delta_u;
    made.delta_v = delta_v;
    made.name = kind;
    made.object = definition.owner.object;
    made.place = list.place_of("mapping");
    laid_by(mappings_.index_of(std::move(made)));
    return {};
  }
  if (kind != "uv")
    deviations_.approximated(
        definition.owner.object,
        fmt::format("there is no mapping {}: it lies by the surface's uv", shown(kind)),
        list.place_of("mapping"), did_you_mean(kind, {"uv", "planar", "spherical", "cylindrical"}));
  laid_by(SurfaceMappings::by_uv);
  const double scale_u = number("uscale", 1), scale_v = number("vscale", 1);
  const double rows[4][4] = {
      {scale_u, 0, 0, delta_u}, {0, scale_v, 0, delta_v}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  return scale_u != 0 && scale_v != 0 ? Transform(rows) : Transform::collapsing(rows);
}

}  // namespace kaustik::pbrt
