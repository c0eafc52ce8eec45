#pragma once
#include "kaustik/vcm/camera_path/vertices.h"

namespace kaustik {

/// Adds light of light paths that are connected to the walk's vertex, CameraPathInputs::connections
/// of them.
void connect_to_light_paths(const CameraPathInputs& inputs, const CameraVertices& vertices,
                            CameraWalk& walk);

}  // namespace kaustik
