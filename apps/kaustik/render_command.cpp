#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "begun_render.h"
#include "commands.h"
#include "file_broadcast.h"
#include "file_roles.h"
#include "kaustik/base/file.h"
#include "kaustik/base/version.h"
#include "kaustik/image/tone_mapping.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/render/program_version.h"
#include "numbers.h"
#include "option_values.h"
#include "part_option.h"
#include "picture_output.h"
#include "progress_options.h"
#include "render_job.h"
#include "render_team.h"
#include "scene_options.h"
#include "screen.h"
#include "standard_streams.h"
#include "texture_memory.h"
#include "thesis_settings.h"
#include "thread_choice.h"

namespace kaustik::app {
namespace {

struct RenderOptions {
  RenderRecipe recipe;
  OutputPlan outputs;
  std::vector<std::string> definitions, settings;
  std::optional<std::string> time, error, checkpoint, learned, part;
  std::string every = "30s";
  std::optional<uint32_t> passes, spp;
  uint32_t first_pass = 0;
  LevelOptions levels;
  BuildOptions build;
  int threads = 0;
  std::optional<double> exposure;
  bool force = false, resume_if_there = false, broadcast_scene = false;
  ProgressOptions progress;
  ViewOptions views;
};

/// "tonemap.key=0.3" is for the tone mapping operator, everything else for the scene.
void sort_settings(RenderOptions& options) {
  const std::string prefix = "tonemap.";
  const auto for_scene = std::stable_partition(
      options.settings.begin(), options.settings.end(),
      [&](const std::string& setting) { return !setting.starts_with(prefix); });
  for (auto setting = for_scene; setting != options.settings.end(); ++setting)
    options.outputs.tone_settings.push_back(setting->substr(prefix.size()));
  options.settings.erase(for_scene, options.settings.end());
  if (options.exposure)
    options.outputs.tone_settings.push_back(fmt::format("exposure={}", *options.exposure));
}

/// Without a name for the picture: the scene's. Parts make none, since all would write the same
/// file.
void name_picture(RenderOptions& options) {
  if (!options.outputs.files.empty() || options.part) return;
  const std::string& scene = options.recipe.scene;
  if (is_standard_stream(scene))
    throw Error(ErrorKind::input, "a scene from standard input gives its picture no name",
                "say what to write: -o FILE");
  const char* const extension = options.recipe.points.empty() ? ".exr" : ".csv";
  options.outputs.files.push_back(std::filesystem::path(scene).stem().string() + extension);
}

/// Whether there is one to go on with.
bool check_checkpoint(const RenderOptions& options, FileRoles& roles) {
  if (!options.checkpoint) return false;
  const std::string& path = *options.checkpoint;
  if (is_follower()) return options.resume_if_there && is_begun(path);
  if (options.resume_if_there && is_begun(path)) {
    roles.reads(path);
    check_output_path(path);
    return true;
  }
  roles.writes(path, {"a checkpoint", is_checkpoint},
               options.force ? Replacing::anything : Replacing::nothing,
               fmt::format("go on with it: kaustik resume {}, or --resume-if-there", path));
  return false;
}

SessionSettings session_settings(const RenderOptions& options) {
  SessionSettings settings;
  settings.seed = options.recipe.seed;
  settings.first_pass = options.first_pass;
  settings.passes = options.passes;
  settings.samples_per_pixel = options.spp;
  if (options.part) {
    const PartNumber part = parse_part(*options.part, PassPart::maximum_count);
    settings.part = PassPart{part.index, part.count};
  }
  if (options.time) settings.seconds = parse_duration(*options.time, "--time");
  if (options.error) settings.error = parse_error_bound(*options.error);
  // Who goes on from a checkpoint may ask for other pictures.
  settings.layers = options.checkpoint.has_value() || needs_layers(options.outputs);
  return settings;
}

/// Time ends a part early; it is no goal of its own.
StopPlan stop_plan(const SessionSettings& session) {
  StopPlan plan{session.first_pass, 0, session.seconds, session.error};
  if (session.part) plan.seconds.reset();
  return plan;
}

/// A part has to know what all passes before it teach, as other parts have.
void tell_of_learning(const std::optional<Object>& integrator, const RenderOptions& options) {
  if (!options.part || options.learned || options.progress.quiet) return;
  const std::string type = integrator ? native_type(*integrator) : default_integrator;
  const auto& learning = learning_integrators();
  if (std::find(learning.begin(), learning.end(), type) != learning.end())
    note(
        fmt::format("{}: each part learns for itself, from the passes before it, too. To learn "
                    "once for all parts: kaustik learn, then --learned",
                    type));
}

/// What is written, shown and told, the leader does.
void leave_to_leader(RenderOptions& options) {
  options.outputs.files.clear();
  options.progress = {};
  options.progress.quiet = true;
  options.views = {};
}

/// All that the command reads.
std::set<std::string> files_read_by(const RenderOptions& options) {
  if (is_standard_stream(options.recipe.scene))
    throw Error(ErrorKind::input, "a scene from standard input cannot be broadcast",
                "save it, and give the name of the file");
  RenderRecipe recipe = options.recipe;
  recipe.definitions = parse_definitions(options.definitions);
  std::set<std::string> files = files_of(load_description(recipe));
  files.insert(recipe.scene);
  if (!recipe.points.empty()) files.insert(recipe.points);
  if (options.learned) files.insert(*options.learned);
  if (options.checkpoint && options.resume_if_there && is_begun(*options.checkpoint))
    files.insert(*options.checkpoint);
  return files;
}

/// Copies of the leader's files, and their names here; none where nobody has asked for them.
std::unique_ptr<FileBroadcast> broadcast_files(RenderOptions& options) {
  if (!options.broadcast_scene) return nullptr;
  auto files = std::make_unique<FileBroadcast>(
      *render_team(), is_follower() ? std::set<std::string>() : files_read_by(options));
  std::string& points = options.recipe.points;
  for (std::string* path : {&options.recipe.scene, &points}) *path = files->here(*path);
  for (std::optional<std::string>* path : {&options.learned, &options.checkpoint})
    if (*path) *path = files->here(**path);
  return files;
}

void render(RenderOptions options) {
  JobSettings job;
  RenderRecipe& recipe = options.recipe;
  check_views(options.views);
  const auto copies = broadcast_files(options);
  FileRoles roles;
  roles.reads_scene(recipe.scene);
  if (!recipe.points.empty()) roles.reads(recipe.points);
  if (options.learned) {
    roles.reads(*options.learned);
    job.learned = read_lessons(*options.learned);
    job.learned_path = *options.learned;
    check_program(*options.learned, job.learned->program, KAUSTIK_VERSION);
  }
  name_picture(options);
  job.session = session_settings(options);
  job.session.team = render_team();
  if (is_follower()) leave_to_leader(options);
  sort_settings(options);
  check_outputs(options.outputs, roles);
  const bool goes_on = check_checkpoint(options, roles);
  job.checkpoint = options.checkpoint.value_or("");
  if (options.resume_if_there) job.owner = CheckpointOwner::perhaps_several;
  job.every_s = parse_duration(options.every, "--every");
  job.build = options.build;

  recipe.folder = std::filesystem::current_path().string();
  recipe.definitions = parse_definitions(options.definitions);
  begin_events(options.progress, roles, "render", recipe.scene);
  job.session.threads = usable_threads(options.threads, options.progress.quiet);
  if (render_team() && !options.progress.quiet)
    note(fmt::format("{} processes share the passes", render_team()->size()));
  Description description = load_description(recipe);
  roles.reads(description);
  roles.check();
  begin_event_file(options.progress, roles, "render", recipe.scene);
  // What the thesis sets is a photon map's.
  if (!integrator_of(description, recipe) && sets_thesis_photon_map(options.levels))
    recipe.integrator = "photonmap";
  recipe.settings =
      collected_settings(integrator_of(description, recipe), options.levels, options.settings);
  tell_of_learning(integrator_of(description, recipe), options);
  job.integrator_origin = integrator_origin;
  RenderRecord& record = job.record;
  record.program = KAUSTIK_VERSION;
  record.recipe = recipe;
  record.plan = stop_plan(job.session);
  record.outputs = options.outputs;
  if (goes_on) {
    go_on_with(*options.checkpoint, job);
    if (!options.progress.quiet)
      say("{} goes on: passes {} are there", *options.checkpoint, job.begun->film.passes().text());
  }
  run_job(std::move(description), std::move(job),
          {progress_style(options.progress), options.progress.quiet, options.views});
}

}  // namespace

void add_render(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Render a scene to image files.");
  command->footer(
      "Ctrl-C, SIGTERM and SIGHUP end the render: it writes the finished passes and exits with 75. "
      "A second signal ends the program at once. In the first pass it writes a picture of fewer "
      "samples, or nothing if a pixel has no sample yet. SIGUSR1 writes the picture as it is, and "
      "the render goes on. A part that --time ends before its last pass exits with 75, too.\n"
      "A meter's value goes to standard error, in lx or cd/m², with its 95 % interval.\n"
      "Each line of JSON has an \"event\": start, progress, measured, written, message or end. "
      "With "
      "--progress json the lines go to standard error, with all messages. With --progress-file "
      "they go elsewhere, and messages stay text.\n"
      "Environment variables photonMap.… set integrator photonmap as in Schregle's thesis: kaustik "
      "help thesis.");
  auto options = std::make_shared<RenderOptions>();
  add_scene(*command, options->recipe.scene);
  takes_files(
      command
          ->add_option(
              "-o,--output", options->outputs.files,
              "Image to write; the extension gives the format: exr, hdr, pfm, tif (LogLuv), png, "
              "jpg, ppm, and csv for a table of what a meter shows; - or png:- for standard "
              "output; may be repeated [SCENE.exr]")
          ->take_all()
          ->allow_extra_args(false),
      rendered_extensions());
  add_definitions(*command, options->definitions);
  add_strict(*command, options->recipe.is_strict);
  add_camera(*command, options->recipe.camera);
  takes_files(
      command->add_option("--points", options->recipe.points,
                          "Measure the illuminance at points instead of making a picture: "
                          "a text file with x y z of each and of its normal [to SCENE.csv]"),
      {"txt", "pts", "csv"})
      ->excludes(command->get_option("--camera"));
  add_settings(*command, options->settings,
               "integrator.caustic_neighbors=200, film.width=400, ID.radius=2");
  takes_words(
      command->add_option("--integrator", options->recipe.integrator,
                          fmt::format("Use this method instead of the file's: {} (and other "
                                      "renderers' names: kaustik help integrator)",
                                      fmt::join(integrator_names(), ", "))),
      integrator_names(), "METHOD");
  add_light_level(*command, options->levels);
  add_eye_level(*command, options->levels);
  command->add_option("--passes", options->passes, "Number of passes")
      ->check(whole_number(1, 1 << 30));
  command
      ->add_option("--spp", options->spp,
                   "Samples per pixel over all passes; more of them make more passes [without "
                   "--passes, --time and --error the sampler's sample_count in the scene, else 16 "
                   "passes of the method's usual number]")
      ->check(whole_number(1, 1 << 30));
  auto* error =
      takes(command->add_option("--error", options->error,
                                "Stop when the picture's relative error is at most this, such as "
                                "2% (checked after 16, 32, 64, … passes)"),
            "PERCENT");
  command
      ->add_option("--first-pass", options->first_pass,
                   "Number of the first pass; --passes and --spp count from it [0]")
      ->check(whole_number(0, 1 << 30));
  takes(command->add_option("--time", options->time,
                            "Time limit, such as 60s, 5m, 1h30m; writes a first look if pixels "
                            "have no samples by then"),
        "TIME");
  auto* checkpoint = takes_files(
      command->add_option(
          "--checkpoint", options->checkpoint,
          "Keep the finished passes in this file, .kpt, for kaustik resume and kaustik merge"),
      {"kpt"});
  takes(command
            ->add_option("--every", options->every,
                         "Time between checkpoints, such as 30s, 5m, 1h [30s]")
            ->needs(checkpoint),
        "TIME");
  auto* force = command->add_flag("--force", options->force, "Replace an existing checkpoint")
                    ->needs(checkpoint);
  command
      ->add_flag(
          "--resume-if-there", options->resume_if_there,
          "Go on with the checkpoint if it exists; for commands that are repeated until they "
          "are done")
      ->needs(checkpoint)
      ->excludes(force);
  command
      ->add_option(
          "--part", options->part,
          "Render part I of N of the passes that --passes or --spp name, for kaustik merge")
      ->type_name("I/N")
      ->needs(checkpoint)
      ->excludes(error);
  takes_files(command->add_option("--learned", options->learned,
                                  "Lessons for all passes, .kln, from kaustik learn"),
              {"kln"});
  command->add_option("--seed", options->recipe.seed, "Seed of all random numbers [0]");
  add_texture_memory(*command, options->build);
  add_threads(*command, options->threads);
  takes_words(command->add_option("--tonemap", options->outputs.tone,
                                  "Operator for 8-bit images and previews [histogram]; --set "
                                  "tonemap.key=0.3 sets its parameters"),
              tone_operator_names());
  command->add_option("--exposure", options->exposure, "The same as --set tonemap.exposure=…");
  command->add_flag("--float", options->outputs.full_float,
                    "EXR with 32-bit instead of 16-bit floats");
  command->add_flag("--denoise", options->outputs.denoise,
                    "Smooth the picture's noise like kaustik denoise; the EXR's layers keep it");
  command->add_flag("--reproducible", options->outputs.reproducible,
                    "Write no times, so equal renders give equal files");
  if (render_team())
    command->add_flag("--broadcast-scene", options->broadcast_scene,
                      "Only process 0 reads the scene's files; the others get copies in their "
                      "folder for temporary files");
  add_progress(*command, options->progress, "No progress, notes and values of meters");
  add_views(*command, options->views);
  command->callback([options] { render(*options); });
}

}  // namespace kaustik::app
