#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <limits>
#include <optional>

#include "commands.h"
#include "console.h"
#include "file_roles.h"
#include "kaustik/base/version.h"
#include "kaustik/image/tone_mapping.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/render/program_version.h"
#include "numbers.h"
#include "option_values.h"
#include "picture_output.h"
#include "progress_options.h"
#include "render_job.h"
#include "scene_options.h"
#include "standard_streams.h"
#include "texture_memory.h"
#include "thesis_settings.h"

namespace kaustik::app {
namespace {

struct RenderOptions {
  RenderRecipe recipe;
  OutputPlan outputs;
  std::vector<std::string> definitions, settings;
  std::optional<std::string> time, error, checkpoint, learned;
  std::string every = "30s";
  std::optional<uint32_t> passes, spp;
  uint32_t first_pass = 0;
  LevelOptions levels;
  BuildOptions build;
  int threads = 0;
  std::optional<double> exposure;
  bool force = false;
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

void render(RenderOptions options) {
  JobSettings job;
  RenderRecipe& recipe = options.recipe;
  check_views(options.views);
  FileRoles roles;
  roles.reads_scene(recipe.scene);
  if (options.learned) {
    roles.reads(*options.learned);
    job.learned = read_lessons(*options.learned);
    job.learned_path = *options.learned;
    check_program(*options.learned, job.learned->program, KAUSTIK_VERSION);
  }
  if (options.outputs.files.empty() && is_standard_stream(recipe.scene))
    throw Error(ErrorKind::input, "a scene from standard input gives its picture no name",
                "say what to write: -o FILE");
  if (options.outputs.files.empty())
    options.outputs.files.push_back(std::filesystem::path(recipe.scene).stem().string() + ".exr");
  sort_settings(options);
  check_outputs(options.outputs, roles);
  if (options.checkpoint)
    roles.writes(*options.checkpoint, {"a checkpoint", is_checkpoint},
                 options.force ? Replacing::anything : Replacing::nothing,
                 fmt::format("go on with it: kaustik resume {}", *options.checkpoint));
  SessionSettings& settings = job.session;
  settings.seed = recipe.seed;
  settings.threads = usable_threads(options.threads);
  settings.first_pass = options.first_pass;
  settings.passes = options.passes;
  settings.samples_per_pixel = options.spp;
  if (options.time) settings.seconds = parse_duration(*options.time, "--time");
  if (options.error) settings.error = parse_error_bound(*options.error);
  // Who goes on from a checkpoint may ask for other pictures.
  settings.layers = options.checkpoint.has_value() || needs_layers(options.outputs);
  job.checkpoint = options.checkpoint.value_or("");
  job.every_s = parse_duration(options.every, "--every");
  job.build = options.build;

  recipe.folder = std::filesystem::current_path().string();
  recipe.definitions = parse_definitions(options.definitions);
  begin_events(options.progress, roles, "render", recipe.scene);
  Description description = load_description(recipe);
  roles.reads(description);
  roles.check();
  begin_event_file(options.progress, roles, "render", recipe.scene);
  // What the thesis sets is a photon map's.
  if (!integrator_of(description, recipe) && sets_thesis_photon_map(options.levels))
    recipe.integrator = "photonmap";
  recipe.settings =
      collected_settings(integrator_of(description, recipe), options.levels, options.settings);
  job.integrator_origin = integrator_origin;
  RenderRecord& record = job.record;
  record.program = KAUSTIK_VERSION;
  record.recipe = recipe;
  record.plan = {options.first_pass, 0, settings.seconds, settings.error};
  record.outputs = options.outputs;
  run_job(std::move(description), std::move(job),
          {progress_style(options.progress), options.progress.quiet, options.views});
}

}  // namespace

double parse_duration(const std::string& text, const std::string& option) {
  // Longer ones would leave the range of clocks.
  constexpr double longest_s = 1e9;
  const auto fail = [&] {
    throw Error(ErrorKind::input, fmt::format("cannot read the time '{}'", text),
                "write a positive number of seconds (60s), minutes (5m), hours (1h), or 1h30m, up "
                "to 30 years",
                place_in("command line: " + option));
  };
  double seconds = 0, last_unit = std::numeric_limits<double>::infinity();
  const char *at = text.data(), *const last = text.data() + text.size();
  do {
    double value = 0;
    const auto [end, code] = std::from_chars(at, last, value, std::chars_format::fixed);
    const char* const next = std::find_if(end, last, [](char c) { return !std::isalpha(c); });
    const std::string name(end, next);
    const double unit = name == "s" || (name.empty() && at == text.data() && end == last) ? 1
                        : name == "m" || name == "min"                                    ? 60
                        : name == "h"                                                     ? 3600
                                                                                          : 0;
    if (code != std::errc{} || unit == 0 || !(unit < last_unit) || !(value >= 0)) fail();
    seconds += value * unit;
    last_unit = unit;
    at = next;
  } while (at != last);
  if (!(seconds > 0) || !(seconds <= longest_s)) fail();
  return seconds;
}

double parse_error_bound(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  if (code != std::errc{} || (unit != "%" && unit != " %") || !(value > 0) || !std::isfinite(value))
    throw Error(ErrorKind::input, fmt::format("cannot read the error '{}'", text),
                "write a positive number of percent: 2%", place_in("command line: --error"));
  return value / 100;
}

std::vector<std::pair<std::string, std::string>> parse_definitions(
    const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> definitions;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorKind::input, fmt::format("cannot read the definition '{}'", text),
                  "write -D name=value", place_in("command line: -D"));
    definitions.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return definitions;
}

void add_render(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Render a scene to image files.");
  command->footer(
      "Ctrl-C, SIGTERM and SIGHUP end the render: it writes the finished passes and exits with 75. "
      "A second signal ends the program at once. In the first pass it writes a picture of fewer "
      "samples, or nothing if a pixel has no sample yet. SIGUSR1 writes the picture as it is, and "
      "the render goes on.\n"
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
  takes(command->add_option("--error", options->error,
                            "Stop when the picture's relative error is at most this, such as 2% "
                            "(checked after 16, 32, 64, … passes)"),
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
  command->add_flag("--force", options->force, "Replace an existing checkpoint")->needs(checkpoint);
  takes(command
            ->add_option("--every", options->every,
                         "Time between checkpoints, such as 30s, 5m, 1h [30s]")
            ->needs(checkpoint),
        "TIME");
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
  add_progress(*command, options->progress, "No progress");
  add_views(*command, options->views);
  command->callback([options] { render(*options); });
}

}  // namespace kaustik::app
