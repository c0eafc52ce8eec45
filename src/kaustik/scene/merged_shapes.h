#pragma once
#include "kaustik/scene/description.h"

namespace kaustik {

/// The scene with the shapes of Mitsuba's `merge` in the place of it. What has none, or holds none,
/// stays the same object. Throws Error(input) where something else stands in it.
std::shared_ptr<Object> without_merges(const std::shared_ptr<Object>& scene);

}  // namespace kaustik
