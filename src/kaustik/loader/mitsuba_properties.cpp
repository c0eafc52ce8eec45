// The part of Reader that reads values: from elements to properties of objects.

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "kaustik/base/wavelengths.h"
#include "kaustik/loader/mitsuba_reader.h"
#include "kaustik/loader/mitsuba_tags.h"
#include "kaustik/loader/mitsuba_transform.h"
#include "kaustik/loader/spectrum_file.h"

namespace kaustik::mitsuba {
namespace {

AttributeRule property_rule(const std::string& tag) {
  if (tag == "point" || tag == "vector") return {{"name"}, {"value", "x", "y", "z"}};
  if (tag == "spectrum") return {{"name"}, {"value", "filename"}};
  return {{"name", "value"}, {}};
}

/// Mitsuba 0.6 tells of colours whether they are a reflectance or light.
AttributeRule with_intent(AttributeRule rule, const std::string& tag, Version version) {
  if (version < first_with_snake_case && is_in({"rgb", "srgb", "spectrum"}, tag))
    rule.optional.emplace_back("intent");
  return rule;
}

Vec3d parse_point(const Element& element) {
  const bool all = element.find("x") && element.find("y") && element.find("z");
  if (!element.find("value") && !all)
    throw BadValue(fmt::format("<{}> lacks its numbers", element.tag),
                   "give value=\"x, y, z\", or x=, y= and z=");
  return parse_components(element, 0);
}

/// For Property::written.
std::string spelling_of(const Element& element, const std::string& name) {
  std::string written = element.value("name");
  return written == name ? std::string() : written;
}

size_t bytes_of(const SpectralCurve& curve) {
  return curve.samples.size() * sizeof(curve.samples[0]);
}

}  // namespace

void Reader::read_property(const Element& element, Unfinished& parent, Source& source) {
  refuse_children(element, source);
  const AttributeRule rule = with_intent(property_rule(element.tag), element.tag, source.version);
  if (!check_attributes(element, rule)) return;
  const std::string name = upgraded_name(element.value("name"), *parent.object, source.version);
  try {
    if (name.empty()) throw BadValue("a property without a name", "give its name");
    if (source.version < first_with_snake_case && parent.names.contains(name)) {
      const size_t before = std::erase_if(parent.object->properties,
                                          [&](const Property& p) { return p.name == name; });
      if (before > 0) {
        leave_out("twice " + name, fmt::format("'{}' is given twice: the last one holds", name),
                  element.place);
        parent.names.erase(name);
      }
    }
    if (!take_name(parent, name, element.place)) return;
    Value value = value_of(element, name, source);
    if (element.tag == "spectrum" && parent.object->family == "emitter")
      value = light_of(value, source);
    parent.object->properties.push_back(
        {name, std::move(value), element.place, spelling_of(element, name)});
  } catch (const BadValue& bad) {
    add(problems_, bad, element.place);
  }
}

Value Reader::light_of(const Value& spectrum, const Source& source) {
  // Since 2.0 the same at every wavelength, which is no white but pink; before, daylight.
  const auto* number = std::get_if<double>(&spectrum);
  if (!number || !(*number > 0) || source.version < Version{2, 0, 0}) return spectrum;
  return SpectralCurve{
      {{double(Wavelengths::first_nm), *number}, {double(Wavelengths::last_nm), *number}}};
}

/// Mitsuba 0.6 has an element for what is now a spectrum of this type.
void Reader::read_blackbody(const Element& element, Unfinished& parent, Source& source) {
  refuse_children(element, source);
  const char* factor =
      element.find("multiplier") && source.version < first_of_mitsuba_0_4 ? "multiplier" : "scale";
  if (!check_attributes(element, {{"name", "temperature"}, {factor}})) return;
  const std::string name = upgraded_name(element.value("name"), *parent.object, source.version);
  if (!take_name(parent, name, element.place)) return;
  const auto object = std::make_shared<Object>();
  object->family = "texture";
  object->type = element.tag;
  object->place = element.place;
  try {
    const Attribute& temperature = *element.find("temperature");
    object->properties.push_back(
        {"temperature", parse_attribute(temperature, parse_kelvin), temperature.place});
    if (const Attribute* scale = element.find(factor))
      object->properties.push_back({"scale", parse_attribute(*scale, parse_float), scale->place});
    parent.object->children.push_back({name, object});
  } catch (const BadValue& bad) {
    add(problems_, bad, element.place);
  }
}

Value Reader::value_of(const Element& element, const std::string& name, const Source& source) {
  if (element.tag == "point" || element.tag == "vector") return parse_point(element);
  if (element.tag == "spectrum") return spectrum_of(element, source);
  const Attribute& value = *element.find("value");
  if (element.tag == "float") return parse_attribute(value, parse_float);
  if (element.tag == "integer") return parse_attribute(value, parse_integer);
  if (element.tag == "boolean") return parse_attribute(value, parse_boolean);
  if (element.tag == "rgb")
    return parse_attribute(
        value, source.version < first_with_snake_case ? parse_rgb_of_old_scenes : parse_rgb);
  if (element.tag == "srgb") return parse_attribute(value, parse_srgb);
  if (!is_in(file_property_names(), name)) return value.value;
  if (value.value.empty()) throw BadValue("the file name is empty", "name a file", value.place);
  return found_or_like(value, source).string();
}

Value Reader::spectrum_of(const Element& element, const Source& source) {
  const Attribute* value = element.find("value");
  const Attribute* file = element.find("filename");
  if (!value == !file)
    throw BadValue("<spectrum> takes either 'value' or 'filename'", "give one of the two");
  const bool is_old = source.version < Version{2, 0, 0};
  const Value result = value ? parse_attribute(*value, is_old ? parse_old_spectrum : parse_spectrum)
                             : Value(curve_of(found_or_like(*file, source).string(), file->place));
  if (const auto* curve = std::get_if<SpectralCurve>(&result))
    budget_.spend(bytes_of(*curve), element.place);
  return result;
}

const SpectralCurve& Reader::curve_of(const std::string& path, const Place& place) {
  const auto known = curves_.find(path);
  if (known != curves_.end()) return known->second;
  try {
    ++counts_.files;
    const SpectralCurve& curve = curves_[path] = read_spectrum_file(path);
    sources_.insert(path);
    budget_.allow(2 * bytes_of(curve));
    return curve;
  } catch (const Error& error) {
    curves_.erase(path);
    if (error.kind() != ErrorKind::input) throw;
    const Problem& problem = error.problems().front();
    throw BadValue(problem.message, problem.remedy, problem.place.file ? problem.place : place);
  }
}

void Reader::read_transform(const Element& element, Unfinished& parent, Source& source) {
  if (!check_attributes(element, {{"name"}, {}})) return;
  Transform transform = transform_of(element, source);
  const bool is_of_camera = std::string_view(element.node.parent().name()) == "camera" &&
                            parent.object->family == "sensor" && element.value("name") == "toWorld";
  if (source.version < first_of_mitsuba_0_4 && is_of_camera)
    transform = transform * mirrored_camera();
  add_transform(element, transform, parent, source);
}

Transform Reader::transform_of(const Element& element, const Source& source) {
  Transform transform;
  for (const pugi::xml_node& node : element.node.children()) {
    if (!is_element(node, source)) continue;
    const auto operation = ready(node, source);
    if (!operation) continue;
    refuse_children(*operation, source);
    if (!is_in(transform_tags(), operation->tag)) {
      problems_.add(fmt::format("<{}> cannot stand in <transform>", operation->tag),
                    suggestion(operation->tag, transform_tags()), operation->place);
      continue;
    }
    if (!check_attributes(*operation, transform_rule(*operation, source.version))) continue;
    try {
      if (!is_strict_ && turns_nothing(*operation)) {
        leave_out("rotation", "a <rotate> without an axis turns nothing: it is left out",
                  operation->place);
        continue;
      }
      transform = followed_by(transform, parse_transform_operation(*operation, !is_strict_));
    } catch (const BadValue& bad) {
      add(problems_, bad, operation->place);
    }
  }
  return transform;
}

void Reader::add_transform(const Element& element, const Transform& transform, Unfinished& parent,
                           const Source& source) {
  const std::string name = upgraded_name(element.value("name"), *parent.object, source.version);
  if (take_name(parent, name, element.place))
    parent.object->properties.push_back(
        {name, transform, element.place, spelling_of(element, name)});
}

void Reader::read_animation(const Element& element, Unfinished& parent, Source& source) {
  if (!check_attributes(element, {{"name"}, {}})) return;
  std::optional<Transform> first;
  bool is_sound = true;
  for (const pugi::xml_node& node : element.node.children()) {
    if (!is_element(node, source)) continue;
    const auto moment = ready(node, source);
    if (!moment) continue;
    if (moment->tag != "transform") {
      problems_.add(fmt::format("<{}> cannot stand in <animation>", moment->tag),
                    "it holds transforms: <transform time=\"0\">…</transform>", moment->place);
      is_sound = false;
      continue;
    }
    if (!check_attributes(*moment, {{"time"}, {}})) {
      is_sound = false;
      continue;
    }
    const Transform transform = transform_of(*moment, source);
    if (!first) first = transform;
  }
  if (!first && !is_sound) return;
  if (!first) {
    problems_.add("an <animation> without a transform",
                  "write <animation name=\"to_world\"><transform time=\"0\">…", element.place);
    return;
  }
  leave_out("motion", "motion comes later: the first transform of an <animation> holds",
            element.place);
  add_transform(element, *first, parent, source);
}

}  // namespace kaustik::mitsuba
