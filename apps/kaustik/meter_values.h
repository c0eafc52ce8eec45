#pragma once
#include "kaustik/render/film.h"
#include "kaustik/scene/scene.h"

namespace kaustik::app {

/// Tells what the scene's meter has measured, on standard error unless `quiet`, and as events;
/// warns where that is known too badly. The film has at least one pass.
void tell_measurements(const Scene& scene, const Film& film, bool quiet);

}  // namespace kaustik::app
