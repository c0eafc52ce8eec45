#pragma once
#include "kaustik/photon/coverage/pixel_probes.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// Radiance that the vertex of a light path, merging at a probe with a kernel of height 1 and the
/// only one of its pass, sends to the camera in the wanted components.
Spectrum sent_to_camera(const PixelProbe& probe, const LightVertexData& photon,
                        ComponentSet wanted);

}  // namespace kaustik
