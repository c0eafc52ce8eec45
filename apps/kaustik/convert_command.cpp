#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "commands.h"
#include "exit_codes.h"
#include "file_roles.h"
#include "kaustik/base/file.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/loader/mitsuba3_terms.h"
#include "kaustik/loader/mitsuba_writer.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/scene/deviation_report.h"
#include "kaustik/scene/named_in.h"
#include "kaustik/scene/picture_as_exr.h"
#include "kaustik/scene/shape_as_ply.h"
#include "kaustik/scene/volume_as_vol.h"
#include "option_values.h"
#include "render_job.h"
#include "scene_options.h"
#include "screen.h"
#include "signals.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

struct ConvertOptions {
  std::string scene, output;
  std::vector<std::string> definitions;
  bool is_strict = false, force = false;
};

/// Removes again what it has put where nothing was, unless all is done. A signal ends the program
/// between two files.
class NewFiles {
 public:
  NewFiles() = default;
  ~NewFiles() {
    std::error_code ignored;
    for (const std::string& path : paths_) std::filesystem::remove(path, ignored);
  }
  NewFiles(const NewFiles&) = delete;
  NewFiles& operator=(const NewFiles&) = delete;

  /// Throws EndedEarly where a signal has come.
  void write(const std::string& path, std::span<const uint8_t> bytes) {
    if (!first_signal_name().empty()) throw EndedEarly{};
    std::error_code unknown;
    const bool is_new = !std::filesystem::exists(path, unknown);
    write_file_atomically(path, bytes);
    if (is_new) paths_.push_back(path);
  }
  void keep() { paths_.clear(); }

 private:
  const InterruptGuard interrupt_;
  std::vector<std::string> paths_;
};

/// Of the name of the file, or of the object.
Place source_place(const Object& object) {
  for (const Property& property : object.properties)
    if (property.name == "filename") return property.place;
  return object.place;
}

std::vector<uint8_t> made_contents(const FileToWrite& file) {
  if (file.is_volume()) return volume_as_vol(*file.source);
  if (!file.is_mesh()) return picture_as_exr(*file.source, file.factor);
  ShapeAsPly mesh = shape_as_ply(*file.source);
  if (mesh.is_flat)
    for (const std::shared_ptr<Object>& shape : file.users) {
      std::erase_if(shape->properties, [](const Property& p) { return p.name == "face_normals"; });
      shape->properties.push_back({"face_normals", true, shape->place});
    }
  return std::move(mesh.file);
}

std::vector<uint8_t> contents_of(const FileToWrite& file) {
  try {
    return made_contents(file);
  } catch (const Error& error) {
    std::vector<Problem> problems;
    for (const Problem& problem : error.problems())
      problems.push_back(named_in(problem, source_place(*file.source)));
    throw Error(error.kind(), std::move(problems));
  }
}

void convert(const ConvertOptions& options) {
  check_scene_name(options.output);
  FileRoles roles;
  const auto writes = [&](const std::string& path) {
    roles.writes(path, any_file, options.force ? Replacing::anything : Replacing::nothing,
                 "choose another name");
  };
  roles.reads_scene(options.scene);
  writes(options.output);
  const Description description = read_scene(
      options.scene,
      {.definitions = parse_definitions(options.definitions), .is_strict = options.is_strict});
  roles.reads(description);
  roles.check();
  const std::string folder = std::filesystem::path(options.output).parent_path().string();
  const Mitsuba3Scene scene =
      in_terms_of_mitsuba3(description, description_types(), options.output);
  for (const FileToWrite& file : scene.files) writes(file.path);
  // Refuses what XML cannot hold, before anything is written.
  mitsuba_xml(scene.description, description_types(), folder, scene.version);
  for (const std::string& line : deviation_lines(description)) warn(line);
  for (const std::string& remark : scene.remarks) warn(remark);
  NewFiles written;
  for (const FileToWrite& file : scene.files) written.write(file.path, contents_of(file));
  const std::string text =
      mitsuba_xml(scene.description, description_types(), folder, scene.version);
  written.write(options.output, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  written.keep();
  for (const FileToWrite& file : scene.files)
    say("wrote {}: {} of {}, as Mitsuba 3 reads it", file.path,
        file.is_mesh()     ? "a mesh"
        : file.is_volume() ? "a volume"
                           : "a picture",
        options.scene);
  say("wrote {}: {} in Mitsuba 3's XML; all {}meshes and pictures are named as before",
      options.output, options.scene, scene.files.empty() ? "" : "other ");
}

}  // namespace

void add_convert(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "convert", "Write a scene of any format as XML of Mitsuba 3, and upgrade old spellings.");
  command->footer(
      "The new file refers to meshes and pictures in their places, relative to its own folder. "
      "Mitsuba 3 reads some of them differently (parts of OBJ files, height fields, scaled "
      "textures …). These become PLY, EXR and VOL files beside the new file; their names begin "
      "with "
      "its name.\n"
      "  kaustik convert scene.xml -o mitsuba3.xml");
  auto o = std::make_shared<ConvertOptions>();
  add_scene(*command, o->scene);
  takes_files(
      command->add_option("-o,--output", o->output, "Scene file to write, .xml")->required(),
      {"xml"});
  add_definitions(*command, o->definitions);
  add_strict(*command, o->is_strict);
  command->add_flag("--force", o->force, "Replace an existing file");
  command->callback([o] { convert(*o); });
}

}  // namespace kaustik::app
