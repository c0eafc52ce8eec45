#include "kaustik/scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kaustik/base/limits.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/material/mask.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/named_in.h"
#include "kaustik/scene/spectrum_types.h"
#include "kaustik/scene/type_tables.h"
#include "kaustik/scene/types_to_come.h"

namespace kaustik {
namespace {

std::string display_name(const Object& object) {
  if (!object.id.empty()) return object.id;
  const std::string name = fmt::format("{} '{}'", object.family, object.type);
  return object.place.line > 0 ? fmt::format("{} on line {}", name, object.place.line) : name;
}

/// Of the row `to_world`, as far as it is one; 3 where there is none.
int dimensions_left(const Object& object) {
  for (const Property& property : object.properties)
    if (const auto* to_world = std::get_if<Transform>(&property.value);
        to_world && property.name == "to_world")
      return to_world->dimensions();
  return 3;
}

/// Whether nothing is left of a shape that has been flattened.
bool is_line(const Shape& shape) {
  constexpr double nothing = 1e-9;  // beside the square of its extent
  const Bounds3f bounds = shape.bounds();
  const Vec3f size = bounds.isEmpty() ? Vec3f(0, 0, 0) : bounds.max - bounds.min;
  return !(double(shape.area()) > nothing * sqr(double(length(size))));
}

/// Refuses what floats cannot carry through ray tracing; `what` is the subject of the message.
void check_extent(const Bounds3f& bounds, const std::string& what, const Place& place) {
  if (bounds.isEmpty()) return;
  const float farthest = std::max(max_abs(bounds.min), max_abs(bounds.max));
  if (double(farthest) <= 1.01 * largest_length) return;
  throw Error(
      ErrorKind::input,
      fmt::format("{} reaches as far out as {:g} m, more than single floats carry", what, farthest),
      fmt::format("keep all coordinates between {:g} and {:g} m", -largest_length, largest_length),
      place);
}

void check_size(const Shape& shape, const Place& place) {
  check_extent(shape.bounds(), "the shape", place);
  if (shape.mesh() || !shape.can_sample() || double(shape.area()) > sqr(smallest_length)) return;
  throw Error(
      ErrorKind::input,
      fmt::format("the shape's area is {:g} m², less than single floats carry", shape.area()),
      fmt::format("let its sizes, scaled by to_world, be at least {:g} m", smallest_length), place);
}

}  // namespace

Place SceneBuilder::source_place(const Arguments& arguments) {
  for (const Parameter& row : arguments.info().parameters)
    if ((row.kind == ParameterKind::file || row.kind == ParameterKind::array) &&
        arguments.given(row.name))
      return arguments.place_of(row.name);
  return arguments.place();
}

void SceneBuilder::collecting(const Place& place, const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    for (const Problem& given : error.problems()) {
      const Problem problem = named_in(given, place);
      problems_.add(problem.message, problem.remedy, problem.place);
    }
  }
}

void SceneBuilder::unknown_type(const Object& object, const std::vector<std::string>& valid) {
  problems_.add(fmt::format("unknown {} type '{}'", object.family, object.type),
                suggest(object.type, valid), object.place);
}

void SceneBuilder::not_here_yet(const Object& object) {
  problems_.add(fmt::format("there is no {} '{}' here yet", object.family, object.type),
                remedy_for_type_to_come(object).value_or(""), object.place);
}

bool SceneBuilder::is_foreign(const Object& object, const std::vector<std::string>& valid) const {
  return !is_strict_ && !is_slip_of_pen(object.type, valid);
}

void SceneBuilder::leave_out(const Object& object, const std::string& consequence) {
  if (!left_out_.insert(&object).second) return;
  const std::optional<std::string> remedy = remedy_for_type_to_come(object);
  const std::string what = fmt::format("{} '{}'", object.family, object.type);
  unknown_.add(fmt::format("{}: {}{}",
                           remedy ? fmt::format("there is no {} here yet", what)
                                  : fmt::format("Kaustik does not know {}", what),
                           consequence, remedy && !remedy->empty() ? "; " + *remedy : ""),
               object.place);
}

void SceneBuilder::leave_out_flat(const Object& shape) {
  const std::string message =
      fmt::format("'to_world' of shape '{}' leaves nothing of it", shape.type);
  if (is_strict_)
    problems_.add(message, "give no factor of 0", shape.place);
  else if (left_out_.insert(&shape).second)
    unknown_.add(message + ": it is left out", shape.place);
}

