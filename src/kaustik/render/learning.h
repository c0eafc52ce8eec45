#pragma once
#include <optional>
#include <stop_token>

#include "kaustik/render/lessons_file.h"
#include "kaustik/render/prepared_scene.h"

namespace kaustik {

/// The passes that teach.
struct LearningSettings {
  /// Renders of the same seed have other random numbers: what is learned must say nothing of their
  /// noise.
  uint64_t seed = 0;
  uint32_t passes = 16;
  std::optional<uint32_t> samples_per_pass;  ///< absent: the integrator's default
  int threads = 0;                           ///< 0: all
};

/// Lessons for a file, and what they cost.
struct Learned {
  StoredLessons stored;  ///< `program` and `scene` are left to the caller
  PassReport report;
  bool cancelled = false;  ///< a stop request came before all passes had taught
};

/// What the passes teach the scene's integrator, without a picture; once `stop` is requested, what
/// those before have taught. The scene must have its digest. Throws Error(input) if the integrator
/// learns nothing, Error(system) if it was stopped before it had learned anything.
Learned learn(const PreparedScene& prepared, const LearningSettings& settings,
              std::stop_token stop = {}, const ProgressFunction& progress = {});

/// Throws Error(input), at `path`, if the lessons are not of the scene and integrator that were
/// prepared with their digest.
void check_same_scene(const PreparedScene& prepared, const StoredLessons& stored,
                      const std::string& path);

/// Lets the integrator go on with lessons from the file `path`. Throws Error(input), at `path`, if
/// they are damaged.
void hand_over(const Lessons& lessons, LessonUse use, const std::string& path,
               const PreparedScene& prepared);

}  // namespace kaustik
