#include "kaustik/loader/mitsuba_element.h"

#include <fmt/format.h>

#include "kaustik/loader/mitsuba_tags.h"

namespace kaustik::mitsuba {
namespace {

Vec3d parse_one_or_three(std::string_view text) {
  if (split_list(text).size() != 1) return parse_vector(text);
  const double all = parse_float(split_list(text)[0]);
  return {all, all, all};
}

}  // namespace

const Attribute* Element::find(std::string_view name) const {
  for (const Attribute& attribute : attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

std::string Element::value(std::string_view name) const {
  const Attribute* attribute = find(name);
  return attribute ? attribute->value : std::string();
}

bool check_attributes(const Element& element, const AttributeRule& rule, Problems& problems,
                      const std::function<bool(const Attribute&)>& leaves_out) {
  bool sound = true;
  const auto complain = [&](const std::string& message, const std::string& remedy,
                            const Place& place) {
    problems.add(message, remedy, place);
    sound = false;
  };
  std::vector<std::string> valid = rule.required;
  valid.insert(valid.end(), rule.optional.begin(), rule.optional.end());
  std::vector<std::string> misspelt;
  for (const Attribute& attribute : element.attributes) {
    if (!is_in(valid, attribute.name)) {
      const std::string nearest = nearest_name(attribute.name.substr(0, 20), valid);
      if (nearest.empty() && leaves_out(attribute)) continue;
      misspelt.push_back(nearest);
      complain(fmt::format("<{}> has no attribute {}", element.tag, in_quotes(attribute.name)),
               suggestion(attribute.name, valid), attribute.name_place);
    } else if (element.find(attribute.name) != &attribute) {
      complain(fmt::format("attribute '{}' is given twice", attribute.name), "keep one",
               attribute.name_place);
    }
  }
  for (const std::string& name : rule.required)
    if (!element.find(name) && !is_in(misspelt, name))
      complain(fmt::format("<{}> lacks the attribute '{}'", element.tag, name),
               fmt::format("write <{} {}=\"…\">", element.tag, fmt::join(rule.required, "=\"…\" ")),
               element.place);
  return sound;
}

void add(Problems& problems, const BadValue& bad, const Place& where_unknown) {
  problems.add(bad.what(), bad.remedy, bad.place.file ? bad.place : where_unknown);
}

Vec3d parse_components(const Element& element, double absent) {
  const Attribute* value = element.find("value");
  Vec3d vector(absent, absent, absent);
  for (const int i : {0, 1, 2}) {
    const Attribute* component = element.find(std::string_view("xyz").substr(size_t(i), 1));
    if (!component) continue;
    if (value)
      throw BadValue(fmt::format("<{}> has both 'value' and '{}'", element.tag, component->name),
                     "give either value=\"x, y, z\" or x=, y= and z=", component->name_place);
    vector[i] = parse_attribute(*component, parse_float);
  }
  return value ? parse_attribute(*value, parse_one_or_three) : vector;
}

}  // namespace kaustik::mitsuba
