#include "render_job.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stop_token>
#include <utility>
#include <variant>

#include "events.h"
#include "exit_codes.h"
#include "failures.h"
#include "kaustik/base/photometric_units.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/measurements.h"
#include "kaustik/render/part_picture.h"
#include "kaustik/scene/scene.h"
#include "meter_table.h"
#include "meter_values.h"
#include "picture_output.h"
#include "picture_watch.h"
#include "render_team.h"
#include "scene_search.h"
#include "screen.h"
#include "signals.h"
#include "standard_streams.h"

namespace kaustik::app {
namespace {

/// What there is of a render whose time was over before every pixel had a sample.
Image first_look(const Job& job) {
  Image image = job.snapshot().value();
  const MetadataValue* shown = image.find_metadata(incomplete_key);
  if (is_meter(job.scene()))
    warn("no value was measured: the time was over before the first pass was done; give more");
  warn(fmt::format("the time was over before every pixel had a sample: the picture is {}",
                   shown ? std::get<std::string>(*shown) : "incomplete"));
  return image;
}

/// Of a part: what there is of it.
void tell_of_part(const StopPlan& plan, const Film& film) {
  const PassDivision& division = plan.division;
  for (uint32_t i = 0; i < division.parts; ++i)
    if (division.part(i) == PassRange{plan.first_pass, plan.first_pass + plan.passes})
      say("part {} of {}: passes {}", i + 1, division.parts, film.passes().text());
}

void tell_of_result(const JobResult& result, const Job& job, bool quiet) {
  const SessionReport& report = result.report;
  if (!quiet) tell_of_part(result.record.plan, job.film());
  if (report.passes > 0 && is_meter(job.scene()))
    tell_measurements(job.scene(), job.film(), quiet);
  else if (report.passes > 0 && !quiet)
    print_errors(job.film());
  for (const std::string& decision : report.decisions)
    if (!quiet) note(decision);
  for (const std::string& warning : report.warnings) warn(warning);
}

/// Parts have to be complete: time is no goal of theirs.
void check_part_is_complete(const StopPlan& plan, const Film& film) {
  if (!plan.division.is_divided()) return;
  const PassRange own{plan.first_pass, plan.first_pass + plan.passes};
  const uint32_t missing = film.passes().missing(own);
  if (missing == 0) return;
  warn(
      fmt::format("the time was over before the part was complete: {} of its {} passes are "
                  "missing\n  remedy: repeat the command with --resume-if-there, or kaustik resume",
                  missing, plan.passes));
  throw EndedEarly{};
}

/// What viewers call the picture: as its first file.
std::string viewer_name(const RenderRecord& record) {
  for (const std::string& file : record.outputs.files)
    if (!is_standard_stream(file)) return file;
  return record.recipe.scene;
}

/// Which of the goals a render has reached.
std::string end_reason(const SessionReport& report, const SessionSettings& session) {
  if (report.end == SessionEnd::error) return "error";
  if (report.end == SessionEnd::time) return "time";
  return session.samples_per_pixel && !session.passes ? "samples" : "passes";
}

/// The mean of the picture, with the interval that holds the true one with a chance of 95 %.
JsonObject mean_facts(const Job& job) {
  const Film& film = job.film();
  JsonObject facts;
  if (film.pass_count() == 0 || is_meter(job.scene())) return facts;
  const ConfidenceInterval interval =
      FilmErrors(film).known(PixelRegion{0, 0, film.width(), film.height()}).interval();
  const bool is_irradiance = job.scene().quantity() == Quantity::irradiance;
  return facts.add("mean", lumens_per_watt_white * interval.mean)
      .add("mean_half_width", lumens_per_watt_white * interval.half_width)
      .add("unit", is_irradiance ? "lx" : "cd/m²");
}

JsonObject result_facts(const JobResult& result, const Job& job) {
  const SessionReport& report = result.report;
  JsonObject facts;
  facts.add("integrator", result.record.view.integrator)
      .add("passes", report.passes)
      .add("samples_per_pixel", job.film().samples_per_pixel())
      .add("elapsed_s", report.seconds)
      .add("error", report.picture_error)
      .add("mean_error", report.mean_error)
      .append(mean_facts(job))
      .add("rays", report.rays);
  return facts;
}

/// Its part of the passes, of which the leader makes the picture.
void run_follower(Description description, JobSettings settings) {
  Job job(std::move(description), std::move(settings));
  job.prepare();
  const InterruptGuard interrupt;
  const std::stop_callback forward(interrupt.token(), [&] { job.cancel(); });
  if (job.run().report.cancelled()) throw EndedEarly{};
}

}  // namespace

LoadOptions load_options(std::vector<std::pair<std::string, std::string>> definitions,
                         bool is_strict) {
  return {.definitions = std::move(definitions),
          .is_strict = is_strict,
          .definitions_origin = "command line: -D",
          .definition_prefix = "-D "};
}

Description read_scene(const std::string& path, const LoadOptions& options) {
  if (is_standard_stream(path))
    return parse_scene(read_standard_input(), "standard input", "", options);
  check_scene_file(path);
  return load_scene(path, options);
}

Messages terminal_messages() { return {note, warn}; }

Description load_description(const RenderRecipe& recipe) {
  return read_scene(recipe.scene, load_options(recipe.definitions, recipe.is_strict));
}

std::optional<Object> integrator_of(const Description& description, const RenderRecipe& recipe) {
  if (!recipe.integrator.empty()) return Object{"integrator", recipe.integrator, "", {}, {}, {}};
  const auto own = find_integrator(description);
  return own ? std::optional(*own) : std::nullopt;
}

void run_to_the_end(Job& job, const JobDisplay& display,
                    const std::function<void(const ProgressFunction&)>& work) {
  job.prepare();
  const InterruptGuard interrupt;
  const std::stop_callback forward(interrupt.token(), [&] { job.cancel(); });
  ProgressDisplay progress(display.progress);
  const auto start = std::chrono::steady_clock::now();
  try {
    work([&](double share) {
      progress.show(
          share, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    });
    progress.finish();
  } catch (const Error& error) {
    progress.finish();
    if (!interrupt.token().stop_requested()) throw;
    say("{}: nothing is written", error.what());
    throw EndedEarly{};
  }
}

void run_job(Description description, JobSettings settings, const JobDisplay& display,
             const std::function<void()>& prepared) {
  if (is_follower()) return run_follower(std::move(description), std::move(settings));
  const std::string checkpoint = settings.checkpoint;
  const SessionSettings session = settings.session;
  const OutputPlan outputs = settings.record.outputs;
  auto viewers = make_viewers(display.views, viewer_name(settings.record),
                              make_tone_operator(outputs.tone, outputs.tone_settings));
  settings.previews = !viewers.empty();
  ProgressDisplay progress(display.progress);
  PictureWatch* watcher = nullptr;
  Job job(std::move(description), std::move(settings),
          {terminal_messages(),
           [&](const Progress& p) {
             watcher->progress(p);
             progress.show(p);
           },
           {}});
  job.prepare();
  check_tables(outputs, job.scene());
  if (prepared) prepared();
  // It looks at the job until it is gone itself.
  PictureWatch watch(job, std::move(viewers), [&] { return write_snapshot(job, outputs); });
  watcher = &watch;
  // Large films take a while to be made.
  const InterruptGuard interrupt;
  const std::stop_callback forward(interrupt.token(), [&] { job.cancel(); });
  const JobResult& result = job.run();
  watch.stop();
  watch.show_last();
  progress.finish();
  tell_of_result(result, job, display.quiet);
  const SessionReport& report = result.report;
  events().result(end_reason(report, session), result_facts(result, job));
  const bool is_first_look = report.passes == 0 && !report.cancelled();
  if (report.passes == 0 && !is_first_look) {
    warn("ended before every pixel had a sample: nothing is written, what was there before stays");
    throw EndedEarly{};
  }
  if (report.cancelled()) warn("cancelled: writing what is finished");
  // A failure must not cost what can still be written.
  Failures failures;
  if (result.checkpoint_failure)
    failures.attempt(checkpoint, [&] { std::rethrow_exception(result.checkpoint_failure); });
  write_pictures(job.film(), result.record, {job.picture_facts(), display.quiet, &job.scene()},
                 failures, report.cancelled() ? PictureState::ended_early : PictureState::finished,
                 [&] { return is_first_look ? first_look(job) : job.image(); });
  watch.finish_viewers();
  failures.throw_if_any();
  if (report.cancelled()) throw EndedEarly{};
  check_part_is_complete(result.record.plan, job.film());
}

}  // namespace kaustik::app
