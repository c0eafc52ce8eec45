#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "file_roles.h"
#include "kaustik/base/file.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/loader/mitsuba3_terms.h"
#include "kaustik/loader/mitsuba_writer.h"
#include "kaustik/loader/scene_format.h"
#include "option_values.h"
#include "render_job.h"
#include "scene_options.h"
#include "screen.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

struct ConvertOptions {
  std::string scene, output;
  std::vector<std::string> definitions;
  bool is_strict = false, force = false;
};

/// A scene is somebody's work: without --force it is not replaced.
bool is_any_file(const std::string&) { return true; }

/// Another suffix promises another format.
void check_suffix(const std::string& output) {
  const std::string suffix = std::filesystem::path(output).extension().string();
  if (suffix.empty() || suffix == ".xml") return;
  throw Error(ErrorKind::input, fmt::format("'{}' is not the name of an XML file", output),
              "scenes are written as Mitsuba 3's XML: let the name end in .xml");
}

void convert(const ConvertOptions& options) {
  check_suffix(options.output);
  FileRoles roles;
  roles.reads_scene(options.scene);
  roles.writes(options.output, {"a file with contents", is_any_file},
               options.force ? Replacing::anything : Replacing::nothing, "choose another name");
  const Description description = read_scene(
      options.scene,
      {.definitions = parse_definitions(options.definitions), .is_strict = options.is_strict});
  roles.reads(description);
  roles.check();
  const std::string folder = std::filesystem::path(options.output).parent_path().string();
  const Mitsuba3Scene scene = in_terms_of_mitsuba3(description, description_types());
  const std::string text =
      mitsuba_xml(scene.description, description_types(), folder, scene.version);
  for (const std::string& remark : scene.remarks) warn(remark);
  write_file_atomically(options.output,
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  say("wrote {}: {} in Mitsuba 3's XML; it names the same mesh and picture files", options.output,
      options.scene);
}

}  // namespace

void add_convert(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "convert", "Write a scene of any format as XML of Mitsuba 3, with old spellings upgraded.");
  command->footer(
      "Meshes and pictures stay where they are: the new file names them from its own folder.\n"
      "  kaustik convert scene.xml -o mitsuba3.xml");
  auto o = std::make_shared<ConvertOptions>();
  add_scene(*command, o->scene);
  takes_files(
      command->add_option("-o,--output", o->output, "Scene file to write, .xml")->required(),
      {"xml"});
  add_definitions(*command, o->definitions);
  add_strict(*command, o->is_strict);
  command->add_flag("--force", o->force, "Replace a file that is there");
  command->callback([o] { convert(*o); });
}

}  // namespace kaustik::app
