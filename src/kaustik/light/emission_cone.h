#pragma once
#include "kaustik/light/light_bounds.h"

namespace kaustik {

/// Where lights shine: within `spread` of the axis brightest, beyond that for another `falloff`.
/// Radians.
struct EmissionCone {
  Vec3f axis{0, 0, 1};
  double spread = 0;
  double falloff = 0;
};
EmissionCone emission_cone(const LightBounds& bounds);
/// A cone that holds both (Conty Estevez and Kulla 2018, algorithm 1).
EmissionCone united(const EmissionCone& a, const EmissionCone& b);
/// Solid angle that the cone shines into, the part beyond the spread weighted by its cosine, sr
/// (Conty Estevez and Kulla 2018, eq. 1). Power over this is the intensity.
double orientation_measure(const EmissionCone& cone);

}  // namespace kaustik
