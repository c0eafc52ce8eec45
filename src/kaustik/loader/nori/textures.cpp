#include <fmt/format.h>

#include "kaustik/loader/nori/materials.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/stand_ins.h"

namespace kaustik::nori {
namespace {

/// The square (i, j) of Nori begins at uv = scale·((i, j) + delta). Here one is half a unit wide.
Transform squares_transform(Given& given) {
  const Vec3d size = given.point({"scale"}).value_or(Vec3d(1, 1, 0));
  const Vec3d begin = given.point({"delta"}).value_or(Vec3d(0, 0, 0));
  const auto factor = [](double side) { return side == 0 ? 1 : 1 / side; };
  return Transform::scale({0.5, 0.5, 1}) * Transform::translate({-begin.x, -begin.y, 0}) *
         Transform::scale({factor(size.x), factor(size.y), 1});
}

std::shared_ptr<Object> checkerboard_of(Given& given) {
  auto texture = make_object("texture", "checkerboard", given.element().place);
  give(*texture, "color0", given.colour({"value1"}).value_or(Rgb{0, 0, 0}));
  give(*texture, "color1", given.colour({"value2"}).value_or(Rgb{1, 1, 1}));
  give(*texture, "to_uv", squares_transform(given));
  return texture;
}

}  // namespace

std::shared_ptr<Object> texture_of(const Object& element, Reading& reading) {
  Given given(element, reading.deviations);
  reading.ignore_parts(element);
  if (element.type.starts_with("checkerboard")) return checkerboard_of(given);
  if (element.type.starts_with("constant")) {
    const auto colour = given.colour({"value", "color", "albedo"});
    auto texture = make_object("texture", "scale", element.place);
    give(*texture, "value", colour.value_or(Rgb{0.5, 0.5, 0.5}));
    return texture;
  }
  if (const auto file = given.text({"filename", "path"}); file && !file->empty()) {
    const auto path = reading.path_of(*file, given.place_of({"filename", "path"}),
                                      "a magenta checker stands for it");
    if (!path) return missing_texture(element.place);
    auto texture = make_object("texture", "bitmap", element.place);
    give(*texture, "filename", *path);
    return texture;
  }
  reading.ignored(element, "there is no such texture here: its place is as if nothing was given");
  return nullptr;
}

}  // namespace kaustik::nori
