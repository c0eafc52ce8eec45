#pragma once
#include <algorithm>
#include <cmath>

#include "kaustik/base/vec.h"
#include "kaustik/material/burley_facets.h"

namespace kaustik {

// Sheets that light leaves where it enters, alike on both sides: what is said of directions on the
// outer side holds for their mirror images in the sheet.

/// The mirror image in the sheet. Where facets of one side reflect w, a sheet lets through to
/// beyond(w).
inline Vec3f beyond(const Vec3f& w) { return {w.x, w.y, -w.z}; }
/// The one of w and its mirror image that lies on the outer side.
inline Vec3f raised(const Vec3f& w) { return w.z < 0 ? beyond(w) : w; }

/// Burley's roughness of what goes through a sheet of glass whose sides have `roughness`: the more,
/// the denser it is ("Extending the Disney BRDF to a BSDF", 2015, figure 15).
inline float sheet_roughness(float roughness, float eta) {
  return std::min(1.0f, std::fabs(0.65f * eta - 0.35f) * roughness);
}

/// Whether what goes through such a sheet goes straight on, as through a pane.
inline bool is_pane(float roughness, float anisotropic, float eta) {
  return are_smoothest(sheet_roughness(roughness, eta), anisotropic);
}

}  // namespace kaustik
