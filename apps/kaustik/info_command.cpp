#include <fmt/format.h>

#include "commands.h"
#include "kaustik/render/scene_warnings.h"
#include "kaustik/scene/deviation_report.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene_report.h"
#include "render_job.h"
#include "scene_options.h"
#include "texture_memory.h"

namespace kaustik::app {
namespace {

/// Where the reader could not take the file as it is written, and how often in all.
void tell_deviations(const Description& description) {
  for (const std::string& line : deviation_lines(description)) fmt::print("{}\n", line);
  if (const std::string counts = deviation_counts(description); !counts.empty())
    fmt::print("{}\n", counts);
}

void info(const std::string& path, const std::vector<std::string>& definitions, bool is_strict,
          const std::string& camera, const BuildOptions& build) {
  const LoadOptions load = load_options(parse_definitions(definitions), is_strict);
  Description description = read_scene(path, load);
  if (const std::string others = choose_camera(description, camera); !others.empty())
    terminal_messages().tell(others);
  tell_of_memory(description, terminal_messages());
  const auto scene = build_scene(description, build);
  SceneReport report = describe_scene(*scene);
  if (const std::string coarse = coordinates_warning(*scene); !coarse.empty())
    report.warnings.push_back(coarse);
  for (const std::string& line : report.lines) fmt::print("{}\n", line);
  for (const std::string& warning : report.warnings) fmt::print("warning: {}\n", warning);
  tell_deviations(description);
}

}  // namespace

void add_info(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("info", "Print the content of a scene and warn of problems.");
  auto path = std::make_shared<std::string>();
  auto definitions = std::make_shared<std::vector<std::string>>();
  add_scene(*command, *path);
  add_definitions(*command, *definitions);
  auto is_strict = std::make_shared<bool>(false);
  add_strict(*command, *is_strict);
  auto camera = std::make_shared<std::string>();
  add_camera(*command, *camera);
  auto build = std::make_shared<BuildOptions>();
  add_texture_memory(*command, *build);
  command->callback([path, definitions, is_strict, camera, build] {
    info(*path, *definitions, *is_strict, *camera, *build);
  });
}

}  // namespace kaustik::app
