#pragma once
// The formats that scenes are read from, and the choice among them.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// One format.
struct SceneFormat {
  const char* name;                          ///< for messages: "Mitsuba XML"
  std::vector<std::string_view> extensions;  ///< in lower case: ".xml"
  /// Whether the first bytes of a file, unpacked, are those of this format. Never throws.
  bool (*recognises)(std::string_view head);
  /// Reads a file, which may be packed by gzip. Throws Error.
  Description (*load)(const std::string& path, const LoadOptions& options);
  /// The same from text, see parse_scene().
  Description (*parse)(std::string_view text, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options);
};

/// The registry: one row per format.
const std::vector<SceneFormat>& scene_formats();

/// The format of a file by its first bytes, unpacked, or where these tell nothing by its name
/// ("scene.xml", "scene.xml.gz"; "" for none). Throws Error(input) for what is no scene file, with
/// a list of those that are.
const SceneFormat& choose_format(const std::vector<SceneFormat>& formats, std::string_view head,
                                 const std::string& path);

/// Whether the file is called as scenes are: "scene.xml", "scene.xml.gz".
bool has_scene_name(const std::string& path);

/// Whether choose_format() finds one for the file. Throws Error(input) if it can't be read.
bool is_scene_file(const std::string& path);

/// Reads a scene file of any of the formats, packed by gzip or not; its contents say what it is
/// rather than its name. Throws Error(input) if it is none, with a list of those that can be read.
Description load_scene(const std::string& path, const LoadOptions& options = {});

/// The same from text: `name_for_messages` takes the place of the file's name in messages and
/// `base_folder` ("" for the working folder) that of its folder.
Description parse_scene(std::string text, std::string name_for_messages,
                        const std::string& base_folder, const LoadOptions& options = {});

}  // namespace kaustik
