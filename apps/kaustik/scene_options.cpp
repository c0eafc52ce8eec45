#include "scene_options.h"

#include <fmt/format.h>

#include "file_names.h"
#include "kaustik/base/error.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/scene_format.h"
#include "numbers.h"
#include "option_values.h"
#include "program_files.h"

namespace kaustik::app {
namespace {

/// "Mitsuba XML, …".
std::string format_names() {
  std::string names;
  for (const SceneFormat& format : scene_formats())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", format.name);
  return names;
}

}  // namespace

void add_scene(CLI::App& command, std::string& scene) {
  CLI::Option* option = command.add_option(
      "scene", scene,
      fmt::format("Scene file ({}), or scenes/… of the installation; - for standard input",
                  format_names()));
  takes_files(option->required(), scene_extensions());
  option->transform([](const std::string& path) {
    if (path.empty())
      throw Error(ErrorKind::input, "the name of the scene is empty",
                  "name a scene file; to start with there is: kaustik example");
    return scene_file(path);
  });
}

void check_scene_name(const std::string& output) {
  const std::string extension = extension_of(output);
  if (extension.empty() || extension == "xml") return;
  throw Error(ErrorKind::input, fmt::format("'{}' is not the name of an XML file", output),
              "scenes are written as Mitsuba 3's XML: let the name end in .xml");
}

void add_threads(CLI::App& command, int& threads) {
  command
      .add_option("--threads", threads, "Threads; 0: as many as the process may run at a time [0]")
      ->check(whole_number(0, 4096));
}

void add_definitions(CLI::App& command, std::vector<std::string>& definitions) {
  command.add_option("-D,--define", definitions, "Value for $name in the scene file")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

void add_camera(CLI::App& command, std::string& camera) {
  command
      .add_option("--camera", camera,
                  "Id of the camera to use [the first; of scenes before Mitsuba 2 the last]")
      ->type_name("ID");
}

void add_strict(CLI::App& command, bool& is_strict) {
  command.add_flag(
      "--strict", is_strict,
      "Refuse unknown parameters and elements, instead of ignoring them with a warning; what is "
      "known and has no effect stays a warning");
}

void add_settings(CLI::App& command, std::vector<std::string>& settings,
                  const std::string& examples) {
  command.add_option("--set", settings, "Change a parameter: " + examples)
      ->type_name("OBJECT.PARAMETER=VALUE")
      ->allow_extra_args(false);
  command.add_flag_callback(
      "--spectral", [&settings] { settings.emplace_back("film.color=spectral"); },
      "Follow light at wavelengths: glass disperses, measured spectra count as they are");
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorType& type : integrator_types()) names.push_back(type.info.name);
  return names;
}

const std::vector<std::string>& learning_integrators() {
  static const std::vector<std::string> names{"auto", "vcm", "ppm", "bdpt"};
  return names;
}

}  // namespace kaustik::app
