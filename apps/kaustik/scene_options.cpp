#include "scene_options.h"

namespace kaustik::app {

void add_scene(CLI::App& command, std::string& scene) {
  command.add_option("scene", scene, "Scene file (Mitsuba XML); - for standard input")->required();
}

void add_definitions(CLI::App& command, std::vector<std::string>& definitions) {
  command.add_option("-D,--define", definitions, "Value for $name in the scene file")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

void add_settings(CLI::App& command, std::vector<std::string>& settings,
                  const std::string& examples) {
  command.add_option("--set", settings, "Change a parameter: " + examples)
      ->type_name("OBJECT.PARAMETER=VALUE")
      ->allow_extra_args(false);
}

}  // namespace kaustik::app
