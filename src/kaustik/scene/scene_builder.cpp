#include "kaustik/scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kaustik/base/color.h"
#include "kaustik/base/limits.h"
#include "kaustik/base/spectral_value.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/shape_attribute.h"
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

std::vector<std::string> texture_parameters(const TypeInfo& info) {
  std::vector<std::string> names;
  for (const Parameter& row : info.parameters)
    if (row.accepts_texture) names.push_back(row.name);
  return names;
}

bool takes_volumes(const TypeInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [](const Parameter& row) { return row.accepts_volume; });
}

/// Of all that can be written as a texture.
std::vector<std::string> texture_names() {
  std::vector<std::string> names = names_of(texture_types());
  for (const SpectrumType& spectrum : spectrum_types()) names.push_back(spectrum.info.name);
  return names;
}

std::string takes_no_texture(const Object& object, const std::string& name) {
  return fmt::format("{} '{}' takes no texture {}", object.family, object.type,
                     name.empty() ? "without a name" : fmt::format("'{}'", name));
}

/// The parameter that a texture `name` stands for; null if there is none. Where a texture is all
/// that can be given, it may have any name that no other parameter has, as in Mitsuba's bump maps.
const Parameter* texture_parameter(const TypeInfo& info, const std::string& name) {
  const Parameter* only = nullptr;
  int count = 0;
  for (const Parameter& row : info.parameters) {
    if (!row.accepts_texture) continue;
    if (row.name == name) return &row;
    only = &row;
    ++count;
  }
  const bool is_free =
      count == 1 && std::holds_alternative<std::monostate>(only->default_value) && !info.find(name);
  return is_free ? only : nullptr;
}

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

/// Whether a bsdf or another texture can not do without it.
bool is_needed(const Parameter& row) {
  return row.accepts_texture && std::holds_alternative<std::monostate>(row.default_value);
}

/// How many bsdfs one of the type may hold.
std::string remedy_for_nested(const BsdfType& type) {
  if (type.maximum_nested == 0) return "take them out: it holds none";
  if (type.minimum_nested == type.maximum_nested)
    return fmt::format("give it {}", type.minimum_nested);
  return fmt::format("give it {} {} {}", type.minimum_nested,
                     type.minimum_nested + 1 == type.maximum_nested ? "or" : "to",
                     type.maximum_nested);
}

/// See TextureOfParameter; valid as long as the two are.
TextureOfParameter textures_for(
    const Arguments& arguments,
    const std::map<std::string, std::shared_ptr<const Texture>, std::less<>>& nested) {
  return [&](std::string_view name) -> std::shared_ptr<const Texture> {
    const auto found = nested.find(name);
    return found != nested.end() ? found->second : constant_texture_of(arguments, name);
  };
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
    for (const Problem& problem : error.problems()) {
      const bool in_other_file =
          problem.place.file && place.file && *problem.place.file != *place.file;
      problems_.add(in_other_file ? fmt::format("{} (named in {}:{}:{})", problem.message,
                                                *place.file, place.line, place.column)
                                  : problem.message,
                    problem.remedy, problem.place.file ? problem.place : place);
    }
  }
}

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

bool SceneBuilder::leaves_out_texture(const Object& object, const TypeInfo& info,
                                      const Child& child) {
  if (is_strict_) return false;
  const Parameter* row = info.find(child.name);
  if (row && row->no_effect) {
    ignored_.insert(fmt::format("'{}' of {} '{}'", child.name, object.family, object.type));
    return true;
  }
  if (row && mean_instead_of(info, child)) return true;
  if (!row && !nearest_name(child.name, texture_parameters(info)).empty()) return false;
  if (left_out_.insert(child.object.get()).second)
    unknown_.add(takes_no_texture(object, child.name) + ": it is left out", child.object->place);
  return true;
}

const Object* SceneBuilder::foreign_texture_in(const Object& texture) const {
  if (is_foreign(texture, texture_names())) return &texture;
  const TextureType* type = find_row(texture_types(), texture.type);
  return type ? foreign_texture_of(texture, type->info) : nullptr;
}

