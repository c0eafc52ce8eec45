#include "render_job.h"

#include <fmt/format.h>

#include <exception>
#include <optional>

#include "checkpoint_keeper.h"
#include "console.h"
#include "exit_codes.h"
#include "failures.h"
#include "kaustik/base/memory.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/scene/mesh_memory.h"
#include "picture_output.h"
#include "scene_warnings.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

/// Meshes that take less are not worth a word.
constexpr uint64_t much_memory = 500'000'000;

/// In how many seconds photonmap is ahead on most scenes that ship (docs/comparisons.md, the first
/// seconds).
constexpr double first_seconds = 5;

/// auto knows no irradiance cache: for who has no more time there is better.
void tell_of_first_seconds(const std::string& integrator, std::optional<double> limit) {
  if (integrator != "auto" || !limit || *limit > first_seconds) return;
  note(
      fmt::format("auto: in {} s or less photonmap is most often less noisy (--integrator "
                  "photonmap), with a bias that stays",
                  first_seconds));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

PictureFrame frame_of(const FilmSettings& film) {
  return {film.size.x, film.size.y, film.crop_offset.x, film.crop_offset.y};
}

}  // namespace

void tell_of_memory(const Description& description) {
  const uint64_t bytes = expected_mesh_memory(description);
  if (bytes < much_memory) return;
  const auto gigabytes = [](auto count) { return fmt::format("{:.1f} GB", double(count) / 1e9); };
  note(fmt::format("reading large meshes: they will take up to {} of memory", gigabytes(bytes)));
  if (bytes > uint64_t(physical_memory_bytes()))
    warn(fmt::format("this machine has {}: the program may be stopped for lack of memory",
                     gigabytes(physical_memory_bytes())));
}

Description read_scene(const std::string& path, const LoadOptions& options) {
  if (!is_standard_stream(path)) return load_scene(path, options);
  return parse_scene(read_standard_input(), "standard input", "", options);
}

void use_integrator(Description& description, const std::string& type) {
  const std::string left_out = override_integrator(description, type);
  if (!left_out.empty()) note(left_out);
}

Description load_description(const RenderRecipe& recipe) {
  LoadOptions load;
  load.definitions = recipe.definitions;
  Description description = read_scene(recipe.scene, load);
  if (!recipe.integrator.empty()) use_integrator(description, recipe.integrator);
  return description;
}

RenderJob make_job(Description description, const RenderRecipe& recipe, bool with_digest,
                   const BuildOptions& build) {
  for (const Setting& setting : recipe.settings) override_property(description, setting);
  tell_of_memory(description);
  RenderJob job;
  std::exception_ptr unreadable;
  std::optional<GuardedDigest> digest;
  if (with_digest) {
    try {
      digest.emplace(description, description_types());
    } catch (const Error&) {
      unreadable = std::current_exception();
    }
  }
  // Tells of a file that cannot be read where it is named.
  job.scene = build_scene(description, build);
  if (unreadable) std::rethrow_exception(unreadable);
  std::vector<std::string> warnings = scene_warnings(*job.scene);
  job.integrator = make_integrator(description, *job.scene, warnings);
  if (digest) {
    digest->check(description);
    job.digest = digest->digest();
  }
  for (const std::string& warning : warnings) warn(warning);
  const std::string type = integrator_type(description, *job.scene);
  for (const std::string& dark :
       {darkness_warning(*job.scene), hidden_lamps_warning(*job.scene, type)})
    if (!dark.empty()) warn(dark);
  job.view = {type, double(job.scene->camera().traits().horizontal_fov),
              double(job.scene->camera().traits().vertical_fov), job.scene->film().quantity,
              frame_of(job.scene->film())};
  return job;
}

void run_job(const RenderJob& job, RenderRecord record, SessionSettings settings,
             std::optional<Film> begun, const JobOptions& options) {
  // Large films take a while to be made.
  const InterruptGuard interrupt;
  settings.keeps_passes = !options.checkpoint.empty();
  // What it took to read the scene is of the time that there is.
  constexpr double least_s = 1e-3;
  if (settings.seconds)
    settings.seconds = std::max(least_s, *settings.seconds - seconds_since(options.start));
  Session session = begun ? Session(*job.scene, *job.integrator, settings, *std::move(begun))
                          : Session(*job.scene, *job.integrator, settings);
  const bool keeps = !options.checkpoint.empty();
  record.program = KAUSTIK_VERSION;
  record.recipe.samples_per_pass = session.samples_per_pass();
  if (keeps) record.recipe.digest = job.digest.value();
  record.plan.passes = session.planned_passes();
  record.view = job.view;

  CheckpointKeeper keeper(options.checkpoint, options.every_s, record);
  ProgressLine line(options.quiet);
  const SessionReport report = session.run(
      interrupt.token(), [&](const Progress& p) { line.show(p); },
      [&] { keeper.pass_done(session.film()); });
  line.finish();
  if (!options.quiet && report.passes > 0) print_errors(session.film());
  for (const std::string& decision : report.decisions)
    if (!options.quiet) note(decision);
  if (!options.quiet) tell_of_first_seconds(job.view.integrator, settings.seconds);
  for (const std::string& warning : report.warnings) warn(warning);
  record.seconds += report.seconds;
  if (report.passes == 0) {
    warn("ended before every pixel had a sample: nothing is written, what was there before stays");
    throw EndedEarly{};
  }
  if (report.cancelled) warn("cancelled: writing what is finished");
  // A failure must not cost what can still be written.
  Failures failures;
  if (keeps && report.incomplete_pass)
    warn("no pass was finished: there is no checkpoint");
  else if (keeps)
    failures.attempt(options.checkpoint, [&] { keeper.write_last(session.film()); });
  write_pictures(session.film(), record,
                 {settings.threads, options.quiet, report.incomplete_pass, report.part}, failures,
                 [&] { return session.image(); });
  failures.throw_if_any();
  if (report.cancelled) throw EndedEarly{};
}

}  // namespace kaustik::app
