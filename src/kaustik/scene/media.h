#pragma once
#include <string>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// The medium at a point, from what surfaces say of their sides: straight rays into fixed
/// directions (of the half space of `point.ng`, where that is not zero), each to the first boundary
/// of media; most of them decide. Where no ray meets one: `otherwise`.
const Medium* find_medium(const Scene& scene, const SurfacePoint& point, const Medium* otherwise);

/// Whether what the camera sees contradicts what surfaces say of their media: a message, "" if all
/// is well. Follows straight rays over a grid of the picture and compares, at every boundary, the
/// medium that the ray comes through with the one that the surface has on that side; they differ
/// where the sensor's medium is wrong or a mesh has holes. (Rendering goes on with what the
/// surface says is behind it, as Mitsuba does.)
std::string contradicting_media(const Scene& scene);

}  // namespace kaustik
