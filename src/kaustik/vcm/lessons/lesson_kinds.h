#pragma once
#include <memory>
#include <vector>

#include "kaustik/vcm/lessons/lesson.h"
#include "kaustik/vcm/lessons/light_path_use.h"
#include "kaustik/vcm/settings.h"

namespace kaustik {

/// What lessons are made of. All but `use` and `radii` must outlive them.
struct LessonInputs {
  const Scene& scene;
  const VcmSettings& settings;
  const LightPathEmission& plain;  ///< not guided
  const VcmPlans& first;           ///< of the first pass
  /// What the pilot's light paths have taught. Null: they taught nothing, or the lessons will be
  /// read.
  std::shared_ptr<const LightPathUse> use = nullptr;
  std::shared_ptr<const RadiusLearning> radii = nullptr;  ///< of `first`; null: not made yet
};

/// Radii of merging by the light paths of the passes before. Null unless such are to be learned.
std::unique_ptr<Lesson> make_radius_lesson(const LessonInputs& in);
/// Camera samples go where those of the passes before differed. Null unless a pilot planned
/// merging, and for a single sample per pixel, which can't be shared out.
std::unique_ptr<Lesson> make_sample_lesson(const LessonInputs& in);
/// Light paths begin, and go on from matt surfaces, as those of the passes before were of use. Null
/// unless light paths are guided.
std::unique_ptr<Lesson> make_guide_lesson(const LessonInputs& in);

/// All that there are for these plans, in the order in which they change plans.
std::vector<std::unique_ptr<Lesson>> make_lessons(const LessonInputs& in);

}  // namespace kaustik
