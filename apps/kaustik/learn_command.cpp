#include <fmt/format.h>

#include "commands.h"
#include "events.h"
#include "exit_codes.h"
#include "file_roles.h"
#include "kaustik/base/version.h"
#include "numbers.h"
#include "option_values.h"
#include "progress_options.h"
#include "render_job.h"
#include "scene_options.h"
#include "screen.h"
#include "texture_memory.h"
#include "thesis_settings.h"
#include "thread_choice.h"

namespace kaustik::app {
namespace {

struct LearnOptions {
  RenderRecipe recipe;
  std::string output;
  std::vector<std::string> definitions, settings;
  uint32_t passes = 16;
  std::optional<uint32_t> spp;
  BuildOptions build;
  int threads = 0;
  bool force = false;
  ProgressOptions progress;
};

SessionSettings session_settings(const LearnOptions& options) {
  SessionSettings settings;
  settings.seed = options.recipe.seed;
  settings.passes = options.passes;
  settings.threads = usable_threads(options.threads, options.progress.quiet);
  if (options.spp) settings.samples_per_pass = (*options.spp + options.passes - 1) / options.passes;
  return settings;
}

void learn_scene(LearnOptions options) {
  RenderRecipe& recipe = options.recipe;
  FileRoles roles;
  roles.reads_scene(recipe.scene);
  roles.writes(options.output, {"a file of lessons", is_lessons_file},
               options.force ? Replacing::anything : Replacing::own_kind, "");
  recipe.definitions = parse_definitions(options.definitions);
  begin_events(options.progress, roles, "learn", recipe.scene);
  Description description = load_description(recipe);
  roles.reads(description);
  roles.check();
  begin_event_file(options.progress, roles, "learn", recipe.scene);
  recipe.settings = collected_settings(integrator_of(description, recipe), {}, options.settings);
  JobSettings settings;
  settings.task = JobTask::learn;
  settings.record.program = KAUSTIK_VERSION;
  settings.record.recipe = recipe;
  settings.integrator_origin = integrator_origin;
  settings.session = session_settings(options);
  settings.build = options.build;
  Job job(std::move(description), std::move(settings), {terminal_messages(), {}, {}});
  Learned result;
  const bool is_quiet = options.progress.quiet;
  run_to_the_end(job, {progress_style(options.progress), is_quiet, {}},
                 [&](const ProgressFunction& progress) { result = job.learn(progress); });
  const StoredLessons& stored = result.stored;
  write_lessons(options.output, stored);
  events().written(options.output, JsonObject()
                                       .add("passes", stored.lessons.passes)
                                       .add("samples_per_pass", stored.samples_per_pass));
  if (!is_quiet)
    for (const std::string& decision : result.report.decisions) note(decision);
  for (const std::string& warning : result.report.warnings) warn(warning);
  if (!is_quiet)
    say("wrote {}: what {} passes of {} samples a pixel taught {}", options.output,
        stored.lessons.passes, stored.samples_per_pass, stored.integrator);
  if (!result.cancelled) return;
  warn(fmt::format("cancelled: fewer passes than the {} that were asked for", options.passes));
  throw EndedEarly{};
}

}  // namespace

void add_learn(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "learn", "Learn how to render a scene, for any number of renders, also on other machines.");
  command->footer(
      "Each render learns where the light comes from, how wide to merge, and where samples are "
      "needed. On a thousand machines that happens a thousand times. Learn once instead:\n"
      "  kaustik learn scene.xml -o scene.kln\n"
      "  kaustik render scene.xml --learned scene.kln --first-pass 64 --passes 64 --checkpoint "
      "b.kpt\n"
      "Give both the same -D, --set and --integrator.");
  auto o = std::make_shared<LearnOptions>();
  add_scene(*command, o->recipe.scene);
  takes_files(
      command->add_option("-o,--output", o->output, "File of lessons to write, .kln")->required(),
      {"kln"});
  add_definitions(*command, o->definitions);
  add_strict(*command, o->recipe.is_strict);
  add_camera(*command, o->recipe.camera);
  add_settings(*command, o->settings, "integrator.max_depth=8, film.width=400, ID.radius=2");
  takes_words(command->add_option(
                  "--integrator", o->recipe.integrator,
                  "Use this method instead of the file's; auto, vcm, ppm and bdpt can learn"),
              learning_integrators(), "METHOD");
  command->add_option("--passes", o->passes, "Number of passes to learn from, up to 256 [16]")
      ->check(whole_number(1, 256));
  command
      ->add_option(
          "--spp", o->spp,
          "Samples per pixel over all passes; renders with --learned use the same number per pass")
      ->check(whole_number(1, 1 << 30));
  command->add_flag("--force", o->force, "Replace an existing file that holds no lessons");
  command->add_option(
      "--seed", o->recipe.seed,
      "Seed of all random numbers; renders with the same seed draw different ones [0]");
  add_texture_memory(*command, o->build);
  add_threads(*command, o->threads);
  add_progress(*command, o->progress, "No progress and no report of decisions");
  command->callback([o] { learn_scene(*o); });
}

}  // namespace kaustik::app
