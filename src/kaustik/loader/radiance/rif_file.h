#pragma once
// Rad's control files (.rif): what belongs to a scene, and how it is looked at (rad.1 of Radiance).

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kaustik/base/place.h"
#include "kaustik/loader/deviations.h"
#include "kaustik/loader/radiance/statements.h"
#include "kaustik/loader/radiance/views.h"

namespace kaustik::radiance {

struct RifFile {
  std::vector<std::pair<std::string, Place>> files;  ///< scene files: materials, illums, the rest
  std::vector<std::pair<std::string, Place>> views;  ///< each a name and options
  PictureOptions picture;
};

/// Throws Error(input) for lines that are none, and for variables that nobody knows.
RifFile read_rif(std::string_view text, const PlaceAt& place_at, Deviations& deviations);

/// Whether the text begins with one of the variables.
bool begins_as_rif(std::string_view text);

}  // namespace kaustik::radiance
