#include "kaustik/loader/radiance/radiance_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/loader/framing.h"
#include "kaustik/loader/radiance/compiled_reader.h"
#include "kaustik/loader/radiance/reader.h"
#include "kaustik/loader/radiance/rif_file.h"
#include "kaustik/loader/radiance/views.h"
#include "kaustik/loader/text_places.h"

namespace kaustik {
namespace radiance {
namespace {

namespace fs = std::filesystem;

bool begins_as_view(std::string_view text) {
  const std::string_view line = trimmed(text.substr(0, text.find('\n')));
  for (const char* start : {"rvu ", "rview ", "rpict ", "VIEW="})
    if (line.starts_with(start)) return line.find("-v") != std::string_view::npos;
  return line.starts_with("-vt") || line.starts_with("-vp ");
}

/// A scene while it is read.
class SceneLoader {
 public:
  SceneLoader(const fs::path& folder, const LoadOptions& options)
      : options_(options),
        files_(folder, options.is_strict, deviations_),
        scene_(make_object("scene", "", {})),
        reader_(files_, deviations_, *scene_) {}

  Description load(const std::string& path) {
    const Place whole = place_in(path);
    const std::string text = files_.text_of(path, whole);
    if (is_compiled(text, "Radiance_octree")) {
      reader_.read_file(path, whole);
      return finish({}, {}, whole);
    }
    if (begins_as_view(text) || is_called(path, {".vf", ".vp"})) return load_view(path, text);
    if (begins_as_rif(text) || is_called(path, {".rif"})) return load_rif(path, text);
    files_.trust(path);
    reader_.read_file(path, whole);
    return finish({}, {}, whole);
  }

  Description parse(std::string_view text, const std::string& name, const fs::path& folder) {
    const TextPlaces places(text, name, true);
    const PlaceAt place_at = [&](size_t offset) { return places.at(offset); };
    if (begins_as_rif(text)) return load_rif_text(text, place_at, folder, {}, place_in(name, 1, 1));
    reader_.read_statements_of(read_statements(text, place_at), folder);
    return finish({}, {}, place_in(name, 1, 1));
  }

 private:
  static bool is_called(const std::string& path, std::initializer_list<std::string_view> ends) {
    std::string name = path;
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    return std::any_of(ends.begin(), ends.end(),
                       [&](std::string_view end) { return name.ends_with(end); });
  }

  Description load_rif(const std::string& path, const std::string& text) {
    const TextPlaces places(text, path, begins_as_rif(text));
    return load_rif_text(
        text, [&](size_t offset) { return places.at(offset); }, fs::path(path).parent_path(), {},
        place_in(path));
  }

  /// `own_views` come before those of the file.
  Description load_rif_text(std::string_view text, const PlaceAt& place_at, const fs::path& folder,
                            std::vector<View> own_views, const Place& whole) {
    const RifFile rif = read_rif(text, place_at, deviations_);
    if (rif.files.empty())
      throw Error(ErrorKind::input, "the control file names no scene",
                  "add lines 'materials= file.mat' and 'scene= file.rad'", whole);
    bool has_part = false;
    for (const auto& [file, place] : rif.files)
      if (const auto path = files_.find_part(file, folder, place)) {
        has_part = true;
        reader_.read_file(*path, place);
      }
    if (!has_part) files_.found(rif.files[0].first, folder, rif.files[0].second);
    for (const auto& [line, place] : rif.views) {
      // A single letter such as X or -Xl asks for a view of all from that side.
      const std::string_view name = trimmed(line);
      if (name.find(" -v") == std::string_view::npos && !name.starts_with("-v")) {
        deviations_.approximated("view " + std::string(name.substr(0, 20)),
                                 "rad's own views by letters become one of all of the scene",
                                 place);
        continue;
      }
      bool is_there = true;
      View view = read_view(line, place, [&, at = place](const std::string& file) -> std::string {
        if (const auto path = files_.find(file, folder, at)) return files_.text_of(*path, at);
        is_there = false;
        deviations_.missing(fmt::format("view '{}'", file.substr(0, 100)),
                            "there is no such file: the view is left out", at);
        return "rvu -vtv";
      });
      if (is_there) own_views.push_back(std::move(view));
    }
    return finish(std::move(own_views), rif.picture, whole);
  }

