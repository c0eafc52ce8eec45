// The camera's part of SceneBuilder: sensor, film, filter, sampler.
#include <fmt/format.h>

#include "kaustik/scene/filter_kinds.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/spectrum_types.h"

namespace kaustik {

void SceneBuilder::make_sensor(const Object& object) {
  const CameraType* type = find_row(camera_types(), object.type);
  if (!type)
    if (const Object* known = sensor_instead_of(object)) return make_sensor(*known);
  if (!type && is_foreign(object, names_of(camera_types()))) {
    use_instead(object, names_of(camera_types()), "perspective");
    type = find_row(camera_types(), "perspective");
  }
  if (!type) {
    unknown_type(object, names_of(camera_types()));
    return;
  }
  std::vector<std::string> families = {"film", "sampler", "medium"};
  if (leaves_out_response(object)) families.emplace_back("texture");
  if (type->takes_shape) families.emplace_back("shape");
  refuse_children(object, families);
  const std::shared_ptr<const Shape> shape = shape_of_sensor(object, *type);
  if (type->needs_shape && !shape) return;
  camera_medium_ = medium_of(object);
  const Surface* own = type->needs_shape ? &shapes_[size_t(sensor_shape_)].surface : nullptr;
  if (own && !camera_medium_) camera_medium_ = own->exterior;
  const Object* film = only_child(object, "film");
  static const Object default_film{"film", "hdrfilm", "", {}, {}, {}};
  read_film(film ? *film : default_film);
  if (const Object* sampler = only_child(object, "sampler")) read_sampler(*sampler);
  const Arguments arguments = arguments_of(type->info, object);
  const Bounds3f bounds = type->takes_shape ? bounds_of_shapes() : Bounds3f();
  camera_ = type->create({arguments, film_, shape, own && own->traits.is_null, bounds});
  if (camera_->traits().are_pixels_apart()) make_film_of_pixels_apart(film ? *film : default_film);
  // Of what rays meet, unless they bring irradiance themselves.
  if (own)
    film_.quantity =
        camera_->traits().measures_irradiance ? Quantity::radiance : Quantity::irradiance;
}

void SceneBuilder::make_film_of_pixels_apart(const Object& object) {
  film_.size = film_.crop_size = camera_->traits().size_of_pixels_apart;
  film_.crop_offset = {0, 0};
  film_.quantity = Quantity::radiance;
  // Within its pixel, and far enough from the edge that no rounding takes it to the next one.
  film_.filter = box_filter(0.25f);
  for (const Property& property : object.properties)
    if (property.name == "width" || property.name == "height" || property.name == "quantity" ||
        property.name.starts_with("crop_"))
      ignore(property, "the film of such a sensor");
}

const Object* SceneBuilder::only_child(const Object& object, const std::string& family) {
  const Object* first = nullptr;
  for (const Child& child : object.children) {
    if (child.object->family != family) continue;
    if (first)
      problems_.add(fmt::format("the {} has a second {}",
                                object.family == "sensor" ? "camera" : object.family, family),
                    keep_one(first->place), child.object->place);
    else
      first = child.object.get();
  }
  return first;
}

std::shared_ptr<const Shape> SceneBuilder::shape_of_sensor(const Object& object,
                                                           const CameraType& type) {
  if (type.needs_shape != (sensor_shape_ >= 0)) {
    problems_.add(type.needs_shape
                      ? fmt::format("sensor '{}' stands outside of a shape", object.type)
                      : fmt::format("sensor '{}' cannot belong to a shape", object.type),
                  type.needs_shape ? "put it into the shape that it measures"
                                   : "put it at the top of the scene",
                  object.place);
    return nullptr;
  }
  std::shared_ptr<const Shape> shape;
  if (type.needs_shape && size_t(sensor_shape_) < shapes_.size())
    shape = shapes_[size_t(sensor_shape_)].shape;
  for (const Child& child : object.children) {
    if (!type.takes_shape || child.object->family != "shape") continue;
    if (shape) problems_.add("the camera has a second target", "keep one", child.object->place);
    const std::optional<BuiltShape> built = make_shape(*child.object);
    if (!built) return nullptr;
    shape = built->shape;
  }
  if (!shape) return nullptr;
  if (!shape->can_sample()) {
    problems_.add("the camera's shape cannot be sampled by area",
                  "let it measure a mesh or an analytic shape instead", object.place);
    return nullptr;
  }
  if (!(shape->area() > 0)) {
    problems_.add("the camera's shape has no area", "check its vertices and its to_world",
                  object.place);
    return nullptr;
  }
  return shape;
}

Bounds3f SceneBuilder::bounds_of_shapes() const {
  Bounds3f bounds;
  for (const BuiltShape& built : shapes_) bounds.extendBy(built.shape->bounds());
  for (const Instance& instance : instances_) {
    Bounds3f of_group;
    for (const BuiltShape& built : groups_[instance.group])
      of_group.extendBy(built.shape->bounds());
    if (!of_group.isEmpty()) bounds.extendBy(instance.world_from_group.bounds(of_group));
  }
  return bounds;
}

bool SceneBuilder::leaves_out_response(const Object& sensor) {
  std::vector<const Child*> textures;
  for (const Child& child : sensor.children)
    if (child.object->family == "texture") textures.push_back(&child);
  if (textures.size() != 1 || textures[0]->name != "srf") return false;
  ignore({"srf", {}, textures[0]->object->place}, fmt::format("sensor '{}'", sensor.type));
  return true;
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

Object SceneBuilder::without_bands(const Object& film, const TypeInfo& info) {
  Object plain = film;
  if (film.type != "specfilm") return plain;
  const size_t bands = std::erase_if(plain.properties, [&](const Property& property) {
    return !info.find(property.name) && (std::holds_alternative<SpectralCurve>(property.value) ||
                                         std::holds_alternative<Rgb>(property.value) ||
                                         std::holds_alternative<double>(property.value));
  });
  const size_t objects = std::erase_if(plain.children, [](const Child& child) {
    return spectrum_type_of(*child.object) != nullptr;
  });
  const std::string what = "the bands of film 'specfilm'";
  if (bands + objects > 0) ignored_.try_emplace(what, what);
  return plain;
}

void SceneBuilder::read_film(const Object& object) {
  const FilmType* type = find_row(film_types(), object.type);
  if (!type) {
    use_instead(object, names_of(film_types()), "hdrfilm");
    read_film({"film", "hdrfilm", "", object.properties, object.children, object.place});
    return;
  }
  const Arguments arguments = arguments_of(type->info, without_bands(object, type->info));
  collecting(object.place, [&] { film_ = type->create(arguments); });
  refuse_children(object, {"rfilter"});
  film_.filter = gaussian_filter(0.5f, 2.0f);
  if (const Object* filter = only_child(object, "rfilter")) read_filter(*filter);
}

void SceneBuilder::read_filter(const Object& object) {
  const FilterType* type = find_row(filter_types(), object.type);
  if (!type) {
    use_instead(object, names_of(filter_types()), "gaussian");
    return;
  }
  refuse_children(object, {});
  film_.filter = type->create(arguments_of(type->info, object));
  if (film_.filter.is_cut())
    warnings_.push_back(fmt::format(
        "{}: of filter '{}' the lobe in the middle is kept, since negative ones would be noise; "
        "the picture is a little softer",
        text_of(object.place), object.type));
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
