#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/loader/mitsuba_values.h"
#include "kaustik/loader/xml_document.h"

namespace kaustik::mitsuba {

struct Attribute {
  std::string name;
  std::string value;    ///< with every `$name` replaced
  std::string written;  ///< as it stands in the file
  Place name_place;
  Place place;  ///< of the value
};

/// An element whose attributes are ready to be used.
struct Element {
  std::string tag;  ///< after the upgrade from old versions
  pugi::xml_node node;
  Place place;
  std::vector<Attribute> attributes;

  const Attribute* find(std::string_view name) const;
  /// "" if it has no such attribute.
  std::string value(std::string_view name) const;
};

/// The attributes that an element must and may have.
struct AttributeRule {
  std::vector<std::string> required;
  std::vector<std::string> optional;
};

/// False, with the reasons added to `problems`, if an attribute is missing, unknown or given twice.
/// `leaves_out` is asked about unknown ones that look like no slip of the pen: true lets them pass.
bool check_attributes(const Element& element, const AttributeRule& rule, Problems& problems,
                      const std::function<bool(const Attribute&)>& leaves_out);

void add(Problems& problems, const BadValue& bad, const Place& where_unknown);

/// parse(value of the attribute); a BadValue gets the attribute's place.
template <typename Parse>
auto parse_attribute(const Attribute& attribute, const Parse& parse) {
  try {
    return parse(attribute.value);
  } catch (const BadValue& bad) {
    const bool replaced = attribute.value != attribute.written;
    throw BadValue(std::string(bad.what()) +
                       (replaced ? ", which comes from " + in_quotes(attribute.written) : ""),
                   bad.remedy, attribute.place);
  }
}

/// `value="x, y, z"`, `value="s"` for all three, or x=, y=, z= with `absent` where one is missing.
/// Throws BadValue.
Vec3d parse_components(const Element& element, double absent);

}  // namespace kaustik::mitsuba
