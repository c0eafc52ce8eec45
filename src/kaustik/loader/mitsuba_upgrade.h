#pragma once
// What changed between the versions of Mitsuba's scene format. Like Mitsuba 3 itself this upgrades
// the spelling of names and tags, not the meaning of types that are gone.

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

/// Throws BadValue unless `text` is three numbers with dots between.
Version parse_version(std::string_view text);

/// The present name of a property or nested object of an object of type `object_type`.
std::string upgraded_name(const std::string& name, const std::string& object_type, Version version);

/// The present name of a tag.
std::string upgraded_tag(const std::string& tag, Version version);

/// Before version 2 a conductor without material, eta and k was of copper.
void upgrade_conductor(Object& object, Version version);

/// Turns uoffset, voffset, uscale and vscale of a texture into `to_uv`.
void upgrade_texture_placement(Object& object, Version version, Problems& problems);

}  // namespace kaustik::mitsuba
