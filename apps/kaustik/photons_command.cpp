#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "events.h"
#include "file_roles.h"
#include "kaustik/scene/scene.h"
#include "option_values.h"
#include "part_option.h"
#include "progress_options.h"
#include "render_job.h"
#include "scene_options.h"
#include "screen.h"
#include "texture_memory.h"
#include "thesis_settings.h"
#include "thread_choice.h"

namespace kaustik::app {
namespace {

struct PhotonsOptions {
  RenderRecipe recipe;
  std::string output;
  std::vector<std::string> definitions, settings;
  LevelOptions levels;
  std::string part;
  BuildOptions build;
  int threads = 0;
  bool force = false;
  ProgressOptions progress;
};

PhotonPart part_of(const PhotonsOptions& options) {
  if (options.part.empty()) return {};
  const PartNumber part = parse_part(options.part, PhotonPart::maximum_count);
  return {part.index, part.count};
}

std::string light_name(const Scene& scene, size_t light) {
  const int shape = scene.lights()[light]->traits().shape;
  if (shape >= 0) return scene.surface(uint32_t(shape)).name;
  return scene.lights()[light]->is_infinite() ? "at infinity" : "without a surface";
}

void print_counts(const std::string& name, const LightCounts& c) {
  fmt::print("  {:28} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>11.4g}\n", name,
             c.emitted, c.stored, c.nothing, c.escaped, c.absorbed, c.too_long, c.stopped,
             c.stored_flux);
}

/// Photons are lost where they carry nothing, leave the scene, are absorbed, go on for too long, or
/// are stopped by a surface that does not send them on.
void print_map(const char* name, const Scene& scene, const PhotonMap& map,
               const MapReport& report) {
  fmt::print("{} map: {} photons, {} rays", name, map.size(), report.rays);
  if (!map.empty())
    fmt::print(", {:.1f} bytes per photon", double(map.size_in_bytes()) / double(map.size()));
  fmt::print("\n");
  if (report.lights.empty()) return;
  fmt::print("  {:28} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>11}\n", "light",
             "emitted", "stored", "nothing", "escaped", "absorbed", "too long", "stopped",
             "flux, W");
  for (size_t i = 0; i < report.lights.size(); ++i)
    print_counts(fmt::format("{}: {}", i, light_name(scene, i)), report.lights[i]);
  if (report.lights.size() > 1) print_counts("all", report.total());
}

void trace_photons(PhotonsOptions options) {
  const PhotonPart part = part_of(options);
  RenderRecipe& recipe = options.recipe;
  FileRoles roles;
  roles.reads_scene(recipe.scene);
  // Photon maps are replaced by new ones without a question, as pictures are.
  roles.writes(options.output, {"a photon map", is_photon_file},
               options.force ? Replacing::anything : Replacing::own_kind, "");
  recipe.definitions = parse_definitions(options.definitions);
  begin_events(options.progress, roles, "photons", recipe.scene);
  Description description = load_description(recipe);
  roles.reads(description);
  roles.check();
  begin_event_file(options.progress, roles, "photons", recipe.scene);
  recipe.integrator = "photonmap";
  recipe.settings =
      collected_settings(integrator_of(description, recipe), options.levels, options.settings);
  JobSettings settings;
  settings.task = JobTask::trace_photons;
  settings.record.recipe = recipe;
  settings.session.seed = recipe.seed;
  settings.session.threads = usable_threads(options.threads, options.progress.quiet);
  settings.build = options.build;
  Job job(std::move(description), std::move(settings), {terminal_messages(), {}, {}});
  TracedPhotons traced;
  run_to_the_end(job, {progress_style(options.progress), options.progress.quiet, {}},
                 [&](const ProgressFunction& progress) {
                   if (!options.progress.quiet) say("tracing photons of {}", recipe.scene);
                   traced = job.trace_photons(part, progress);
                 });
  const StoredPhotons& stored = traced.photons;
  write_photon_file(options.output, stored);

  fmt::print("scene: {} ({})\n", stored.scene, stored.fingerprint.counts);
  print_map("global", job.scene(), stored.maps.global, stored.maps.global_report);
  print_map("caustic", job.scene(), stored.maps.caustic, stored.maps.caustic_report);
  fmt::print("traced in {}, trees built in {}\n", duration_text(stored.maps.trace_seconds),
             duration_text(stored.maps.build_seconds));
  for (const std::string& warning : traced.warnings) warn(warning);
  events().written(options.output, JsonObject()
                                       .add("global", uint64_t(stored.maps.global.size()))
                                       .add("caustic", uint64_t(stored.maps.caustic.size())));
  if (!options.progress.quiet) say("wrote {}", options.output);
}

}  // namespace

void add_photons(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "photons",
      "Trace the photon maps of a scene, store them for other views, print their statistics.");
  auto o = std::make_shared<PhotonsOptions>();
  add_scene(*command, o->recipe.scene);
  takes_files(
      command->add_option("-o,--output", o->output, "Photon map to write, .kpm")->required(),
      {"kpm"});
  add_definitions(*command, o->definitions);
  add_strict(*command, o->recipe.is_strict);
  add_camera(*command, o->recipe.camera);
  add_settings(*command, o->settings, "integrator.caustic_photons=1000000, ID.radius=2");
  add_light_level(*command, o->levels);
  command->add_option("--part", o->part, "Trace only part I of N, which kaustik merge joins [all]")
      ->type_name("I/N");
  command->add_flag("--force", o->force, "Replace an existing file that is no photon map");
  command->add_option("--seed", o->recipe.seed, "Seed of all random numbers [0]");
  add_texture_memory(*command, o->build);
  add_threads(*command, o->threads);
  add_progress(*command, o->progress, "No progress");
  command->callback([o] { trace_photons(*o); });
}

}  // namespace kaustik::app
