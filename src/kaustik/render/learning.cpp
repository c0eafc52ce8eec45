#include "kaustik/render/learning.h"

#include <fmt/format.h>

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/render/pass_wavelengths.h"

namespace kaustik {
namespace {

/// Of passes that only teach: a render of the same seed must not have their paths, since what is
/// chosen by the look of some paths weighs those very paths wrongly.
uint64_t teaching_seed(uint64_t seed) { return hash_mix(seed, 0x6c6561726e); }

}  // namespace

Learned learn(const PreparedScene& prepared, const LearningSettings& settings, std::stop_token stop,
              const ProgressFunction& progress) {
  const Integrator& integrator = *prepared.integrator;
  Learned learned;
  StoredLessons& stored = learned.stored;
  stored.integrator = prepared.view.integrator;
  stored.digest = prepared.digest.value();
  stored.seed = settings.seed;
  stored.samples_per_pass =
      settings.samples_per_pass.value_or(integrator.traits().default_samples_per_pass);
  const uint64_t seed = teaching_seed(settings.seed);
  const Pass after{seed, settings.passes, stored.samples_per_pass,
                   wavelengths_of_pass(prepared.scene->film(), integrator.traits(), seed,
                                       settings.passes, stored.samples_per_pass)};
  with_threads(settings.threads, [&] { learned.report = integrator.learn(after, stop, progress); });
  stored.lessons = integrator.lessons();
  learned.cancelled = stop.stop_requested() && stored.lessons.passes < settings.passes;
  if (learned.cancelled && stored.lessons.passes == 0)
    throw Error(ErrorKind::system, "cancelled before anything was learned");
  if (stored.lessons.empty() || stored.lessons.passes == 0)
    throw Error(
        ErrorKind::input,
        fmt::format("integrator {} learns nothing of this scene", stored.integrator),
        "render it without lessons, or learn with another integrator: auto, vcm, ppm, bdpt");
  return learned;
}

void check_same_scene(const PreparedScene& prepared, const StoredLessons& stored,
                      const std::string& path) {
  const std::string remedy =
      "learn anew, with the same scene, definitions, settings and integrator";
  if (prepared.digest->scene != stored.digest.scene)
    throw Error(
        ErrorKind::input,
        fmt::format("its lessons are of another scene than this, or of '{}' as it was before "
                    "a change",
                    stored.scene),
        remedy, place_in(path));
  if (prepared.digest->integrator != stored.digest.integrator)
    throw Error(
        ErrorKind::input,
        fmt::format("its lessons are of integrator {}, this is {}{}", stored.integrator,
                    prepared.view.integrator,
                    stored.integrator == prepared.view.integrator ? " with other parameters" : ""),
        remedy, place_in(path));
}

void hand_over(const Lessons& lessons, LessonUse use, const std::string& path,
               const PreparedScene& prepared) {
  try {
    prepared.integrator->go_on_with(lessons, use);
  } catch (const Error& error) {
    throw Error(ErrorKind::input, error.problems().front().message,
                "get the file again, or make it anew", place_in(path));
  }
}

}  // namespace kaustik