  /// The control file beside it: of the same name, or the only one.
  Description load_view(const std::string& path, const std::string& text) {
    const Place whole = place_in(path);
    const auto line = view_line_of(text);
    if (!line)
      throw Error(ErrorKind::input, "the file holds no view",
                  "a view file has a line such as: rvu -vtv -vp 0 0 1.5 -vd 0 1 0", whole);
    const fs::path folder = fs::path(path).parent_path();
    View view = read_view(*line, whole, [&](const std::string& file) {
      return files_.text_of(files_.found(file, folder, whole), whole);
    });
    view.name = fs::path(path).stem().string();
    const fs::path scene = scene_beside(path);
    deviations_.approximated(
        "view " + view.name,
        fmt::format("the view is of '{}', which lies beside it", scene.string()), whole);
    const std::string scene_text = files_.text_of(scene, whole);
    if (scene.extension() != ".rif") {
      reader_.read_file(scene, whole);
      return finish({view}, {}, whole);
    }
    const TextPlaces places(scene_text, scene.string(), begins_as_rif(scene_text));
    return load_rif_text(
        scene_text, [&](size_t offset) { return places.at(offset); }, scene.parent_path(), {view},
        whole);
  }

  static fs::path scene_beside(const std::string& path) {
    const fs::path view(path);
    const fs::path folder = view.parent_path().empty() ? fs::path(".") : view.parent_path();
    std::error_code ignored;
    for (const char* extension : {".rif", ".rad"}) {
      fs::path same = view;
      same.replace_extension(extension);
      if (fs::is_regular_file(same, ignored)) return same;
    }
    std::vector<fs::path> controls, scenes;
    size_t looked_at = 0;
    for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
         entry.increment(ignored)) {
      if (++looked_at > 10'000) break;
      if (entry->path().extension() == ".rif") controls.push_back(entry->path());
      if (entry->path().extension() == ".rad") scenes.push_back(entry->path());
    }
    if (controls.size() == 1) return controls[0];
    if (controls.empty() && scenes.size() == 1) return scenes[0];
    throw Error(ErrorKind::input, "the view file does not say of which scene it is",
                "render a .rif file that names the view and the scene, or give scene and view the "
                "same name",
                place_in(path));
  }

  Description finish(std::vector<View> views, const PictureOptions& picture, const Place& whole) {
    reader_.finish();
    for (const View& view : views) nest(*scene_, camera_of(view, picture, deviations_));
    Description description{scene_};
    scene_->place = whole;
    Framing framing(description, deviations_, {}, UpAxis::z);
    framing.add_missing_camera();
    if (!is_lit(description)) framing.add_studio_light();
    description.sources.assign(files_.sources().begin(), files_.sources().end());
    description.is_strict = options_.is_strict;
    deviations_.finish(description, options_.is_strict);
    return description;
  }

  const LoadOptions& options_;
  Deviations deviations_;
  SceneFiles files_;
  ObjectPointer scene_;
  SceneReader reader_;
};

}  // namespace
}  // namespace radiance

namespace {

/// Transforms out of all bounds, of views and of the scene as a whole.
template <typename Read>
Description within_bounds(const Read& read, const std::string& name) {
  try {
    return read();
  } catch (const std::invalid_argument&) {
    throw Error(ErrorKind::input, "a view, or all of the scene, is larger than numbers go",
                "check the numbers of views (-vp, -vd, -vu), and of the scene's transforms",
                place_in(name));
  }
}

}  // namespace

bool is_radiance(std::string_view head) {
  return radiance::is_compiled(head, "Radiance_octree") || radiance::begins_as_rif(head) ||
         radiance::begins_as_view(head) || radiance::begins_as_statements(head);
}

Description load_radiance(const std::string& path, const LoadOptions& options) {
  return within_bounds(
      [&] {
        return radiance::SceneLoader(std::filesystem::path(path).parent_path(), options).load(path);
      },
      path);
}

Description parse_radiance(std::string_view text, std::string name_for_messages,
                           const std::string& base_folder, const LoadOptions& options) {
  return within_bounds(
      [&] {
        return radiance::SceneLoader(base_folder, options)
            .parse(text, name_for_messages, base_folder);
      },
      name_for_messages);
}

}  // namespace kaustik
