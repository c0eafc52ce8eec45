#pragma once
// Parameters that integrators share.
#include "kaustik/base/parameters.h"
#include "kaustik/transport/component.h"

namespace kaustik {

/// The row `components`, which every integrator has, and its reading; throws Error for an unknown
/// name.
Parameter components_parameter();
ComponentSet read_components(const Arguments& arguments);
/// Mitsuba's max_depth: the number of path segments (1: emission, 2: direct light); −1: no limit.
Parameter max_depth_parameter();
/// Mitsuba's rr_depth.
Parameter rr_depth_parameter();
/// Mitsuba's hide_emitters, which build_scene() reads: the camera sees no light itself.
Parameter hide_emitters_parameter();
/// max_depth as a number of scattering events.
int read_maximum_events(const Arguments& arguments);

}  // namespace kaustik
