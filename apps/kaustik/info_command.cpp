#include <fmt/format.h>

#include "commands.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/render/scene_warnings.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/deviation_report.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/scene/scene_cameras.h"
#include "kaustik/scene/scene_report.h"
#include "picture_info.h"
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

std::string integrator_text(const Description& description) {
  const auto own = find_integrator(description);
  if (!own) return fmt::format("{}, since the scene names none", default_integrator);
  const std::string native = native_type(*own);
  return native == own->type ? native : fmt::format("{}, for the scene's {}", native, own->type);
}

std::string samples_text(const Scene& scene, const Integrator& integrator) {
  if (const int count = scene.film().sample_count; count > 0)
    return fmt::format("{} per pixel, as the scene says", count);
  return fmt::format("{} per pixel in each of {} passes, since the scene says nothing",
                     integrator.traits().default_samples_per_pass, default_passes);
}

/// Of the camera; there is one sampler for all that scenes may call for.
std::string sampler_text(const Description& description) {
  const std::string ours = "Sobol points, scrambled after Owen";
  for (const auto& camera : cameras_of(*description.scene))
    for (const Child& child : camera->children)
      if (child.object->family == "sampler")
        return fmt::format("{}, for the scene's {}", ours, child.object->type);
  return ours;
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
  const auto integrator = make_integrator(description, *scene, report.warnings);
  if (const std::string coarse = coordinates_warning(*scene); !coarse.empty())
    report.warnings.push_back(coarse);
  for (const std::string& line : report.lines) fmt::print("{}\n", line);
  fmt::print("integrator {}\n", integrator_text(description));
  fmt::print("samples    {}\n", samples_text(*scene, *integrator));
  fmt::print("sampler    {}\n", sampler_text(description));
  for (const std::string& warning : report.warnings) fmt::print("warning: {}\n", warning);
  tell_deviations(description);
}

}  // namespace

void add_info(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "info", "Print the content of a scene and warn of problems, or what a picture file holds.");
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
    if (is_picture_name(*path))
      print_picture(*path);
    else
      info(*path, *definitions, *is_strict, *camera, *build);
  });
}

}  // namespace kaustik::app