void SceneBuilder::ignore(const Property& property, const std::string& object) {
  const std::string text = name_and_place(property, object);
  ignored_.try_emplace(fmt::format("'{}' of {}", property.spelling(), object), text);
}

void SceneBuilder::told_unless_strict(const std::string& message, const std::string& remedy,
                                      const Place& place) {
  if (is_strict_)
    problems_.add(message, remedy, place);
  else
    warnings_.push_back(fmt::format("{}: {}; {}", text_of(place), message, remedy));
}

void SceneBuilder::refuse_children(const Object& object,
                                   const std::vector<std::string>& allowed_families) {
  for (const Child& child : object.children) {
    const std::string& family = child.object->family;
    if (spectrum_type_of(*child.object)) continue;  // a value
    if (std::find(allowed_families.begin(), allowed_families.end(), family) !=
        allowed_families.end())
      continue;
    problems_.add(fmt::format("{} '{}' cannot hold a {}", object.family, object.type, family),
                  allowed_families.empty()
                      ? "remove it"
                      : fmt::format("it may hold: {}", fmt::join(allowed_families, ", ")),
                  child.object->place);
  }
}

Scene::Parts SceneBuilder::build(const Object& scene) {
  for (const Property& property : scene.properties)
    told_unless_strict(fmt::format("the scene has no parameter '{}'", property.name),
                       "put it into the object that it belongs to", property.place);
  find_emitters_of_shapes(scene);
  read_meshes(scene);
  for (const Child& child : scene.children) add_top_level(*child.object);
  if (sensor_) collecting(sensor_->place, [&] { make_sensor(*sensor_); });
  problems_.throw_if_any();

  Scene::Parts parts;
  parts.tracer = std::make_unique<const RayTracer>(make_geometry(),
                                                   previous_ ? &previous_->tracer() : nullptr);
  bounds_ = parts.tracer->bounds();
  if (!sensor_ && place_camera(scene.place)) make_sensor(*sensor_);
  problems_.throw_if_any();
  make_lights();
  problems_.throw_if_any();
  for (BuiltShape& built : shapes_) parts.surfaces.push_back(std::move(built.surface));
  for (auto& group : groups_)
    for (BuiltShape& built : group) parts.surfaces.push_back(std::move(built.surface));
  add_body_parts(parts.tracer->body_parts(), parts.surfaces);
  problems_.throw_if_any();
  parts.lights = std::move(lights_);
  const StructuresBuilt structures = parts.tracer->structures_built();
  counts_.group_structures = structures.groups;
  counts_.top_structures = structures.top_level ? 1 : 0;
  counts_.pictures = pictures_.read_count();
  built_.sensor = keys_.whole(*sensor_);
  if (sensor_shape_ >= 0)
    built_.sensor = hash_mix(built_.sensor, keys_.whole(*shapes_[size_t(sensor_shape_)].object));
  built_.world = world_key(scene);
  parts.built = std::move(built_);
  parts.counts = counts_;
  parts.film = film_;
  parts.camera = std::move(camera_);
  parts.camera_medium = std::move(camera_medium_);
  parts.light_media = std::move(light_media_);
  parts.hidden_lights = std::move(hidden_lights_);
  parts.light_names = std::move(light_names_);
  parts.warnings = std::move(warnings_);
  if (!ignored_.empty()) {
    std::vector<std::string> names;
    for (const auto& [name, text] : ignored_) names.push_back(text);
    parts.warnings.push_back(without_effect(names));
  }
  for (std::string& warning : unknown_.warnings()) parts.warnings.push_back(std::move(warning));
  parts.warnings.insert(parts.warnings.end(), pictures_.warnings().begin(),
                        pictures_.warnings().end());
  return parts;
}

