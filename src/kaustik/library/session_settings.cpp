#include "kaustik/library/session_settings.h"

#include <cmath>
#include <filesystem>

#include "kaustik/base/version.h"
#include "kaustik/library/boundary.h"
#include "kaustik/render/program_version.h"
#include "kaustik/render/resume.h"

namespace kaustik::v0::details {
namespace {

constexpr uint32_t most_passes = 1u << 30;
/// Longer ones would leave the range of clocks.
constexpr double longest_s = 1e9;

template <typename T>
std::optional<T> unless_zero(T value) {
  return value != T(0) ? std::optional(value) : std::nullopt;
}

void check_number(const char* name, double value, double most) {
  if (!(value >= 0 && value <= most))
    throw wrong_input(
        std::string("the setting '") + name + "' is out of its range",
        "give a number from 0 on that is not larger than " + std::to_string(int64_t(most)));
}

void check_given(const char* name, bool is_given) {
  if (is_given)
    throw wrong_input(std::string("the setting '") + name + "' is given to passes that go on",
                      "leave it out: they have that of the file");
}

bool says_how_far(const v0::SessionSettings& settings) {
  return settings.passes != 0 || settings.samples_per_pixel != 0 || settings.seconds != 0 ||
         settings.error != 0;
}

void set_limits(const v0::SessionSettings& settings, kaustik::SessionSettings& session) {
  session.passes = unless_zero(settings.passes);
  session.samples_per_pixel = unless_zero(settings.samples_per_pixel);
  session.seconds = unless_zero(settings.seconds);
  session.error = unless_zero(settings.error);
}

/// What is the same whether passes go on or not.
void set_rest(const v0::SessionSettings& settings, const SceneState& scene, JobSettings& job) {
  job.session.threads = settings.threads;
  job.session.layers = settings.layers;
  job.checkpoint = settings.checkpoint;
  job.every_s = settings.checkpoint_interval_s;
  job.keeps_passes = settings.keeps_passes;
  job.previews = settings.previews;
  job.previous = scene.built->get();
}

}  // namespace

void check_settings(const v0::SessionSettings& settings) {
  check_number("passes", settings.passes, most_passes);
  check_number("samples_per_pixel", settings.samples_per_pixel, most_passes);
  check_number("samples_per_pass", settings.samples_per_pass, most_passes);
  check_number("first_pass", settings.first_pass, most_passes);
  check_number("seconds", settings.seconds, longest_s);
  check_number("error", settings.error, 1e6);
  check_number("threads", settings.threads, 65536);
  check_number("checkpoint_interval_s", settings.checkpoint_interval_s, longest_s);
}

JobSettings job_settings(const v0::SessionSettings& settings, const SceneState& scene) {
  JobSettings job;
  set_rest(settings, scene, job);
  set_limits(settings, job.session);
  job.session.seed = settings.seed;
  job.session.first_pass = settings.first_pass;
  job.session.samples_per_pass = unless_zero(settings.samples_per_pass);
  job.integrator_origin = "SessionSettings::integrator";
  RenderRecord& record = job.record;
  record.program = KAUSTIK_VERSION;
  record.plan = {settings.first_pass, 0, job.session.seconds, job.session.error};
  RenderRecipe& recipe = record.recipe;
  recipe.scene = scene.file;
  recipe.folder = scene.file.empty() ? "" : std::filesystem::current_path().string();
  recipe.definitions = scene.load.definitions;
  recipe.is_strict = scene.load.is_strict;
  recipe.camera = settings.camera;
  recipe.integrator = settings.integrator;
  recipe.seed = settings.seed;
  return job;
}

JobSettings job_settings(const v0::SessionSettings& settings, const SceneState& scene,
                         Checkpoint checkpoint, const std::string& path) {
  check_given("integrator", !settings.integrator.empty());
  check_given("camera", !settings.camera.empty());
  check_given("seed", settings.seed != 0);
  check_given("samples_per_pass", settings.samples_per_pass != 0);
  check_given("first_pass", settings.first_pass != 0);
  check_program(path, checkpoint.record.program, KAUSTIK_VERSION);
  JobSettings job;
  job.session = settings_to_go_on(checkpoint);
  set_rest(settings, scene, job);
  if (says_how_far(settings)) set_limits(settings, job.session);
  RenderRecord& record = checkpoint.record;
  record.plan.error = job.session.error;
  if (!job.session.seconds)
    record.plan.seconds.reset();
  else if (settings.seconds > 0)
    record.plan.seconds = record.seconds + settings.seconds;
  job.record = record;
  job.begun = std::move(checkpoint);
  job.begun_path = path;
  return job;
}

}  // namespace kaustik::v0::details
