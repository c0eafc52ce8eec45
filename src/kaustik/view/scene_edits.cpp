#include "kaustik/view/scene_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kaustik/integrator/description_types.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

constexpr size_t longest_text = 10'000, most_settings = 200, most_edits = 64;
constexpr const char* edit_origin = "the view's page";

void collect_objects(const Object& object, std::vector<std::shared_ptr<Object>>& list,
                     std::set<const Object*>& seen) {
  for (const Child& child : object.children) {
    if (!seen.insert(child.object.get()).second) continue;
    list.push_back(child.object);
    collect_objects(*child.object, list, seen);
  }
}

std::vector<std::shared_ptr<Object>> all_objects(const Description& description) {
  std::vector<std::shared_ptr<Object>> list;
  std::set<const Object*> seen;
  collect_objects(*description.scene, list, seen);
  return list;
}

std::map<std::string, int> count_of_families(const std::vector<std::shared_ptr<Object>>& objects) {
  std::map<std::string, int> count;
  for (const auto& object : objects) ++count[object->family];
  return count;
}

std::string text_of_number(const Json& number) {
  if (number.is_number_unsigned()) return fmt::format("{}", number.get<uint64_t>());
  if (number.is_number_integer()) return fmt::format("{}", number.get<int64_t>());
  const double value = number.get<double>();
  // "3.0" is a whole number in JSON of JavaScript's making.
  if (value == std::floor(value) && std::abs(value) < 1e15)
    return fmt::format("{}", int64_t(value));
  return fmt::format("{}", value);
}

/// As --set gives it.
std::string text_of_value(const std::string& name, const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return text_of_number(value);
  if (value.is_string() && value.get_ref<const std::string&>().size() <= longest_text)
    return value.get<std::string>();
  if (value.is_array() && value.size() == 3 &&
      std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_number(); }))
    return fmt::format("{} {} {}", text_of_number(value[0]), text_of_number(value[1]),
                       text_of_number(value[2]));
  throw RequestError(400, fmt::format("'{}' has no value that can be set", name),
                     "give a number, three numbers, true or false, or a short text");
}

/// Checks one value against its row: whatever else is wrong with the object is not its fault.
void check_value(const Object& object, const Setting& setting) {
  const TypeInfo* info = description_types().find(object.family, object.type);
  if (!info)
    throw RequestError(400, fmt::format("'{}' has no parameters that can be set", setting.object),
                       "choose another integrator, or edit the scene's file");
  const Parameter* row = info->find(setting.parameter);
  if (!row)
    throw RequestError(400,
                       fmt::format("'{}' has no parameter '{}'", setting.object, setting.parameter),
                       suggest(setting.parameter, info->parameter_names()));
  if (row->kind == ParameterKind::file)
    throw RequestError(400,
                       fmt::format("'{}' names a file, which pages may not", setting.parameter),
                       "edit the scene itself");
  TypeInfo alone{info->family, info->name, info->sentence, {*row}};
  alone.parameters[0].stands_for.clear();
  Problems problems;
  const Arguments arguments(alone, {{setting.parameter, Untyped{setting.value}, {}}}, {}, problems);
  problems.throw_if_any();
}

/// Takes out what the parameter stands instead of, and what stands instead of it: not both can be
/// given.
void make_room(Object& object, const std::string& parameter) {
  const TypeInfo* info = description_types().find(object.family, object.type);
  if (!info) return;
  const Parameter* row = info->find(parameter);
  std::erase_if(object.properties, [&](const Property& property) {
    const Parameter* other = info->find(property.name);
    return other && row && property.name != parameter &&
           (other->stands_for == parameter || row->stands_for == property.name);
  });
}

}  // namespace

std::vector<NamedObject> named_objects(const Description& description) {
  const auto objects = all_objects(description);
  const auto families = count_of_families(objects);
  const auto own = find_integrator(description);
  std::set<std::string> names;
  std::vector<NamedObject> named;
  for (const auto& object : objects) {
    std::string name = object == own                      ? "integrator"
                       : !object->id.empty()              ? object->id
                       : families.at(object->family) == 1 ? object->family
                                                          : "";
    if (!name.empty() && names.insert(name).second) named.push_back({std::move(name), object});
  }
  return named;
}

