#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "commands.h"
#include "console.h"
#include "kaustik/base/file.h"
#include "picture_output.h"
#include "render_job.h"

namespace kaustik::app {
namespace {

struct ResumeOptions {
  std::string checkpoint, scene, every = "30s";
  std::optional<std::string> time, error;
  std::vector<std::string> outputs;
  std::optional<uint32_t> passes, spp;
  int threads = 0;
  bool quiet = false;
};

/// The scene is looked for where the render was told to look for it.
void check_scene_is_there(const RenderRecipe& recipe, const std::string& checkpoint) {
  std::error_code ignored;
  if (std::filesystem::exists(recipe.scene, ignored)) return;
  throw Error(ErrorKind::input, fmt::format("its scene '{}' is not there", recipe.scene),
              fmt::format("resume in the folder '{}' where the render was begun, or say where the "
                          "scene is now: --scene FILE",
                          recipe.folder),
              place_in(checkpoint));
}

/// A changed scene would give passes that do not belong to those that are there.
void check_same(const RenderJob& job, const Checkpoint& checkpoint, const std::string& path) {
  const RenderRecipe& recipe = checkpoint.record.recipe;
  const bool same =
      job.digest == recipe.digest &&
      checkpoint.film.is_for(job.scene->film().crop_size, FilmLayers::of(*job.integrator));
  if (same) return;
  throw Error(
      ErrorKind::input,
      fmt::format("the scene '{}', or a file that it names, is not what it was when the passes {} "
                  "were rendered",
                  recipe.scene, checkpoint.film.passes().text()),
      "bring back the scene as it was, or render the new one from the start", place_in(path));
}

/// What the options say of how far to go, else what the render was told.
SessionSettings session_settings(const ResumeOptions& options, const Checkpoint& checkpoint) {
  const RenderRecord& record = checkpoint.record;
  SessionSettings settings;
  settings.seed = record.recipe.seed;
  settings.threads = usable_threads(options.threads);
  settings.samples_per_pass = record.recipe.samples_per_pass;
  settings.first_pass = record.plan.first_pass;
  settings.passes = options.passes;
  settings.samples_per_pixel = options.spp;
  if (options.time) settings.seconds = parse_duration(*options.time, "--time");
  if (options.error) settings.error = parse_error_bound(*options.error);
  if (settings.passes || settings.samples_per_pixel || settings.seconds || settings.error)
    return settings;
  settings.error = record.plan.error;
  if (record.plan.passes > 0) settings.passes = record.plan.passes;
  if (record.plan.seconds) {
    const double left_s = *record.plan.seconds - record.seconds;
    if (left_s > 0)
      settings.seconds = left_s;
    else
      settings.passes = checkpoint.film.passes().ranges().back().end - settings.first_pass;
  }
  return settings;
}

void resume(const ResumeOptions& options) {
  check_output_path(options.checkpoint);
  Checkpoint checkpoint = read_checkpoint(options.checkpoint);
  check_program(checkpoint, options.checkpoint, KAUSTIK_VERSION);
  RenderRecord& record = checkpoint.record;
  if (!options.scene.empty()) record.recipe.scene = options.scene;
  if (!options.outputs.empty()) record.outputs.files = options.outputs;
  check_outputs(record.outputs);
  check_scene_is_there(record.recipe, options.checkpoint);
  const RenderJob job = make_job(load_description(record.recipe), record.recipe, true);
  check_same(job, checkpoint, options.checkpoint);

  const SessionSettings settings = session_settings(options, checkpoint);
  record.plan.error = settings.error;
  if (!settings.seconds)
    record.plan.seconds.reset();
  else if (options.time)
    record.plan.seconds = record.seconds + *settings.seconds;
  if (!options.quiet)
    fmt::print(stderr, "{} goes on: passes {} are there\n", record.recipe.scene,
               checkpoint.film.passes().text());
  JobOptions job_options;
  job_options.quiet = options.quiet;
  job_options.checkpoint = options.checkpoint;
  job_options.every_s = parse_duration(options.every, "--every");
  run_job(job, record, settings, std::move(checkpoint.film), job_options);
}

}  // namespace

void add_resume(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "resume", "Go on with a render that was stopped: kaustik render --checkpoint.");
  command->footer(
      "The result has the same bits as a render without a break. Scene, integrator, seed and all "
      "settings are those of the checkpoint; the scene must not have changed. Without --passes, "
      "--spp, --time and --error it goes as far as the render was told to; if it was there already "
      "it only "
      "writes the picture.");
  auto o = std::make_shared<ResumeOptions>();
  command->add_option("checkpoint", o->checkpoint, "Checkpoint, .kpt; kept up to date")->required();
  command
      ->add_option("-o,--output", o->outputs,
                   "Image to write; may be repeated [as the render was told]")
      ->take_all()
      ->allow_extra_args(false);
  auto* passes =
      command->add_option("--passes", o->passes, "Number of passes, those there included")
          ->check(CLI::Range(1u, 1u << 30));
  command->add_option("--spp", o->spp, "Samples per pixel over all passes, those there included")
      ->check(CLI::Range(1u, 1u << 30))
      ->excludes(passes);
  command->add_option("--time", o->time, "Stop in time, from now: 60s, 5m, 1h");
  command->add_option("--error", o->error,
                      "Stop when the picture's relative error is at most this: 2%");
  command->add_option("--scene", o->scene, "Where the scene file is now, if it was moved");
  command->add_option("--every", o->every, "Time between checkpoints [30s]");
  command->add_option("--threads", o->threads, "Threads; 0: all [0]")->check(CLI::Range(0, 4096));
  command->add_flag("-q,--quiet", o->quiet, "No progress");
  command->callback([o] { resume(*o); });
}

}  // namespace kaustik::app
