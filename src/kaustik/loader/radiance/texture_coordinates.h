#pragma once
#include <string>
#include <utility>
#include <vector>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/radiance/materials.h"

namespace kaustik::radiance {

/// Of the corners of a polygon: those of a picture, v from its upper edge downward, or such that
/// the tangent lies along the appearance's direction. None where it needs none.
std::vector<std::pair<double, double>> texture_coordinates(const Appearance& appearance,
                                                           const std::vector<Vec3d>& corners,
                                                           const Vec3d& normal,
                                                           const Primitive& polygon,
                                                           Deviations& deviations);

/// Of points on a mesh, where the surface bends: those of a picture alone.
std::vector<std::pair<double, double>> picture_coordinates(const PicturePattern& picture,
                                                           const std::vector<PatternPoint>& points,
                                                           const Primitive& surface,
                                                           Deviations& deviations);

/// Width and height of a picture of Radiance (.hdr, .pic) in pixels by its header; of others, and
/// where there is none, 1 and 1.
std::pair<double, double> picture_size(const std::string& path);

}  // namespace kaustik::radiance
