#pragma once
// What integrators share about parameters and about the first hit of a camera path.
#include "kaustik/integrator/integrator.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// Mitsuba's max_depth: the number of path segments (1: emission, 2: direct light); −1: no limit.
Parameter max_depth_parameter();
/// Mitsuba's rr_depth.
Parameter rr_depth_parameter();
/// max_depth as a number of scattering events.
int read_maximum_events(const Arguments& arguments);

FirstHit describe_first_hit(const SurfaceVertex& vertex, float distance);

}  // namespace kaustik
