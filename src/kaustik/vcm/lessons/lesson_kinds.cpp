#include "kaustik/vcm/lessons/lesson_kinds.h"

namespace kaustik {

std::vector<std::unique_ptr<Lesson>> make_lessons(const LessonInputs& in) {
  std::vector<std::unique_ptr<Lesson>> lessons;
  for (const auto& make : {make_radius_lesson, make_sample_lesson, make_guide_lesson})
    if (auto lesson = make(in)) lessons.push_back(std::move(lesson));
  return lessons;
}

}  // namespace kaustik
