#include "kaustik/loader/nori/elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/loader/mitsuba_element.h"
#include "kaustik/loader/mitsuba_transform.h"
#include "kaustik/loader/mitsuba_values.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/xml_document.h"
#include "kaustik/loader/xml_scan.h"

namespace kaustik::nori {
namespace {

using mitsuba::BadValue;

constexpr int deepest_nesting = 50;

/// Points and vectors of textures have two numbers.
Vec3d two_or_three_numbers(std::string_view text) {
  const auto parts = mitsuba::split_list(text);
  if (parts.size() != 2) return mitsuba::parse_vector(text);
  return {mitsuba::parse_float(parts[0]), mitsuba::parse_float(parts[1]), 0};
}

/// Turns the elements of a document into objects.
class ElementReader {
 public:
  explicit ElementReader(const XmlDocument& document) : document_(document) {}

  std::shared_ptr<Object> read_object(const pugi::xml_node& node, int depth = 0) {
    const Place place = document_.place(node);
    if (depth > deepest_nesting)
      throw Error(ErrorKind::input,
                  fmt::format("elements nest more than {} levels deep", deepest_nesting),
                  "take the inner ones out", place);
    auto object = make_object(node.name(), node.attribute("type").value(), place);
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() != pugi::node_element)
        throw Error(ErrorKind::input, "text that belongs to no element",
                    "values stand in attributes: value=\"…\"", document_.place(child));
      if (const auto value = value_of(child)) {
        object->properties.push_back(
            {child.attribute("name").value(), *value, document_.place(child)});
      } else {
        put(*object, child.attribute("name").value(), read_object(child, depth + 1));
      }
    }
    return object;
  }

 private:
  /// None: it is an object.
  std::optional<Value> value_of(const pugi::xml_node& node) {
    const std::string_view tag = node.name();
    try {
      if (tag == "string") return Value(std::string(attribute(node, "value")));
      if (tag == "float") return Value(mitsuba::parse_float(attribute(node, "value")));
      if (tag == "integer") return Value(mitsuba::parse_integer(attribute(node, "value")));
      if (tag == "boolean") return Value(mitsuba::parse_boolean(attribute(node, "value")));
      if (tag == "color") return Value(mitsuba::parse_rgb(attribute(node, "value")));
      if (tag == "point" || tag == "vector")
        return Value(two_or_three_numbers(attribute(node, "value")));
      if (tag == "transform") return Value(read_transform(node));
    } catch (const BadValue& bad) {
      throw Error(ErrorKind::input, bad.what(), bad.remedy,
                  bad.place.file ? bad.place : document_.place(node));
    }
    return std::nullopt;
  }

  const char* attribute(const pugi::xml_node& node, const char* name) {
    const pugi::xml_attribute found = node.attribute(name);
    if (!found)
      throw BadValue(fmt::format("<{}> lacks the attribute '{}'", node.name(), name),
                     fmt::format("write <{} name=\"…\" {}=\"…\"/>", node.name(), name));
    return found.value();
  }

  Transform read_transform(const pugi::xml_node& node) {
    Transform transform;
    for (const pugi::xml_node& child : node.children())
      transform = mitsuba::followed_by(
          transform, mitsuba::parse_transform_operation(operation_of(child), false));
    return transform;
  }

  /// As Mitsuba writes it, where the axis of a rotation is its value.
  mitsuba::Element operation_of(const pugi::xml_node& node) {
    mitsuba::Element element{node.name(), node, document_.place(node), {}};
    for (const pugi::xml_attribute& given : node.attributes()) {
      const bool is_axis = element.tag == "rotate" && std::string_view(given.name()) == "axis";
      element.attributes.push_back({is_axis ? "value" : given.name(), given.value(), given.value(),
                                    document_.place_of_name(given),
                                    document_.place_of_value(given)});
    }
    const mitsuba::AttributeRule rule = rule_of(element.tag, element.place);
    for (const std::string& name : rule.required)
      if (!element.find(name))
        throw BadValue(fmt::format("<{}> lacks the attribute '{}'", element.tag,
                                   element.tag == "rotate" && name == "value" ? "axis" : name),
                       "give all of its numbers", element.place);
    return element;
  }

  static mitsuba::AttributeRule rule_of(const std::string& tag, const Place& place) {
    if (tag == "translate" || tag == "scale" || tag == "matrix") return {{"value"}, {}};
    if (tag == "rotate") return {{"value", "angle"}, {}};
    if (tag == "lookat") return {{"origin", "target"}, {"up"}};
    throw BadValue("this is no part of a transform",
                   "write translate, scale, rotate, lookat or matrix", place);
  }

  const XmlDocument& document_;
};

bool is_one_of(const std::string& name, Given::Names names) {
  return std::find(names.begin(), names.end(), plain_name(name)) != names.end();
}

template <typename T>
std::optional<T> value_as(const Value& value) {
  const T* found = std::get_if<T>(&value);
  return found ? std::optional<T>(*found) : std::nullopt;
}

}  // namespace

std::shared_ptr<Object> read_elements(std::string text, const std::string& name) {
  const std::string root = root_tag(text);
  const XmlDocument document(std::move(text), name, root == "scene" || root == "test");
  return ElementReader(document).read_object(document.root());
}

std::string plain_name(std::string_view name) {
  std::string result;
  for (const char c : name)
    if (c != '_') result += char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string label_of(const Object& element) {
  const std::string type =
      element.type.empty() ? std::string() : " " + mitsuba::in_quotes(element.type);
  return fmt::format("{}{} on line {}", element.family.substr(0, 40), type, element.place.line);
}

Given::~Given() {
  for (const Property& property : element_.properties)
    if (!taken_.contains(&property))
      deviations_.ignored(label_of(element_),
                          mitsuba::in_quotes(property.name) + " has no meaning here",
                          property.place);
}

template <typename Convert>
auto Given::take(Names names, const Convert& convert) {
  decltype(convert(Value())) result;
  for (const Property& property : element_.properties) {
    if (!is_one_of(property.name, names)) continue;
    const auto value = convert(property.value);
    if (!value) continue;
    taken_.insert(&property);
    if (!result) result = value;
  }
  return result;
}

std::optional<double> Given::number(Names names) { return take(names, as_number); }
std::optional<Rgb> Given::colour(Names names) { return take(names, as_colour); }
std::optional<Vec3d> Given::point(Names names) { return take(names, value_as<Vec3d>); }
std::optional<std::string> Given::text(Names names) { return take(names, value_as<std::string>); }
std::optional<Transform> Given::transform(Names names) { return take(names, value_as<Transform>); }

int64_t Given::count(Names names, int64_t usual, int64_t least) {
  constexpr double most = 2e9;
  const auto given = number(names);
  if (!given) return usual;
  if (!(*given >= double(least) && *given <= most) || *given != std::floor(*given))
    throw Error(ErrorKind::input, fmt::format("{:g} is no number of {}", *given, *names.begin()),
                fmt::format("give a whole number from {} on", least), place_of(names));
  return int64_t(*given);
}

void Given::skip(Names names) {
  take(names, [](const Value& value) { return std::optional<Value>(value); });
}

Place Given::place_of(Names names) const {
  for (const Property& property : element_.properties)
    if (is_one_of(property.name, names)) return property.place;
  return element_.place;
}

}  // namespace kaustik::nori
