#pragma once
#include <string>
#include <vector>

#include "kaustik/base/type_tables.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// A scene as Mitsuba 3 puts it.
struct Mitsuba3Scene {
  Description description;
  std::string version;  ///< that its file has to have
  /// What became something else or was left out, and what Mitsuba 3 does not know.
  std::vector<std::string> remarks;
};

/// Types and parameters that Mitsuba 3 lacks become those that it has, where these make the same
/// light: films, samplers, integrators, `mixturebsdf`, `sun` and `sky`, `sigma_s` and `sigma_a`,
/// units of daylight. What changes nothing in Kaustik and is an error there is left out. All else
/// that Mitsuba 3 does not know stays, so that Kaustik's picture does, and is named.
/// `types`: the tables of all that is known here. The given description stays as it is.
Mitsuba3Scene in_terms_of_mitsuba3(const Description& description, const TypeTables& types);

}  // namespace kaustik
