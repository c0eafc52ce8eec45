#include "scene_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "examples.h"
#include "file_names.h"
#include "kaustik/base/error.h"
#include "kaustik/loader/scene_format.h"
#include "picture_info.h"
#include "program_files.h"

namespace kaustik::app {
namespace {

namespace fs = std::filesystem;

/// Someone may be waiting, and somewhere there are folders of a million files.
constexpr size_t most_entries = 5000;
constexpr size_t most_listed = 8;

/// Scene files by their names, in the folder and in those within it, so many floors below.
void add_scenes(const fs::path& folder, int floors, size_t& entries,
                std::vector<fs::path>& scenes) {
  std::error_code none;
  std::vector<fs::path> folders;
  for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, none), end;
       !none && at != end && ++entries <= most_entries; at.increment(none)) {
    std::error_code unknown;
    const std::string name = at->path().filename().string();
    if (at->is_directory(unknown)) {
      if (!name.starts_with('.')) folders.push_back(at->path());
    } else if (has_scene_name(name)) {
      scenes.push_back(at->path());
    }
  }
  for (const fs::path& inner : folders)
    if (floors > 0) add_scenes(inner, floors - 1, entries, scenes);
}

std::vector<fs::path> scenes_in(const fs::path& folder, int floors) {
  std::vector<fs::path> scenes;
  size_t entries = 0;
  if (!folder.empty()) add_scenes(folder, floors, entries, scenes);
  std::sort(scenes.begin(), scenes.end(), [](const fs::path& a, const fs::path& b) {
    // Near ones first.
    const auto depth = [](const fs::path& path) { return std::distance(path.begin(), path.end()); };
    return std::pair(depth(a), a) < std::pair(depth(b), b);
  });
  return scenes;
}

/// "metal_ring" of "scenes/metal_ring.xml.gz".
std::string stem_of(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.substr(0, name.find('.', 1));
}

/// "" if none has a similar name, or one that holds the one that is asked for.
fs::path nearest_scene(const fs::path& asked, const std::vector<fs::path>& scenes) {
  const std::string stem = stem_of(asked);
  std::vector<std::string> stems;
  for (const fs::path& scene : scenes) stems.push_back(stem_of(scene));
  const std::string nearest = nearest_name(stem, stems);
  for (size_t i = 0; i < scenes.size(); ++i)
    if (nearest.empty() ? stem.size() >= 3 && stems[i].find(stem) != std::string::npos
                        : stems[i] == nearest)
      return scenes[i];
  return {};
}

/// One a line.
std::string list_of_scenes(const std::vector<fs::path>& scenes) {
  const size_t listed = std::min(scenes.size(), most_listed);
  std::string list;
  for (size_t i = 0; i < listed; ++i) list += "\n    " + shown_path(scenes[i]);
  if (scenes.size() > listed) list += fmt::format("\n    and {} more", scenes.size() - listed);
  return list;
}

/// The folder that the file was to be in, or the nearest one above it that is there.
fs::path folder_asked_for(const fs::path& asked) {
  std::error_code none;
  fs::path folder = asked.parent_path();
  while (!folder.empty() && !fs::is_directory(folder, none) && folder != folder.parent_path())
    folder = folder.parent_path();
  return folder.empty() ? "." : folder;
}

/// One of a similar name.
std::string similar_scene(const fs::path& asked, const std::vector<fs::path>& nearby) {
  if (const fs::path near = nearest_scene(asked, nearby); !near.empty())
    return fmt::format("did you mean '{}'?", shown_path(near));
  if (const std::string example = nearest_name(stem_of(asked), example_names()); !example.empty())
    return fmt::format("did you mean the example? kaustik example {}", example);
  if (const fs::path near = nearest_scene(asked, scenes_in(scenes_folder(), 1)); !near.empty())
    return fmt::format("did you mean '{}'?", shown_path(near));
  return {};
}

std::string remedy_for_missing(const fs::path& asked) {
  const fs::path folder = folder_asked_for(asked);
  const std::vector<fs::path> nearby = scenes_in(folder, 1);
  std::string remedy = similar_scene(asked, nearby);
  if (remedy.empty()) remedy = "check the name; to start with there is: kaustik example";
  const std::string where = folder == "." ? "here" : fmt::format("in '{}'", folder.string());
  if (!nearby.empty())
    return remedy + fmt::format("\n  scenes {}:{}", where, list_of_scenes(nearby));
  if (const fs::path shipped = scenes_folder(); !shipped.empty())
    return remedy + fmt::format("\n  no scene is {}; many are in '{}'", where, shown_path(shipped));
  return remedy;
}

std::string remedy_for_folder(const fs::path& folder) {
  const std::vector<fs::path> scenes = scenes_in(folder, 2);
  if (scenes.empty()) return "there is no scene in it; to start with there is: kaustik example";
  return "give a scene in it:" + list_of_scenes(scenes);
}

std::string remedy_for_other_file(const std::string& path) {
  std::string formats;
  for (const SceneFormat& format : scene_formats())
    formats += fmt::format("{}{} ({})", formats.empty() ? "" : ", ", format.name,
                           fmt::join(format.extensions, ", "));
  const std::string command = command_line_for(path);
  return (command.empty() ? "" : "did you mean: " + command + "\n  ") +
         fmt::format("scenes are read from {}, also packed by gzip", formats);
}

}  // namespace

void check_scene_file(const std::string& path) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  const auto refuse = [&](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy, place_in(path));
  };
  if (status.type() == fs::file_type::not_found)
    refuse(fmt::format("cannot read '{}': {}", path,
                       std::make_error_code(std::errc::no_such_file_or_directory).message()),
           remedy_for_missing(path));
  if (status.type() == fs::file_type::directory)
    refuse(fmt::format("cannot read '{}': it is a folder", path), remedy_for_folder(path));
  if (status.type() == fs::file_type::regular && !is_scene_file(path))
    refuse("this is no scene in a format that Kaustik knows", remedy_for_other_file(path));
}

std::string command_line_for(const std::string& file) {
  const std::string extension = extension_of(file);
  if (has_scene_name(file) || file == "-") return "kaustik render " + file;
  if (extension == "kpt") return "kaustik resume " + file;
  if (extension == "kpm")
    return "kaustik render SCENE.xml --integrator photonmap --set integrator.photon_map=" + file;
  if (extension == "kln") return "kaustik render SCENE.xml --learned " + file;
  if (is_picture_name(file)) return fmt::format("kaustik tonemap {} -o PICTURE.png", file);
  return {};
}

}  // namespace kaustik::app