const Object* SceneBuilder::foreign_texture_of(const Object& holder, const TypeInfo& info) const {
  for (const Child& child : holder.children) {
    if (child.object->family != "texture" || spectrum_type_of(*child.object)) continue;
    const Parameter* row = texture_parameter(info, child.name);
    if (!row || !is_needed(*row)) continue;
    if (const Object* foreign = foreign_texture_in(*texture_within(child.object))) return foreign;
  }
  return nullptr;
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
    unknown_.add(fmt::format("'{}' of {} '{}' is beyond its range: {:g} is taken", property.name,
                             info.family, info.name, taken),
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
  for (const std::string& name : arguments.ignored())
    ignored_.insert(fmt::format("'{}' of {} '{}'", name, info.family, info.name));
  return arguments;
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
  return !is_strict_ && nearest_name(object.type, valid).empty();
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
  parts.built = std::move(built_);
  parts.counts = counts_;
  parts.film = film_;
  parts.camera = std::move(camera_);
  parts.camera_medium = std::move(camera_medium_);
  parts.light_media = std::move(light_media_);
  parts.hidden_lights = std::move(hidden_lights_);
  parts.warnings = std::move(warnings_);
  if (!ignored_.empty())
    parts.warnings.push_back(fmt::format("without effect here: {}", fmt::join(ignored_, ", ")));
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
  if (shines && built.surface.bsdf->traits().is_null) {
    told_unless_strict("a shape with bsdf 'null' is not there, so it cannot be a light",
                       "give it another bsdf, such as diffuse; it is taken to be black",
                       object.place);
    built.surface.bsdf = black_bsdf();
  }
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

bool SceneBuilder::asks_surface(const Object& object) {
  const auto known = asks_surface_.find(&object);
  if (known != asks_surface_.end()) return known->second;
  const TextureType* type =
      object.family == "texture" ? find_row(texture_types(), object.type) : nullptr;
  bool asks = type && type->asks_surface;
  for (const Child& child : object.children) asks = asks || asks_surface(*child.object);
  return asks_surface_[&object] = asks;
}

SceneBuilder::MadeOn SceneBuilder::made_on(const Object& object, const BuiltShape* on) {
  return {&object, on && asks_surface(object) ? on->shape.get() : nullptr};
}

std::shared_ptr<const SurfaceAttribute> SceneBuilder::attribute_of(const BuiltShape* on,
                                                                   const std::string& name,
                                                                   const Place& place) {
  if (!on || !on->shape) return nullptr;
  try {
    return std::make_shared<ShapeAttribute>(
        on->shape, attribute_named(*on->shape, on->surface.name, name, place));
  } catch (const Error& error) {
    if (is_strict_ || error.kind() != ErrorKind::input) throw;
    const Problem& problem = error.problems().front();
    warnings_.push_back(fmt::format("{}: {}: it is black there; {}", text_of(place),
                                    problem.message, problem.remedy));
    return std::make_shared<NoAttribute>();
  }
}

std::shared_ptr<const Texture> SceneBuilder::make_texture(const std::shared_ptr<Object>& object,
                                                          const BuiltShape* on) {
  const MadeOn key = made_on(*object, on);
  const auto known = textures_.find(key);
  if (known != textures_.end()) return known->second;
  return textures_[key] = create_texture(*object, on);
}

std::shared_ptr<const Texture> SceneBuilder::create_texture(const Object& object,
                                                            const BuiltShape* on) {
  const TextureType* type = find_row(texture_types(), object.type);
  if (!type) {
    unknown_type(object, texture_names());
    return nullptr;
  }
  std::vector<std::string> families;
  if (!texture_parameters(type->info).empty()) families.emplace_back("texture");
  if (takes_volumes(type->info)) families.emplace_back("volume");
  refuse_children(object, families);
  std::optional<Textures> nested = Textures();
  if (!texture_parameters(type->info).empty()) nested = textures_of(object, type->info, on);
  std::optional<Volumes> volumes = Volumes();
  if (takes_volumes(type->info)) volumes = volumes_of(object, type->info);
  const Arguments arguments = arguments_of(type->info, object);
  if (!nested || !volumes || !arguments.is_complete()) return nullptr;
  std::shared_ptr<const Texture> texture;
  const auto attribute = [&](const std::string& name) {
    return attribute_of(on, name, arguments.place_of("name"));
  };
  const auto volume = [&](std::string_view name) -> std::shared_ptr<const Volume> {
    const auto found = volumes->find(name);
    return found != volumes->end() ? found->second.volume : nullptr;
  };
  collecting(source_place(arguments), [&] {
    texture =
        texture_of(object, *type,
                   {arguments, pictures_, textures_for(arguments, *nested), attribute, volume}, on);
  });
  if (texture && texture->size() > maximum_texture_size) {
    problems_.add(fmt::format("texture '{}' nests {} textures, each counted for every place it is "
                              "used in: rendering it would take too long",
                              object.type, texture->size() - 1),
                  fmt::format("nest fewer: at most {} in all", maximum_texture_size - 1),
                  object.place);
    return nullptr;
  }
  return texture;
}

std::optional<SceneBuilder::Textures> SceneBuilder::textures_of(const Object& object,
                                                                const TypeInfo& info,
                                                                const BuiltShape* on) {
  Textures textures;
  for (const Child& child : object.children) {
    if (child.object->family != "texture" || spectrum_type_of(*child.object)) continue;
    const Parameter* parameter = texture_parameter(info, child.name);
    const std::vector<std::string> valid = texture_parameters(info);
    if (!parameter && object.family == "emitter" && valid.size() == 1 && !is_strict_ &&
        !info.find(child.name) && nearest_name(child.name, valid).empty()) {
      parameter = info.find(valid.front());
      unknown_.add(fmt::format("the texture '{}' of emitter '{}' is taken as '{}'", child.name,
                               object.type, parameter->name),
                   child.object->place);
    }
    if (!parameter && leaves_out_texture(object, info, child)) continue;
    if (!parameter) {
      problems_.add(takes_no_texture(object, child.name),
                    valid.empty() ? "remove it" : suggest(child.name, valid), child.object->place);
      continue;
    }
    const std::shared_ptr<Object>& given = texture_within(child.object);
    if (const Object* foreign = foreign_texture_in(*given)) {
      leave_out(*foreign, "it is left out");
      continue;
    }
    auto& texture = textures[parameter->name];
    if (texture)
      problems_.add(
          fmt::format("{} '{}' has a second texture '{}'", object.family, object.type, child.name),
          "keep one", child.object->place);
    texture = make_texture(given, on);
    if (!texture) return std::nullopt;
  }
  return textures;
}

std::shared_ptr<const Bsdf> SceneBuilder::make_bsdf(const std::shared_ptr<Object>& object,
                                                    const BuiltShape* on) {
  const MadeOn key = made_on(*object, on);
  const auto known = bsdfs_.find(key);
  if (known != bsdfs_.end()) return known->second;
  return bsdfs_[key] = create_bsdf(*object, on);
}

std::shared_ptr<const Bsdf> SceneBuilder::create_bsdf(const Object& object, const BuiltShape* on) {
  const BsdfType* type = find_row(bsdf_types(), object.type);
  if (!type) {
    const bool is_to_come = remedy_for_type_to_come(object).has_value();
    if (is_to_come && is_strict_) {
      not_here_yet(object);
      return nullptr;
    }
    if (is_to_come || is_foreign(object, names_of(bsdf_types())))
      return bsdf_instead_of(object, on);
    unknown_type(object, names_of(bsdf_types()));
    return nullptr;
  }
  refuse_children(object, {"bsdf", "texture"});
  std::vector<std::shared_ptr<const Bsdf>> nested;
  for (const Child* child : ordered_children(object, "bsdf")) {
    nested.push_back(make_bsdf(child->object, on));
    if (!nested.back()) return nullptr;
  }
  if (const Object* foreign = foreign_texture_of(object, type->info);
      foreign && nested.size() == 1) {
    leave_out(*foreign, fmt::format("the bsdf in '{}' stands for it", object.type));
    return nested.front();
  }
  const std::optional<Textures> textures = textures_of(object, type->info, on);
  if (!textures) return nullptr;
  if (int(nested.size()) < type->minimum_nested || int(nested.size()) > type->maximum_nested) {
    problems_.add(fmt::format("bsdf '{}' holds {} bsdfs", object.type, nested.size()),
                  remedy_for_nested(*type), object.place);
    return nullptr;
  }
  const Arguments arguments = arguments_of(type->info, object);
  const auto warn = [&](const std::string& message) {
    if (remarks_reported_.insert(message).second) warnings_.push_back(message);
  };
  std::shared_ptr<const Bsdf> bsdf;
  collecting(object.place, [&] {
    bsdf = bsdf_of(object, *type,
                   {arguments, nested, textures_for(arguments, *textures), warn, is_strict_}, on);
  });
  if (bsdf && bsdf->traits().size > maximum_bsdf_size) {
    problems_.add(fmt::format("bsdf '{}' nests {} bsdfs, each counted for every place it is used "
                              "in: rendering it would take too long",
                              object.type, bsdf->traits().size - 1),
                  fmt::format("nest fewer, and blend the same one only once: at most {} in all",
                              maximum_bsdf_size - 1),
                  object.place);
    return nullptr;
  }
  return bsdf;
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
