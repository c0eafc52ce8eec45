#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "kaustik/base/file.h"
#include "kaustik/base/version.h"
#include "kaustik/render/program_version.h"
#include "kaustik/render/resume.h"
#include "numbers.h"
#include "option_values.h"
#include "picture_file.h"
#include "picture_output.h"
#include "progress_options.h"
#include "render_job.h"
#include "scene_options.h"
#include "screen.h"
#include "standard_streams.h"
#include "texture_memory.h"
#include "thread_choice.h"

namespace kaustik::app {
namespace {

struct ResumeOptions {
  std::string checkpoint, scene, every = "30s";
  std::optional<std::string> time, error;
  std::vector<std::string> outputs;
  std::optional<uint32_t> passes, spp;
  BuildOptions build;
  int threads = 0;
  ProgressOptions progress;
  ViewOptions views;
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

/// The checkpoint may come from anybody: what it names is written in and below its own folder only,
/// and what it lies in, as links have it. Only parts need name none.
void check_outputs_are_near(const std::vector<std::string>& outputs, const std::string& checkpoint,
                            bool is_part) {
  if (outputs.empty() && !is_part)
    throw Error(ErrorKind::input, "it names no picture to write", "say what to write: -o FILE",
                place_in(checkpoint));
  std::vector<std::string> files = outputs, far;
  std::erase_if(files, is_standard_stream);
  far = files_outside_its_folder(files, checkpoint);
  std::ranges::copy_if(outputs, std::back_inserter(far), is_standard_stream);
  if (far.empty()) return;
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
  SessionSettings settings = settings_to_go_on(checkpoint);
  settings.threads = usable_threads(options.threads, options.progress.quiet);
  if (!options.passes && !options.spp && !limits.seconds && !limits.error) return settings;
  const bool is_part = checkpoint.record.plan.division.is_divided();
  // A part's passes are its own whatever the time.
  if (!is_part || options.passes || options.spp) settings.passes = options.passes;
  settings.samples_per_pixel = options.spp;
  settings.seconds = limits.seconds;
  settings.error = limits.error;
  return settings;
}

void resume(const ResumeOptions& options) {
  JobSettings job;
  const Limits limits = limits_of(options);
  check_views(options.views);
  FileRoles roles;
  roles.reads(options.checkpoint);
  check_output_path(options.checkpoint);
  Checkpoint checkpoint = read_checkpoint(options.checkpoint);
  check_program(options.checkpoint, checkpoint.record.program, KAUSTIK_VERSION);
  RenderRecord& record = checkpoint.record;
  if (!options.scene.empty()) record.recipe.scene = options.scene;
  if (options.outputs.empty())
    check_outputs_are_near(record.outputs.files, options.checkpoint,
                           record.plan.division.is_divided());
  else
    record.outputs.files = options.outputs;
  roles.reads_scene(record.recipe.scene);
  if (!record.recipe.points.empty()) roles.reads(record.recipe.points);
  check_outputs(record.outputs, roles);
  if (options.scene.empty()) check_scene_is_there(record.recipe, options.checkpoint);
  begin_events(options.progress, roles, "resume", record.recipe.scene);
  Description description = load_description(record.recipe);
  roles.reads(description);
  roles.check();
  begin_event_file(options.progress, roles, "resume", record.recipe.scene);
  job.session = session_settings(options, limits, checkpoint);
  // With other passes it is no part any more.
  if (options.passes || options.spp) record.plan.division = {};
  record.plan.error = job.session.error;
  if (!job.session.seconds)
    record.plan.seconds.reset();
  else if (options.time && !record.plan.division.is_divided())
    record.plan.seconds = record.seconds + *job.session.seconds;
  job.record = record;
  job.integrator_origin = integrator_origin;
  job.build = options.build;
  job.checkpoint = options.checkpoint;
  job.every_s = limits.every_s;
  job.begun = std::move(checkpoint);
  job.begun_path = options.checkpoint;
  const std::string text =
      fmt::format("{} goes on: passes {} are there; to be written: {}", job.record.recipe.scene,
                  job.begun->film.passes().text(), replacements(job.record.outputs.files));
  const bool is_quiet = options.progress.quiet;
  run_job(std::move(description), std::move(job),
          {progress_style(options.progress), is_quiet, options.views}, [&] {
            if (!is_quiet) say("{}", text);
          });
}

}  // namespace

void add_resume(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "resume",
      "Resume a stopped render from a checkpoint, which kaustik render --checkpoint writes.");
  command->footer(
      "The result has the same bits as a render without a break. Scene, integrator, seed and all "
      "settings come from the checkpoint; the scene must not have changed. Without --passes, "
      "--spp, --time and --error the original limits hold. If they are reached already, it only "
      "writes the picture.");
  auto o = std::make_shared<ResumeOptions>();
  takes_files(
      command->add_option("checkpoint", o->checkpoint, "Checkpoint, .kpt; it is kept up to date")
          ->required(),
      {"kpt"});
  takes_files(command
                  ->add_option("-o,--output", o->outputs,
                               "Image to write; may be repeated [the render's own outputs, in and "
                               "below the checkpoint's folder]")
                  ->take_all()
                  ->allow_extra_args(false),
              rendered_extensions());
  auto* passes =
      command->add_option("--passes", o->passes, "Number of passes, including finished ones")
          ->check(whole_number(1, 1 << 30));
  command->add_option("--spp", o->spp, "Samples per pixel over all passes, including finished ones")
      ->check(whole_number(1, 1 << 30))
      ->excludes(passes);
  takes(command->add_option("--time", o->time, "Time limit from now, such as 60s, 5m, 1h30m"),
        "TIME");
  takes(command->add_option("--error", o->error,
                            "Stop when the picture's relative error is at most this, such as 2%"),
        "PERCENT");
  takes_files(
      command->add_option("--scene", o->scene, "New place of the scene file, if it was moved"),
      scene_extensions());
  takes(command->add_option("--every", o->every, "Time between checkpoints [30s]"), "TIME");
  add_texture_memory(*command, o->build);
  add_threads(*command, o->threads);
  add_progress(*command, o->progress, "No progress");
  add_views(*command, o->views);
  command->callback([o] { resume(*o); });
}

}  // namespace kaustik::app
