#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "console.h"
#include "kaustik/base/file.h"
#include "numbers.h"
#include "picture_file.h"
#include "picture_output.h"
#include "render_job.h"
#include "standard_streams.h"
#include "texture_memory.h"

namespace kaustik::app {
namespace {

struct ResumeOptions {
  std::string checkpoint, scene, every = "30s";
  std::optional<std::string> time, error;
  std::vector<std::string> outputs;
  std::optional<uint32_t> passes, spp;
  BuildOptions build;
  int threads = 0;
  bool quiet = false;
};

/// The scene is looked for where the render was told to look for it.
void check_scene_is_there(const RenderRecipe& recipe, const std::string& checkpoint) {
  std::error_code ignored;
  if (is_standard_stream(recipe.scene))
    throw Error(ErrorKind::input, "its scene came from standard input",
                "say where the same scene is: --scene FILE", place_in(checkpoint));
  if (std::filesystem::exists(recipe.scene, ignored)) return;
  throw Error(ErrorKind::input, fmt::format("its scene '{}' is not there", recipe.scene),
              fmt::format("resume in the folder '{}' where the render was begun, or say where the "
                          "scene is now: --scene FILE",
                          recipe.folder),
              place_in(checkpoint));
}

/// As links have it; nothing if that cannot be told.
std::optional<std::filesystem::path> real_path(const std::filesystem::path& path) {
  std::error_code failed;
  const std::filesystem::path whole = std::filesystem::absolute(path, failed);
  if (failed) return {};
  const std::filesystem::path real = std::filesystem::weakly_canonical(whole, failed);
  if (failed) return {};
  return real;
}

bool lies_below(const std::optional<std::filesystem::path>& file,
                const std::filesystem::path& folder) {
  return file && std::mismatch(folder.begin(), folder.end(), file->begin(), file->end()).first ==
                     folder.end();
}

/// The checkpoint may come from anybody: what it names is written in and below its own folder only,
/// and what it lies in, as links have it.
void check_outputs_are_near(const std::vector<std::string>& outputs,
                            const std::string& checkpoint) {
  namespace fs = std::filesystem;
  const std::optional<fs::path> folder = real_path(fs::path(checkpoint).parent_path() / ".");
  std::vector<std::string> far;
  for (const std::string& output : outputs)
    if (is_standard_stream(output) || !folder ||
        !lies_below(real_path(output_target(output)), *folder))
      far.push_back(output);
  if (far.empty() && !outputs.empty()) return;
  if (outputs.empty())
    throw Error(ErrorKind::input, "it names no picture to write", "say what to write: -o FILE",
                place_in(checkpoint));
  throw Error(ErrorKind::input,
              fmt::format("it names pictures outside its own folder: '{}'", fmt::join(far, "', '")),
              fmt::format("if these are to be written: -o '{}'", fmt::join(outputs, "' -o '")),
              place_in(checkpoint));
}

/// "a.exr, b.png (which is there and will be replaced)"
std::string replacements(const std::vector<std::string>& outputs) {
  std::string text;
  std::error_code ignored;
  for (const std::string& output : outputs) {
    text += (text.empty() ? "" : ", ") + picture_name(output);
    if (!is_standard_stream(output) && std::filesystem::exists(output, ignored))
      text += " (replacing what is there)";
  }
  return text;
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

/// What the options say in words of their own. Read before the scene is.
struct Limits {
  std::optional<double> seconds, error;
  double every_s = 0;
};

Limits limits_of(const ResumeOptions& options) {
  Limits limits;
  if (options.time) limits.seconds = parse_duration(*options.time, "--time");
  if (options.error) limits.error = parse_error_bound(*options.error);
  limits.every_s = parse_duration(options.every, "--every");
  return limits;
}

/// What the options say of how far to go, else what the render was told.
SessionSettings session_settings(const ResumeOptions& options, const Limits& limits,
                                 const Checkpoint& checkpoint) {
  const RenderRecord& record = checkpoint.record;
  SessionSettings settings;
  settings.seed = record.recipe.seed;
  settings.threads = usable_threads(options.threads);
  settings.samples_per_pass = record.recipe.samples_per_pass;
  settings.first_pass = record.plan.first_pass;
  settings.passes = options.passes;
  settings.samples_per_pixel = options.spp;
  settings.seconds = limits.seconds;
  settings.error = limits.error;
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
  JobOptions job_options;
  const Limits limits = limits_of(options);
  FileRoles roles;
  roles.reads(options.checkpoint);
  check_output_path(options.checkpoint);
  Checkpoint checkpoint = read_checkpoint(options.checkpoint);
  check_program(checkpoint, options.checkpoint, KAUSTIK_VERSION);
  RenderRecord& record = checkpoint.record;
  if (!options.scene.empty()) record.recipe.scene = options.scene;
  if (options.outputs.empty())
    check_outputs_are_near(record.outputs.files, options.checkpoint);
  else
    record.outputs.files = options.outputs;
  roles.reads_scene(record.recipe.scene);
  check_outputs(record.outputs, roles);
  if (options.scene.empty()) check_scene_is_there(record.recipe, options.checkpoint);
  Description description = load_description(record.recipe);
  roles.reads(description);
  roles.check();
  const RenderJob job = make_job(std::move(description), record.recipe, true, options.build);
  check_same(job, checkpoint, options.checkpoint);

  const SessionSettings settings = session_settings(options, limits, checkpoint);
  record.plan.error = settings.error;
  if (!settings.seconds)
    record.plan.seconds.reset();
  else if (options.time)
    record.plan.seconds = record.seconds + *settings.seconds;
  if (!options.quiet)
    say("{} goes on: passes {} are there; to be written: {}", record.recipe.scene,
        checkpoint.film.passes().text(), replacements(record.outputs.files));
  job_options.quiet = options.quiet;
  job_options.checkpoint = options.checkpoint;
  job_options.every_s = limits.every_s;
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
                   "Image to write; may be repeated [as the render was told, in and below the "
                   "checkpoint's folder]")
      ->take_all()
      ->allow_extra_args(false);
  auto* passes =
      command->add_option("--passes", o->passes, "Number of passes, those there included")
          ->check(whole_number(1, 1 << 30));
  command->add_option("--spp", o->spp, "Samples per pixel over all passes, those there included")
      ->check(whole_number(1, 1 << 30))
      ->excludes(passes);
  command->add_option("--time", o->time, "Stop in time, from now: 60s, 5m, 1h30m");
  command->add_option("--error", o->error,
                      "Stop when the picture's relative error is at most this: 2%");
  command->add_option("--scene", o->scene, "Where the scene file is now, if it was moved");
  command->add_option("--every", o->every, "Time between checkpoints [30s]");
  add_texture_memory(*command, o->build);
  command->add_option("--threads", o->threads, "Threads; 0: all [0]")->check(whole_number(0, 4096));
  command->add_flag("-q,--quiet", o->quiet, "No progress");
  command->callback([o] { resume(*o); });
}

}  // namespace kaustik::app
