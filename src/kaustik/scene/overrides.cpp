#include "kaustik/scene/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "kaustik/scene/scene.h"
#include "kaustik/scene/scene_cameras.h"

namespace kaustik {
namespace {

/// Every object below `object`, each once.
void collect(const std::shared_ptr<Object>& object, std::vector<std::shared_ptr<Object>>& list,
             std::set<const Object*>& seen) {
  for (const Child& child : object->children) {
    if (!seen.insert(child.object.get()).second) continue;
    list.push_back(child.object);
    collect(child.object, list, seen);
  }
}

/// The film or the sampler that the scene's only camera, which has none, gets for a change; null:
/// it is no such object, or there is not one camera.
std::shared_ptr<Object> made_part_of_camera(const Description& description,
                                            const std::string& name) {
  const std::vector<std::shared_ptr<Object>> cameras = cameras_of(*description.scene);
  if ((name != "film" && name != "sampler") || cameras.size() != 1) return nullptr;
  auto object = std::make_shared<Object>();
  object->family = name;
  object->type = name == "film" ? "hdrfilm" : "independent";
  object->place = cameras[0]->place;
  cameras[0]->children.push_back({"", object});
  return object;
}

std::shared_ptr<Object> find_object(Description& description, const std::string& name) {
  if (name == "integrator") return made_integrator(description);
  std::vector<std::shared_ptr<Object>> objects;
  std::set<const Object*> seen;
  collect(description.scene, objects, seen);
  std::vector<std::string> names = {"integrator"};
  std::vector<std::shared_ptr<Object>> of_family;
  for (const auto& object : objects) {
    if (!object->id.empty()) {
      if (object->id == name) return object;
      names.push_back(object->id);
    }
    if (object->family == name) of_family.push_back(object);
    if (object->family == "sensor" || object->family == "film") names.push_back(object->family);
  }
  if (of_family.size() == 1) return of_family[0];
  if (of_family.size() > 1)
    throw Error(ErrorKind::input,
                fmt::format("the scene has {} objects '{}'", of_family.size(), name),
                "give the one that you mean an id in the scene and use that");
  if (auto made = made_part_of_camera(description, name)) return made;
  throw Error(ErrorKind::input, fmt::format("the scene has no object '{}'", name),
              suggest(name, names));
}

std::optional<int64_t> whole_number(const Value& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return *integer;
  const auto* written = std::get_if<Untyped>(&value);
  int64_t number = 0;
  if (!written) return std::nullopt;
  const char* const end = written->text.data() + written->text.size();
  const auto [at, error] = std::from_chars(written->text.data(), end, number);
  return error == std::errc() && at == end ? std::optional(number) : std::nullopt;
}

/// A number of pixels as the file gives it; null: there is none, or it was changed already.
int64_t* pixels_of_file(Object& film, const std::string& name) {
  for (Property& property : film.properties)
    if (property.name == name && property.place.line > 0)
      return std::get_if<int64_t>(&property.value);
  return nullptr;
}

/// Where the picture is to be wider or higher, the crop window of the file stays the same part.
void scale_crop_window(Object& film, const Property& size) {
  if (size.name != "width" && size.name != "height") return;
  const std::string axis = size.name == "width" ? "x" : "y";
  std::optional<int64_t> before;
  for (const Property& property : film.properties)
    if (property.name == size.name) before = whole_number(property.value);
  int64_t* offset = pixels_of_file(film, "crop_offset_" + axis);
  int64_t* extent = pixels_of_file(film, "crop_" + size.name);
  const auto after = whole_number(size.value);
  if (!before || *before <= 0 || !after || *after <= 0) return;
  const double factor = double(*after) / double(*before);
  const auto scaled = [&](int64_t pixel) { return int64_t(std::llround(double(pixel) * factor)); };
  const int64_t begin = offset ? *offset : 0;
  if (extent) {
    const int64_t end = scaled(begin + *extent);
    *extent = std::max<int64_t>(1, end - std::min(scaled(begin), end));
  }
  if (offset) *offset = std::min(scaled(begin), std::max<int64_t>(0, *after - 1));
}

}  // namespace

std::shared_ptr<Object> made_integrator(Description& description) {
  if (auto object = own_integrator(description)) return object;
  auto object = std::make_shared<Object>();
  object->family = "integrator";
  object->type = default_integrator;
  object->place = place_in("integrator");
  description.scene->children.push_back({"", object});
  return object;
}

std::string choose_camera(Description& description, const std::string& name) {
  unfold_batches(*description.scene);
  const std::vector<std::shared_ptr<Object>> cameras = cameras_of(*description.scene);
  const auto name_of = [&](const Object& camera) {
    if (!camera.id.empty()) return fmt::format("'{}'", camera.id);
    return camera.place.line > 0 ? "the one at " + text_of(camera.place) : "one without a name";
  };
  std::vector<std::string> names, ids;
  std::shared_ptr<Object> chosen;
  for (const auto& camera : cameras) {
    if (!camera->id.empty()) ids.push_back(camera->id);
    if (!chosen && (name.empty() || camera->id == name))
      chosen = camera;
    else
      names.push_back(name_of(*camera));
  }
  if (!chosen && !name.empty())
    throw Error(
        ErrorKind::input, fmt::format("the scene has no camera '{}'", name),
        ids.empty() ? "none has an id: give one to the camera that you mean" : suggest(name, ids));
  if (names.empty()) return {};
  leave_camera(*description.scene, *chosen);
  if (!name.empty()) return {};
  return fmt::format("the scene has {} cameras: {} is used, the others are left out: {}",
                     cameras.size(), name_of(*chosen), fmt::join(names, ", "));
}

Setting setting_from(const std::string& assignment, const std::string& origin) {
  const size_t equals = assignment.find('=');
  const size_t dot = assignment.substr(0, equals).rfind('.');
  if (equals == std::string::npos || dot == std::string::npos || dot == 0 || dot + 1 == equals)
    throw Error(ErrorKind::input, fmt::format("cannot read the setting '{}'", assignment),
                "write object.parameter=value, such as integrator.caustic_neighbors=200",
                place_in(origin));
  return {assignment.substr(0, dot), assignment.substr(dot + 1, equals - dot - 1),
          assignment.substr(equals + 1), origin};
}

std::string assignment_of(const Setting& setting) {
  return fmt::format("{}.{}={}", setting.object, setting.parameter, setting.value);
}

void override_property(Description& description, const std::string& assignment) {
  override_property(description, setting_from(assignment, "setting " + assignment));
}

void override_property(Description& description, const Setting& setting) {
  override_property(description, setting.object,
                    {setting.parameter, Untyped{setting.value}, place_in(setting.origin)});
}

void override_property(Description& description, const std::string& object, Property property) {
  const auto changed = find_object(description, object);
  const std::string& name = property.name;
  if (changed->family == "film") scale_crop_window(*changed, property);
  std::erase_if(changed->properties, [&](const Property& p) { return p.name == name; });
  std::erase_if(changed->children, [&](const Child& c) { return c.name == name; });
  changed->properties.push_back(std::move(property));
}

}  // namespace kaustik
