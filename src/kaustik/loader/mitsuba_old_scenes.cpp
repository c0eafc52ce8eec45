// The part of Reader that mends what older versions and other programs wrote, once an object or
// the whole scene is read.

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/mitsuba_reader.h"
#include "kaustik/loader/mitsuba_sky.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::mitsuba {

namespace {

/// What a surface that makes light is scaled to, as by Mitsuba 0.6.
constexpr double largest_reflectance = 0.99;

/// Lane by lane; zeros where the value is no colour.
Rgb colour_of(const Value& value) {
  if (const auto* colour = std::get_if<Rgb>(&value)) return *colour;
  const auto* number = std::get_if<double>(&value);
  return number ? Rgb{*number, *number, *number} : Rgb{0, 0, 0};
}
double largest_lane(const Rgb& colour) { return std::max({colour.r, colour.g, colour.b}); }

}  // namespace

void Reader::scale_sum_of_reflectances(Object& object) {
  if (object.family != "bsdf" || (object.type != "phong" && object.type != "ward")) return;
  std::vector<Property*> shares;
  Rgb sum{0, 0, 0};
  for (Property& property : object.properties) {
    if (property.name != "diffuse_reflectance" && property.name != "specular_reflectance") continue;
    shares.push_back(&property);
    const Rgb share = colour_of(property.value);
    sum = {sum.r + share.r, sum.g + share.g, sum.b + share.b};
  }
  if (!(largest_lane(sum) > 1)) return;
  for (Property* share : shares)
    multiply_value(share->value, largest_reflectance / largest_lane(sum));
  leave_out("sum of reflectances",
            fmt::format("the reflectances of '{}' add up to {:.4g}, which makes light: they are "
                        "scaled to {}",
                        object.type, largest_lane(sum), largest_reflectance),
            shares.front()->place);
}

void Reader::leave_out_specular(Object& object) {
  if (object.family != "bsdf" || object.type != "principled") return;
  const auto given = [&](const char* name) {
    return std::find_if(object.properties.begin(), object.properties.end(),
                        [&](const Property& property) { return property.name == name; });
  };
  const auto specular = given("specular");
  if (specular == object.properties.end() || given("eta") == object.properties.end()) return;
  leave_out("specular", "'specular' is left out beside 'eta', which says the same",
            specular->place);
  object.properties.erase(specular);
}

void Reader::scale_reflectances(Object& object) {
  for (Property& property : object.properties) {
    const std::string& name = property.name;
    if (!name.ends_with("reflectance") && !name.ends_with("transmittance") && name != "base_color")
      continue;
    const double most = largest_lane(colour_of(property.value));
    if (!(most > 1)) continue;
    multiply_value(property.value, largest_reflectance / most);
    leave_out("reflectance",
              fmt::format("'{}' is above 1, which makes light: it is scaled to {}",
                          property.spelling(), largest_reflectance),
              property.place);
  }
}

void Reader::open_old_shapes() {
  const auto holds = [](const Object& shape, const char* family) {
    return std::any_of(shape.children.begin(), shape.children.end(),
                       [&](const Child& child) { return child.object->family == family; });
  };
  for (const std::shared_ptr<Object>& shape : old_shapes_) {
    if (!holds(*shape, "medium") || holds(*shape, "bsdf") || holds(*shape, "emitter")) continue;
    const auto boundary = std::make_shared<Object>();
    boundary->family = "bsdf";
    boundary->type = "null";
    boundary->place = shape->place;
    shape->children.push_back({"", boundary});
  }
}

void Reader::finish_old_bsdfs() {
  for (const OldBsdf& old : old_bsdfs_) {
    if (old.version < first_of_mitsuba_0_3) use_amounts(*old.bsdf, old.written_type);
    for (Child& child : old.bsdf->children)
      if (child.object->family == "bsdf") child.name.clear();
  }
}

void Reader::put_last_sensor_first(Object& scene) {
  const auto is_sensor = [](const Child& child) { return child.object->family == "sensor"; };
  const auto first = std::find_if(scene.children.begin(), scene.children.end(), is_sensor);
  const auto behind_last =
      std::find_if(scene.children.rbegin(), scene.children.rend(), is_sensor).base();
  if (first < behind_last) std::rotate(first, behind_last - 1, behind_last);
}

namespace {

/// One that is not among `visited`.
bool holds_emitter(const Object& object, std::set<const Object*>& visited) {
  if (!visited.insert(&object).second) return false;
  return object.family == "emitter" ||
         std::any_of(object.children.begin(), object.children.end(),
                     [&](const Child& child) { return holds_emitter(*child.object, visited); });
}

}  // namespace

void Reader::light_dark_scene(Object& scene) {
  std::set<const Object*> visited;
  if (holds_emitter(scene, visited)) return;
  if (is_strict_) {
    problems_.add("the scene has no emitter", "add one, such as <emitter type=\"constant\"/>",
                  scene.place);
    return;
  }
  const std::shared_ptr<Object> emitter = emitter_of_dark_scenes(version_, scene.place);
  scene.children.push_back({"", emitter});
  leave_out("emitter",
            fmt::format("the scene has no emitter: a '{}' lights it, as in Mitsuba of that version",
                        emitter->type),
            scene.place);
}

void Reader::tell_units_of_daylight(const Object& scene) {
  if (daylights_.empty()) return;
  const Object& first = *daylights_.front();
  if (!lacks_units(first)) {
    leave_out("units of daylight",
              fmt::format("'{}' is per nanometre, as in Mitsuba: 1/408 of W/(sr·m²)", first.type),
              first.place);
    return;
  }
  // Alone it makes a picture that is brighter, and no other one.
  std::set<const Object*> visited(daylights_.begin(), daylights_.end());
  if (!holds_emitter(scene, visited)) return;
  leave_out("units of daylight",
            fmt::format("'{}' is in W/(sr·m²), beside other lamps 408 times as bright as in "
                        "Mitsuba; give it <string name=\"units\" value=\"mitsuba\"/> for that, or "
                        "\"physical\"",
                        first.type),
            first.place);
}

}  // namespace kaustik::mitsuba
