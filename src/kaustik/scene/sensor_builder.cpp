// The camera's part of SceneBuilder: sensor, film, filter, sampler.
#include <fmt/format.h>

#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

const TypeInfo* find_info(const std::vector<TypeInfo>& infos, const std::string& name) {
  for (const TypeInfo& info : infos)
    if (info.name == name) return &info;
  return nullptr;
}

std::vector<std::string> names_of(const std::vector<TypeInfo>& infos) {
  std::vector<std::string> names;
  for (const TypeInfo& info : infos) names.push_back(info.name);
  return names;
}

}  // namespace

void SceneBuilder::make_sensor(const Object& object) {
  if (object.type != Camera::info().name) {
    unknown_type(object, {Camera::info().name});
    return;
  }
  refuse_children(object, {"film", "sampler", "medium"});
  camera_medium_ = medium_of(object);
  const Object* film = nullptr;
  for (const Child& child : object.children) {
    if (child.object->family == "film") {
      if (film)
        problems_.add("the camera has a second film",
                      fmt::format("keep one; the first is on line {}", film->place.line),
                      child.object->place);
      film = child.object.get();
    } else if (child.object->family == "sampler") {
      read_sampler(*child.object);
    }
  }
  static const Object default_film{"film", "hdrfilm", "", {}, {}, {}};
  read_film(film ? *film : default_film);
  const Arguments arguments = arguments_of(Camera::info(), object);
  camera_ = std::make_unique<Camera>(arguments, film_);
}

void SceneBuilder::read_film(const Object& object) {
  if (object.type != film_info().name) {
    unknown_type(object, {film_info().name});
    return;
  }
  const Arguments arguments = arguments_of(film_info(), object);
  film_.place = object.place;
  if (arguments.text("quantity") == "irradiance") film_.quantity = Quantity::irradiance;
  film_.size = {int(arguments.integer("width")), int(arguments.integer("height"))};
  film_.crop_offset = {int(arguments.integer("crop_offset_x")),
                       int(arguments.integer("crop_offset_y"))};
  film_.crop_size = film_.size - film_.crop_offset;
  if (arguments.given("crop_width")) film_.crop_size.x = int(arguments.integer("crop_width"));
  if (arguments.given("crop_height")) film_.crop_size.y = int(arguments.integer("crop_height"));
  if (film_.crop_size.x < 1 || film_.crop_size.y < 1 ||
      film_.crop_offset.x + film_.crop_size.x > film_.size.x ||
      film_.crop_offset.y + film_.crop_size.y > film_.size.y)
    problems_.add(
        fmt::format("the crop window of {}×{} pixels at ({}, {}) leaves the picture",
                    film_.crop_size.x, film_.crop_size.y, film_.crop_offset.x, film_.crop_offset.y),
        fmt::format("keep it within {}×{}", film_.size.x, film_.size.y), object.place);
  refuse_children(object, {"rfilter"});
  film_.filter = PixelFilter(PixelFilter::Kind::gaussian, 2.0f, 0.5f);
  for (const Child& child : object.children)
    if (child.object->family == "rfilter") read_filter(*child.object);
}

void SceneBuilder::read_filter(const Object& object) {
  const TypeInfo* info = find_info(filter_infos(), object.type);
  if (!info) {
    unknown_type(object, names_of(filter_infos()));
    return;
  }
  refuse_children(object, {});
  const Arguments arguments = arguments_of(*info, object);
  if (info->name == "gaussian") {
    const auto stddev = float(arguments.number("stddev"));
    film_.filter = PixelFilter(PixelFilter::Kind::gaussian, 4 * stddev, stddev);
  } else {
    film_.filter =
        PixelFilter(info->name == "box" ? PixelFilter::Kind::box : PixelFilter::Kind::tent,
                    float(arguments.number("radius")), 0);
  }
}

void SceneBuilder::read_sampler(const Object& object) {
  const TypeInfo* info = find_info(sampler_infos(), object.type);
  if (!info) {
    unknown_type(object, names_of(sampler_infos()));
    return;
  }
  refuse_children(object, {});
  const Arguments arguments = arguments_of(*info, object);
  if (arguments.given("sample_count")) film_.sample_count = int(arguments.integer("sample_count"));
}

}  // namespace kaustik
