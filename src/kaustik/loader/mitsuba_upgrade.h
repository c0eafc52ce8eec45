#pragma once
// What changed between the versions of Mitsuba's scene format: the spelling of tags, types and
// names.

#include <compare>
#include <string>
#include <string_view>

#include "kaustik/base/error.h"
#include "kaustik/scene/description.h"

namespace kaustik::mitsuba {

struct Version {
  int major = 3, minor = 0, patch = 0;
  friend auto operator<=>(const Version&, const Version&) = default;
};

inline constexpr Version first_of_mitsuba_0_3 = {0, 3, 0}, first_of_mitsuba_0_4 = {0, 4, 0};
/// Names are camelCase before it.
inline constexpr Version first_with_snake_case = {2, 0, 0};

/// Throws BadValue unless `text` is three numbers with dots between, or fewer: the others are 0.
Version parse_version(std::string_view text);

/// The present name of a tag.
std::string upgraded_tag(const std::string& tag, Version version);

/// The present name of a type.
std::string upgraded_type(const std::string& family, const std::string& type, Version version);

/// The distribution of facets that a type implied which has another name by now; "": none.
std::string implied_distribution(const std::string& family, const std::string& type,
                                 Version version);

/// The present name of a property or nested object of `parent`, whose type is a present one.
std::string upgraded_name(const std::string& name, const Object& parent, Version version);

/// Upgrades what more than one property says, or the type as it was written, or values: the
/// placement of a texture (uoffset, voffset, uscale, vscale, uvscale), the names of its filter and
/// of what lies outside of a picture, which side of the picture a camera's field of view is, where
/// a grid lies, and conductors without material, eta and k, which were of copper before version 2.
void upgrade_object(Object& object, const std::string& written_type, Version version,
                    Problems& problems);

/// Before 0.3 'diffuseAmount' and 'specularAmount' multiplied the reflectances of the bsdfs
/// 'phong', 'ward' and 'microfacet', which were others where none was given. A part of
/// upgrade_object(), which leaves what is a reference to those who have followed it.
void use_amounts(Object& object, const std::string& written_type);

/// Whether a shape takes materials from its mesh file: see use_obj_materials().
bool loads_materials(const Object& object, Version version);

}  // namespace kaustik::mitsuba
