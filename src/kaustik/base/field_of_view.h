#pragma once
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// The rows fov, focal_length and fov_axis of what sees or throws a picture by straight lines …
std::vector<Parameter> field_of_view_parameters();
/// … and what they say: tangents of half the fields of view along x and y, of a picture whose width
/// is `aspect` times its height. Throws Error(input) for a focal length that is none.
Vec2f tan_half_fov(const Arguments& arguments, double aspect);

}  // namespace kaustik
