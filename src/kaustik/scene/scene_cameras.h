#pragma once
#include <memory>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Puts the cameras of every `batch` at the top of the scene, in its place. Each gets the batch's
/// sampler, and its film with as much of the width as falls to one of them, and a name if it has
/// none (sensor0, sensor1 …). Throws Error(input) for a batch without cameras. Changes the scene's
/// own list of children only.
void unfold_batches(Object& scene);

/// The cameras of a scene without batches, in their order: at its top, and in shapes there.
std::vector<std::shared_ptr<Object>> cameras_of(const Object& scene);

/// Takes all cameras but that one out of the scene. Shapes that lose one are copied.
void leave_camera(Object& scene, const Object& camera);

}  // namespace kaustik