void SceneBuilder::add_top_level(const Object& object) {
  if (object.family == "shape") {
    if (object.type == "shapegroup") return;  // built when an instance asks for it
    if (object.type == "instance")
      add_instance(object);
    else
      add_shape(object);
  } else if (object.family == "emitter") {
    if (!is_for_shapes(object)) pending_lights_.push_back({&object, nullptr, -1});
  } else if (object.family == "sensor") {
    add_sensor(object, -1);
  } else if (object.family == "bsdf" || object.family == "texture" || object.family == "medium" ||
             object.family == "volume") {
    // Checked where it is used, and here so that a mistake in an unused one is told as well.
    const auto alias =
        std::shared_ptr<Object>(std::shared_ptr<Object>(), const_cast<Object*>(&object));
    if (object.family == "bsdf")
      make_bsdf(alias, nullptr);
    else if (object.family == "medium")
      make_medium(alias);
    else if (object.family == "volume") {
      if (const std::shared_ptr<Object>* known = volume_instead_of(alias)) make_volume(*known);
    } else if (spectrum_type_of(object))
      value_of_spectrum(object);
    else if (const Object* foreign = foreign_texture_in(*texture_within(alias)))
      leave_out(*foreign, "it is left out");
    else
      make_texture(texture_within(alias), nullptr);
  } else if (object.family != "integrator" && object.id.empty()) {
    // One with an id may be referred to.
    const bool is_of_sensor = object.family == "film" || object.family == "sampler";
    told_unless_strict(
        fmt::format("a {} stands at the top of the scene, where it has no effect", object.family),
        is_of_sensor                 ? "put it into the sensor"
        : object.family == "rfilter" ? "put it into the film"
        : object.family == "phase"   ? "put it into a medium"
                                     : "put it into what it belongs to",
        object.place);
  }
}

void SceneBuilder::add_sensor(const Object& object, int shape) {
  const std::vector<std::string> valid = names_of(camera_types());
  if (shape >= 0 && !find_row(camera_types(), object.type)) {
    if (is_foreign(object, valid))
      leave_out(object, "it is left out");
    else
      unknown_type(object, valid);
    return;
  }
  if (sensor_) {
    warnings_.push_back(
        fmt::format("the scene has more than one camera: {} is not used", display_name(object)));
    return;
  }
  sensor_ = &object;
  sensor_shape_ = shape;
}

std::optional<SceneBuilder::BuiltShape> SceneBuilder::make_shape(const Object& object) {
  const ShapeType* type = find_row(shape_types(), object.type);
  if (!type)
    if (const Object* known = shape_instead_of(object)) return make_shape(*known);
  if (!type) {
    std::vector<std::string> valid = names_of(shape_types());
    valid.insert(valid.end(), {shapegroup_info().name, instance_info().name, merge_info().name});
    const bool is_to_come = remedy_for_type_to_come(object).has_value();
    if (is_foreign(object, valid) || (!is_strict_ && is_to_come))
      leave_out(object, "it is left out");
    else if (is_to_come)
      not_here_yet(object);
    else
      unknown_type(object, valid);
    return std::nullopt;
  }
  if (lacks_file(object, type->info, "the shape is left out")) return std::nullopt;
  refuse_children(object, {"bsdf", "emitter", "integrator", "medium", "sensor", "texture"});
  const Parameter* placing = type->info.find("to_world");
  const int dimensions = dimensions_left(object);
  if (placing && dimensions < placing->least_dimensions) {
    leave_out_flat(object);
    return std::nullopt;
  }
  const std::optional<Object> described = with_heights(object, type->info);
  if (!described) return std::nullopt;
  BuiltShape built;
  built.object = &object;
  built.surface.name = display_name(object);
  const Arguments arguments = arguments_of(type->info, *described);
  if (arguments.is_complete())
    collecting(source_place(arguments), [&] {
      built.shape = shape_of(object, *type, arguments);
      if (dimensions == 3 || !is_line(*built.shape))
        check_size(*built.shape, source_place(arguments));
    });
  if (built.shape && dimensions < 3 && is_line(*built.shape)) {
    leave_out_flat(object);
    return std::nullopt;
  }
  int bsdf_count = 0;
  for (const Child& child : object.children) {
    if (child.object->family == "bsdf") {
      built.surface.bsdf = make_bsdf(child.object, &built);
      if (++bsdf_count == 2)
        problems_.add("the shape has a second bsdf", "keep one", child.object->place);
    } else if (child.object->family == "integrator") {
      if (built.surface.illumination)
        problems_.add("the shape has a second integrator", "keep one", child.object->place);
      built.surface.illumination = child.object;
    }
  }
  const bool shines = std::any_of(object.children.begin(), object.children.end(),
                                  [](const Child& c) { return c.object->family == "emitter"; });
  // As in Mitsuba a lamp without a bsdf reflects nothing, and other shapes half of the light.
  if (!built.surface.bsdf) built.surface.bsdf = shines ? black_bsdf() : usual_bsdf();
  // Paths look at a lamp that they pass.
  if (shines && built.surface.bsdf) built.surface.bsdf = with_lobe(built.surface.bsdf);
  if (built.surface.bsdf) built.surface.traits = built.surface.bsdf->traits();
  read_media(object, built.surface);
  if (const auto* mesh = dynamic_cast<const MeshShape*>(built.shape.get()))
    for (const std::string& remark : mesh->remarks())
      if (remarks_reported_.insert(remark).second) warnings_.push_back(remark);
  if (!built.shape || !built.surface.bsdf) return std::nullopt;
  return built;
}

