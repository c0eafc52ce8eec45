#pragma once
// The entries of filter_types(), one per source file, and the filters themselves; lengths in
// pixels.

#include "kaustik/scene/pixel_filter.h"

namespace kaustik {

FilterType box_filter_type();
FilterType tent_filter_type();
FilterType gaussian_filter_type();
FilterType mitchell_filter_type();
FilterType catmull_rom_filter_type();
FilterType lanczos_filter_type();

/// The same everywhere within `radius`.
PixelFilter box_filter(float radius);
/// Falls linearly to zero at `radius`.
PixelFilter tent_filter(float radius);
/// Mitsuba's windowed Gaussian: shifted down to reach zero at `radius`.
PixelFilter gaussian_filter(float stddev, float radius);

}  // namespace kaustik
