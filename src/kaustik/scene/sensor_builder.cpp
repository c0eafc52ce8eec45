// The camera's part of SceneBuilder: sensor, film, filter, sampler.
#include <fmt/format.h>

#include "kaustik/scene/filter_kinds.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {

void SceneBuilder::make_sensor(const Object& object) {
  const CameraType* type = find_row(camera_types(), object.type);
  if (!type && is_foreign(object, names_of(camera_types()))) {
    use_instead(object, names_of(camera_types()), "perspective");
    type = find_row(camera_types(), "perspective");
  }
  if (!type) {
    unknown_type(object, names_of(camera_types()));
    return;
  }
  refuse_children(object, {"film", "sampler", "medium"});
  camera_medium_ = medium_of(object);
  const Object* film = nullptr;
  for (const Child& child : object.children) {
    if (child.object->family != "film") continue;
    if (film)
      problems_.add("the camera has a second film", keep_one(film->place), child.object->place);
    film = child.object.get();
  }
  static const Object default_film{"film", "hdrfilm", "", {}, {}, {}};
  read_film(film ? *film : default_film);
  for (const Child& child : object.children)
    if (child.object->family == "sampler") read_sampler(*child.object);
  const Arguments arguments = arguments_of(type->info, object);
  camera_ = type->create(arguments, film_);
}

void SceneBuilder::use_instead(const Object& object, const std::vector<std::string>& valid,
                               const std::string& instead) {
  if (is_strict_) {
    unknown_type(object, valid);
    return;
  }
  warnings_.push_back(fmt::format("{}: unknown {} type '{}': '{}' is used instead; {}",
                                  text_of(object.place), object.family, object.type, instead,
                                  suggest(object.type, valid)));
}

void SceneBuilder::read_film(const Object& object) {
  const FilmType* type = find_row(film_types(), object.type);
  if (!type) {
    use_instead(object, names_of(film_types()), "hdrfilm");
    read_film({"film", "hdrfilm", "", object.properties, object.children, object.place});
    return;
  }
  const Arguments arguments = arguments_of(type->info, object);
  collecting(object.place, [&] { film_ = type->create(arguments); });
  refuse_children(object, {"rfilter"});
  film_.filter = gaussian_filter(0.5f, 2.0f);
  for (const Child& child : object.children)
    if (child.object->family == "rfilter") read_filter(*child.object);
}

void SceneBuilder::read_filter(const Object& object) {
  const FilterType* type = find_row(filter_types(), object.type);
  if (!type) {
    use_instead(object, names_of(filter_types()), "gaussian");
    return;
  }
  refuse_children(object, {});
  film_.filter = type->create(arguments_of(type->info, object));
}

void SceneBuilder::read_sampler(const Object& object) {
  const TypeInfo* info = find_row(sampler_infos(), object.type);
  if (!info) {
    use_instead(object, names_of(sampler_infos()), "independent");
    read_sampler({"sampler", "independent", "", object.properties, object.children, object.place});
    return;
  }
  refuse_children(object, {});
  const Arguments arguments = arguments_of(*info, object);
  if (arguments.given("sample_count")) film_.sample_count = int(arguments.integer("sample_count"));
}

}  // namespace kaustik
