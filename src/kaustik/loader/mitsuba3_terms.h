#pragma once
#include <string>
#include <vector>

#include "kaustik/base/type_tables.h"
#include "kaustik/loader/mitsuba3_files.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// A scene as Mitsuba 3 puts it.
struct Mitsuba3Scene {
  Description description;
  std::string version;  ///< that its file has to have
  /// What became something else or was left out, and what Mitsuba 3 does not know.
  std::vector<std::string> remarks;
  /// What the scene names and is still to be written: meshes, pictures.
  std::vector<FileToWrite> files;
};

/// Types and parameters that Mitsuba 3 lacks become those that it has, where these make the same
/// light: films, samplers, integrators, mixtures, textures that scale others, daylight and what
/// mitsuba3_rewrites.h has. Meshes and pictures that it does not read as Kaustik does become files
/// that are called after `scene_file` and lie beside it: parts of OBJ files, height fields, meshes
/// with `max_smooth_angle`, colours of vertices that are in no PLY file; pictures with a factor, a
/// gamma, a chosen channel. What changes nothing in Kaustik and is an error there is left out. All
/// else that Mitsuba 3 does not know stays, so that Kaustik's picture does, and is named.
/// `types`: the tables of all that is known here. The given description stays as it is.
Mitsuba3Scene in_terms_of_mitsuba3(const Description& description, const TypeTables& types,
                                   const std::string& scene_file = "scene.xml");

}  // namespace kaustik
