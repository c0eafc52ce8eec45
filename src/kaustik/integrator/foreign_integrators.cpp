#include "kaustik/integrator/foreign_integrators.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/scene/find_row.h"

namespace kaustik {
namespace {

/// The one that renders the picture: the first that is not only there for a layer; null: none.
const Object* held_by(const Object& object) {
  for (const Child& child : object.children) {
    if (child.object->family != "integrator") continue;
    const ForeignIntegrator* foreign = find_foreign_integrator(child.object->type);
    if (!foreign || foreign->refusal.empty()) return child.object.get();
  }
  return nullptr;
}

/// The native table with the rows beside it.
TypeInfo whole_table(const ForeignIntegrator& foreign, const std::string& name) {
  TypeInfo info = foreign.info;
  info.name = name;
  if (const IntegratorType* type = find_integrator_type(foreign.native))
    for (const Parameter& row : type->info.parameters)
      if (!info.find(row.name)) info.parameters.push_back(row);
  return info;
}

void set_property(Object& object, Property property) {
  std::erase_if(object.properties, [&](const Property& p) { return p.name == property.name; });
  object.properties.push_back(std::move(property));
}

/// What it holds, with what is said of the holder and the holder does not know.
Object unwrapped(const Object& object, const ForeignIntegrator& foreign,
                 std::vector<std::string>& notes) {
  for (const Child& child : object.children)
    if (child.object->family != "integrator" && child.object->family != "sampler")
      throw Error(
          ErrorKind::input,
          fmt::format("integrator '{}' cannot hold a {}", object.type, child.object->family),
          "remove it", child.object->place);
  const Object* held = held_by(object);
  Object result = held ? *held : Object{"integrator", default_integrator, "", {}, {}, object.place};
  for (const Property& property : object.properties)
    if (!foreign.info.find(property.name)) set_property(result, property);
  notes.push_back(fmt::format(
      "integrator '{}' is left out: the picture is that of {} '{}'{}", object.type,
      held ? "the integrator in it," : "the default,", result.type,
      foreign.is_of_layers ? "; the layers of an EXR hold depth, normals, albedo and errors anyway"
                           : ""));
  size_t others = 0;
  for (const Child& child : object.children)
    others += child.object->family == "integrator" && child.object.get() != held;
  if (others > 0)
    notes.push_back(fmt::format("of the integrators in '{}', {} after '{}' {} left out",
                                object.type, others, result.type, others == 1 ? "is" : "are"));
  return result;
}

/// Checks what is given against their table, and gives it our names.
Object translated(const Object& object, const ForeignIntegrator& foreign, bool is_strict,
                  std::vector<std::string>& notes) {
  const TypeInfo table = whole_table(foreign, object.type);
  Problems problems;
  UnknownParameters unknown;
  const std::vector<Property> given =
      is_strict ? object.properties : unknown.without_unknown(table, object.properties);
  const Arguments arguments(table, given, object.place, problems);
  problems.throw_if_any();
  for (std::string& warning : unknown.warnings()) notes.push_back(std::move(warning));
  Object result = object;
  result.type = foreign.native;
  result.properties.clear();
  std::vector<std::string> ignored;
  for (const Property& property : given) {
    bool is_renamed = false;
    for (const auto& [theirs, ours] : foreign.renamed)
      if (property.name == theirs) {
        is_renamed = true;
        // Who gives ours, too, means that.
        if (!arguments.given(ours))
          result.properties.push_back({ours, property.value, property.place, property.spelling()});
      }
    const Parameter* beside = foreign.info.find(property.name);
    if (!is_renamed && !beside) result.properties.push_back(property);
    if (beside && beside->no_effect)
      ignored.push_back(name_and_place(property, fmt::format("integrator '{}'", object.type)));
  }
  if (!ignored.empty()) notes.push_back(without_effect(ignored));
  for (const Property& implied : foreign.implied)
    if (!arguments.given(implied.name)) result.properties.push_back(implied);
  return result;
}

std::string choice_note(const Object& object, const Object& native,
                        const ForeignIntegrator& foreign) {
  std::string what = native.type;
  for (const Property& property : native.properties)
    if (is_implied(property))
      what += fmt::format(" with {} = {}", property.name, std::get<int64_t>(property.value));
  return foreign.is_same ? fmt::format("integrator '{}' is called {} here", object.type, what)
                         : fmt::format("there is no integrator '{}' here: {} renders the picture",
                                       object.type, what);
}

/// Of a dialect: its renderer's own methods change no light.
bool is_nobodys(const Object& object) {
  return object.place.line > 0 && !find_foreign_integrator(object.type) &&
         !find_integrator_type(object.type) && !is_slip_of_pen(object.type, integrator_names());
}

/// What stands for an integrator that nobody knows.
Object stand_in_of(const Object& object, std::vector<std::string>& notes) {
  const Object* held = held_by(object);
  Object result = held ? *held : Object{"integrator", default_integrator, "", {}, {}, object.place};
  if (!held) result.properties = object.properties;
  notes.push_back(fmt::format("nobody knows integrator '{}': {} '{}' renders the picture",
                              object.type, held ? "the one in it," : "the default,", result.type));
  return result;
}

}  // namespace

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorType& row : integrator_types()) names.push_back(row.info.name);
  for (const ForeignIntegrator& foreign : foreign_integrators())
    if (foreign.refusal.empty())
      names.insert(names.end(), foreign.names.begin(), foreign.names.end());
  return names;
}

const ForeignIntegrator* find_foreign_integrator(const std::string& type) {
  for (const ForeignIntegrator& foreign : foreign_integrators())
    if (std::ranges::find(foreign.names, type) != foreign.names.end()) return &foreign;
  return nullptr;
}

const IntegratorType* find_integrator_type(const std::string& native) {
  for (const IntegratorType& type : integrator_types())
    if (type.info.name == native) return &type;
  return nullptr;
}

bool is_implied(const Property& property) {
  for (const ForeignIntegrator& foreign : foreign_integrators())
    for (const Property& implied : foreign.implied)
      if (implied.place.file == property.place.file) return true;
  return false;
}

std::string native_type(const Object& object) {
  const ForeignIntegrator* foreign = find_foreign_integrator(object.type);
  if (!foreign && is_nobodys(object)) {
    const Object* held = held_by(object);
    return held ? native_type(*held) : default_integrator;
  }
  if (!foreign || !foreign->refusal.empty()) return object.type;
  if (!foreign->holds_another()) return foreign->native;
  const Object* held = held_by(object);
  return held ? native_type(*held) : default_integrator;
}

Object native_integrator(const Object& object, std::vector<std::string>& notes, bool is_strict) {
  const ForeignIntegrator* foreign = find_foreign_integrator(object.type);
  if (!foreign && !is_strict && is_nobodys(object))
    return native_integrator(stand_in_of(object, notes), notes, is_strict);
  if (!foreign) return object;
  if (!foreign->refusal.empty())
    throw Error(ErrorKind::input,
                fmt::format("integrator '{}' does not render a picture of light", object.type),
                foreign->refusal, object.place);
  if (foreign->holds_another())
    return native_integrator(unwrapped(object, *foreign, notes), notes, is_strict);
  Object native = translated(object, *foreign, is_strict, notes);
  if (object.type != native.type) notes.push_back(choice_note(object, native, *foreign));
  return native;
}

}  // namespace kaustik
