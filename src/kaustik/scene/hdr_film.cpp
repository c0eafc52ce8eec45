#include <fmt/format.h>

#include <cmath>

#include "kaustik/scene/camera_kinds.h"

namespace kaustik {
namespace {

using Rows = std::vector<Parameter>;

/// What all films take.
Rows film_rows() {
  return {
      integer_parameter("width", 768, "Width of the picture.").range(1, 1 << 20).in("pixels"),
      integer_parameter("height", 576, "Height of the picture.").range(1, 1 << 20).in("pixels"),
      integer_parameter("crop_offset_x", 0, "Left edge of the crop window.")
          .range(0, 1 << 20)
          .in("pixels"),
      integer_parameter("crop_offset_y", 0, "Upper edge of the crop window.")
          .range(0, 1 << 20)
          .in("pixels"),
      optional(integer_parameter("crop_width", 1,
                                 "Width of the crop window; up to the right edge if absent.")
                   .range(1, 1 << 20)
                   .in("pixels")),
      optional(integer_parameter("crop_height", 1,
                                 "Height of the crop window; down to the lower edge if absent.")
                   .range(1, 1 << 20)
                   .in("pixels")),
      number_parameter("exposure", 0,
                       "Exposure added by tone mapping operators that take one. Files that hold "
                       "radiance are not changed.")
          .range(-100, 100)
          .in("stops"),
      number_parameter("iso", 100, "Sensitivity. Twice the value is one stop more exposure.")
          .range(1e-3, 1e9),
      choice_parameter("quantity", "radiance", {"radiance", "irradiance"},
                       "Radiance in W/(sr m²), or irradiance in W/m² on the visible side of the "
                       "first surface behind each pixel, whatever its material."),
      choice_parameter("color", "rgb", {"rgb", "spectral"},
                       "What light is made of: red, green and blue, or wavelengths from 360 to "
                       "830 nm. With wavelengths glass disperses, and measured spectra count as "
                       "they are. The picture is red, green and blue in both cases."),
      choice_parameter("layers", "all", {"all", "none"},
                       "Layers of EXR images beside the picture and the emission of lamps: "
                       "components, albedo, normal, depth, error and noise of each pixel, or none, "
                       "which saves memory. Other images have no layers."),
      ignored_parameter("file_format", ParameterKind::text),
      ignored_parameter("pixel_format", ParameterKind::text),
      ignored_parameter("component_format", ParameterKind::text),
      ignored_parameter("sample_border", ParameterKind::boolean),
      ignored_parameter("compensate", ParameterKind::boolean),
      ignored_parameter("banner", ParameterKind::boolean),
      ignored_parameter("high_quality_edges", ParameterKind::boolean),
      ignored_parameter("attach_log", ParameterKind::boolean),
      ignored_parameter("gamma", ParameterKind::number)};
}

/// A film of another name and of Mitsuba's own parameters.
TypeInfo foreign_film(const std::string& name, const std::string& sentence, const Rows& beside) {
  TypeInfo info{"film", name, sentence + " Here: hdrfilm.", film_rows()};
  info.parameters.insert(info.parameters.end(), beside.begin(), beside.end());
  return info;
}

std::vector<TypeInfo> make_film_infos() {
  using enum ParameterKind;
  const Rows display = {ignored_parameter("tonemap_method", text), ignored_parameter("key", number),
                        ignored_parameter("burn", number)};
  return {{"film", "hdrfilm", "The picture: its size, crop window, pixel filter and content.",
           film_rows()},
          foreign_film("ldrfilm", "Mitsuba 0.6's film of pictures for displays.", display),
          foreign_film("mfilm", "Mitsuba 0.6's film of tables.",
                       {ignored_parameter("digits", integer), ignored_parameter("variable", text)}),
          foreign_film("tiledhdrfilm", "Mitsuba 0.6's film of large pictures.", {}),
          foreign_film("exrfilm", "Mitsuba 0.2's film of OpenEXR pictures.",
                       {ignored_parameter("alpha", boolean)}),
          foreign_film("pngfilm", "Mitsuba 0.2's film of PNG pictures.",
                       {ignored_parameter("alpha", boolean), ignored_parameter("bpp", integer),
                        ignored_parameter("tone_mapping_method", text),
                        ignored_parameter("reinhard_key", number),
                        ignored_parameter("reinhard_burn", number)}),
          foreign_film("specfilm", "Mitsuba's film of spectral bands.", {})};
}

FilmSettings create_hdr_film(const Arguments& arguments) {
  FilmSettings film;
  film.place = arguments.place();
  if (arguments.text("quantity") == "irradiance") film.quantity = Quantity::irradiance;
  film.is_spectral = arguments.text("color") == "spectral";
  film.layers = arguments.text("layers") == "all";
  film.exposure = float(arguments.number("exposure") + std::log2(arguments.number("iso") / 100));
  film.size = {int(arguments.integer("width")), int(arguments.integer("height"))};
  film.crop_offset = {int(arguments.integer("crop_offset_x")),
                      int(arguments.integer("crop_offset_y"))};
  film.crop_size = film.size - film.crop_offset;
  if (arguments.given("crop_width")) film.crop_size.x = int(arguments.integer("crop_width"));
  if (arguments.given("crop_height")) film.crop_size.y = int(arguments.integer("crop_height"));
  if (film.crop_size.x < 1 || film.crop_size.y < 1 ||
      film.crop_offset.x + film.crop_size.x > film.size.x ||
      film.crop_offset.y + film.crop_size.y > film.size.y)
    throw Error(
        ErrorKind::input,
        fmt::format("the crop window of {}×{} pixels at ({}, {}) leaves the picture",
                    film.crop_size.x, film.crop_size.y, film.crop_offset.x, film.crop_offset.y),
        fmt::format("keep it within {}×{}", film.size.x, film.size.y), arguments.place());
  return film;
}

}  // namespace

std::vector<FilmType> hdr_film_types() {
  static const std::vector<TypeInfo> infos = make_film_infos();
  std::vector<FilmType> types;
  for (const TypeInfo& info : infos) types.push_back({info, create_hdr_film});
  return types;
}

}  // namespace kaustik