void name_all_objects(Description& description) {
  const auto objects = all_objects(description);
  const auto families = count_of_families(objects);
  const auto own = find_integrator(description);
  std::set<std::string> names = {"integrator", "sensor", "film", "sampler", "rfilter"};
  for (const auto& object : objects)
    if (!object->id.empty()) names.insert(object->id);
  for (const auto& object : objects) {
    if (!object->id.empty() || object == own || families.at(object->family) == 1) continue;
    // Dots part objects from parameters.
    std::string base = object->type.empty() ? object->family : object->type;
    std::replace(base.begin(), base.end(), '.', '_');
    std::string name = base;
    for (int i = 2; !names.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
    object->id = name;
  }
}

SceneEdits::SceneEdits(Description description) : movable_(description) {
  name_all_objects(description);
  original_ = copy_of(description);
  edits_.push_back({0, std::move(description), std::nullopt});
}

CameraPose SceneEdits::camera(const Scene* built) const {
  CameraPose pose = movable_.pose(current(), distance_, built);
  if (const auto& told = told_pose()) {
    pose.target = told->target;
    pose.up = told->up;
  }
  return pose;
}

Description SceneEdits::with_camera(const CameraPose& pose) const {
  Description next = copy_of(current());
  movable_.put(next, pose);
  return next;
}

Description SceneEdits::with_settings(const Json& settings) const {
  if (!settings.is_object() || settings.empty() || settings.size() > most_settings)
    throw RequestError(400, "'set' is no object with values",
                       "give it as {\"object.parameter\": value}");
  Description next = copy_of(current());
  for (const auto& [name, value] : settings.items()) {
    const size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == name.size())
      throw RequestError(400, fmt::format("'{}' is no parameter", name),
                         "write object.parameter, as GET parameters lists them");
    const Setting setting{name.substr(0, dot), name.substr(dot + 1), text_of_value(name, value),
                          edit_origin};
    if (setting.object == "integrator") made_integrator(next);
    const auto objects = named_objects(next);
    const auto found = std::find_if(objects.begin(), objects.end(), [&](const NamedObject& object) {
      return object.name == setting.object;
    });
    if (found == objects.end()) {
      std::vector<std::string> names;
      for (const NamedObject& object : objects) names.push_back(object.name);
      throw RequestError(400, fmt::format("the scene has no object '{}'", setting.object),
                         suggest(setting.object, names));
    }
    check_value(*found->object, setting);
    make_room(*found->object, setting.parameter);
    override_property(next, setting);
  }
  return next;
}

Description SceneEdits::with_integrator(const std::string& type) const {
  std::vector<std::string> names;
  for (const IntegratorType& known : integrator_types()) names.push_back(known.info.name);
  if (std::find(names.begin(), names.end(), type) == names.end())
    throw RequestError(400, fmt::format("there is no integrator '{}'", type), suggest(type, names));
  Description next = copy_of(current());
  override_integrator(next, type);
  return next;
}

void SceneEdits::taken(uint64_t revision, Description description,
                       const std::optional<CameraPose>& pose) {
  edits_.push_back({revision, std::move(description), pose});
  // A camera may be moved often while a scene is built; of what is not rendered the last counts.
  if (edits_.size() > most_edits) edits_.erase(edits_.begin() + 1);
}

void SceneEdits::note(uint64_t rendered, uint64_t refused) {
  // What came before the rendered one is needed no more.
  while (edits_.size() > 1 && edits_[1].revision <= rendered) edits_.pop_front();
  // What was refused, and those before it, which were never rendered: but for what is.
  std::erase_if(edits_, [&](const Edit& edit) {
    return &edit != &edits_.front() && edit.revision > rendered && edit.revision <= refused;
  });
}

}  // namespace kaustik::view
