#include <fmt/format.h>

#include "commands.h"
#include "kaustik/render/scene_warnings.h"
#include "kaustik/scene/scene_report.h"
#include "render_job.h"
#include "scene_options.h"
#include "texture_memory.h"

namespace kaustik::app {
namespace {

void info(const std::string& path, const std::vector<std::string>& definitions,
          const BuildOptions& build) {
  LoadOptions load;
  load.definitions = parse_definitions(definitions);
  const Description description = read_scene(path, load);
  tell_of_memory(description, terminal_messages());
  const auto scene = build_scene(description, build);
  SceneReport report = describe_scene(*scene);
  if (const std::string coarse = coordinates_warning(*scene); !coarse.empty())
    report.warnings.push_back(coarse);
  for (const std::string& line : report.lines) fmt::print("{}\n", line);
  for (const std::string& warning : report.warnings) fmt::print("warning: {}\n", warning);
}

}  // namespace

void add_info(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("info", "Print what is in a scene and warn of what can't work.");
  auto path = std::make_shared<std::string>();
  auto definitions = std::make_shared<std::vector<std::string>>();
  add_scene(*command, *path);
  add_definitions(*command, *definitions);
  auto build = std::make_shared<BuildOptions>();
  add_texture_memory(*command, *build);
  command->callback([path, definitions, build] { info(*path, *definitions, *build); });
}

}  // namespace kaustik::app
