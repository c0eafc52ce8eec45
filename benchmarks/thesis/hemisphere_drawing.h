#pragma once
#include <string>
#include <vector>

#include "kaustik/irradiance/hemisphere.h"

namespace kaustik::thesis {

/// The sampling grid seen from above, cells as bright as their shares, with the photons' directions
/// (local frame, z up) as dots. As SVG. The radius is sin θ: every cell has the same area.
std::string draw_hemisphere(const HemisphereGrid& grid, const std::vector<float>& cell_importance,
                            const std::vector<Vec3f>& directions);

}  // namespace kaustik::thesis
