#include "kaustik/loader/pbrt/picture_textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/lower_case.h"

namespace kaustik::pbrt {
namespace {

std::string extension_of(const std::string& file) {
  return lower_case(std::filesystem::path(file).extension().string());
}

/// "gamma 2.2".
std::optional<double> power_of(const std::string& encoding) {
  constexpr std::string_view word = "gamma ";
  if (!encoding.starts_with(word)) return std::nullopt;
  double power = 0;
  if (!parse_number(std::string_view(encoding).substr(word.size()), power) ||
      !(power > 0.01 && power < 10))
    return std::nullopt;
  return power;
}

}  // namespace

std::shared_ptr<Object> missing_picture(const Place& place) {
  auto board = described("texture", "checkerboard", place);
  set(*board, "color0", Rgb{1, 0, 1});
  set(*board, "color1", Rgb{0, 0, 0});
  set(*board, "to_uv", Transform::scale({8, 8, 1}));
  return board;
}

bool is_readable_picture(const std::string& file) { return extension_of(file) != ".qoi"; }

std::shared_ptr<Object> make_bitmap(const PictureTexture& picture, SceneFiles& files,
                                    Deviations& deviations, const std::string& object,
                                    const Place& place) {
  const auto path = files.find(picture.file, place);
  if (!path || !is_readable_picture(path->string())) {
    deviations.missing(
        object,
        fmt::format("picture {} {}", shown(picture.file),
                    path ? "is of a format that Kaustik does not read" : "is not there"),
        place, path ? "convert it to PNG or EXR" : where_files_lie);
    return missing_picture(place);
  }
  auto bitmap = described("texture", "bitmap", place);
  set(*bitmap, "filename", path->string());
  if (picture.filter == "point") set(*bitmap, "filter_type", std::string("nearest"));
  if (picture.wrap == "black")
    set(*bitmap, "wrap_mode", std::string("zero"));
  else if (picture.wrap == "clamp" || picture.wrap == "octahedralsphere")
    set(*bitmap, "wrap_mode", std::string("clamp"));
  if (picture.wrap == "octahedralsphere")
    deviations.approximated(object, "wrap 'octahedralsphere' keeps the edge's colour", place);
  // pbrt asks for the encoding of PNG files alone.
  const bool is_png = extension_of(picture.file) == ".png";
  const std::string encoding = is_png ? picture.encoding : std::string();
  if (encoding == "linear" || picture.is_raw)
    set(*bitmap, "raw", true);
  else if (const auto power = power_of(encoding))
    set(*bitmap, "gamma", *power);
  if (picture.is_number) set(*bitmap, "channel", std::string("number"));
  if (picture.is_inverted) set(*bitmap, "invert", true);
  if (picture.power != 1) set(*bitmap, "power", picture.power);
  set(*bitmap, "to_uv",
      Transform::translate({0, 1, 0}) * Transform::scale({1, -1, 1}) * picture.mapping);
  return bitmap;
}

}  // namespace kaustik::pbrt