void SceneBuilder::add_shape(const Object& object) {
  std::optional<BuiltShape> built = make_shape(object);
  if (!built) return;
  const int index = int(shapes_.size());
  for (const Child& child : object.children)
    if (child.object->family == "sensor") add_sensor(*child.object, index);
  int emitters = 0;
  for (const Child& child : object.children) {
    if (child.object->family != "emitter") continue;
    if (++emitters == 2)
      problems_.add("the shape has a second emitter", "keep one", child.object->place);
    pending_lights_.push_back({child.object.get(), built->shape, index});
  }
  shapes_.push_back(std::move(*built));
}

uint32_t SceneBuilder::group_index(const std::shared_ptr<Object>& group) {
  const auto [entry, is_new] = group_of_.try_emplace(group.get(), uint32_t(groups_.size()));
  if (!is_new) return entry->second;
  groups_.emplace_back();
  const size_t index = groups_.size() - 1;
  arguments_of(shapegroup_info(), *group);
  refuse_children(*group, {"shape"});
  for (const Child& child : group->children) {
    if (child.object->family != "shape") continue;
    for (const Child& part : child.object->children)
      if (part.object->family == "sensor")
        told_unless_strict("a sensor of a shape of a shape group has no effect",
                           "put the shape at the top of the scene", part.object->place);
    if (auto built = make_shape(*child.object)) groups_[index].push_back(std::move(*built));
  }
  if (group->children.empty())
    problems_.add("the shape group is empty", "add a shape to it", group->place);
  return entry->second;
}

void SceneBuilder::add_instance(const Object& object) {
  if (dimensions_left(object) < 3) return leave_out_flat(object);
  const Arguments arguments = arguments_of(instance_info(), object);
  std::vector<std::string> families = {"shape"};
  const auto bsdf = std::find_if(object.children.begin(), object.children.end(),
                                 [](const Child& child) { return child.object->family == "bsdf"; });
  if (bsdf != object.children.end() && !is_strict_) {
    families.emplace_back("bsdf");
    if (left_out_.insert(&object).second)
      unknown_.add("a bsdf in an instance has no effect: the shapes of its group have theirs",
                   bsdf->object->place);
  }
  refuse_children(object, families);
  std::vector<std::shared_ptr<Object>> shapes;
  for (const Child& child : object.children)
    if (child.object->family == "shape") shapes.push_back(child.object);
  if (shapes.size() != 1 || shapes[0]->type != "shapegroup") {
    problems_.add("an instance needs exactly one shape group",
                  "put one into it, a shape of type 'shapegroup', or refer to it", object.place);
    return;
  }
  const Transform& to_world = arguments.transform("to_world");
  const uint32_t group = group_index(shapes[0]);
  instances_.push_back({group, to_world});
  Bounds3f bounds;
  for (const BuiltShape& built : groups_[group]) {
    bounds.extendBy(built.shape->bounds());
    for (const auto& medium : {built.surface.interior, built.surface.exterior})
      if (medium && medium->has_place() && remarks_reported_.insert("media of instances").second)
        warnings_.push_back(
            fmt::format("the medium of '{}' lies where its volumes do: instances do not move it",
                        built.surface.name));
  }
  collecting(arguments.place_of("to_world"), [&] {
    check_extent(to_world.bounds(bounds), "the instance", arguments.place_of("to_world"));
  });
}

Geometry SceneBuilder::make_geometry() {
  Geometry geometry;
  for (const BuiltShape& built : shapes_) geometry.shapes.push_back(built.shape);
  for (const auto& group : groups_) {
    geometry.groups.emplace_back();
    for (const BuiltShape& built : group) geometry.groups.back().push_back(built.shape);
  }
  geometry.instances = instances_;
  geometry.bodies = find_bodies();
  return geometry;
}

}  // namespace kaustik
