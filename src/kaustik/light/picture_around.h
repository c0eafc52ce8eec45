#pragma once
#include "kaustik/image/picture_reader.h"

namespace kaustik {

/// The row `projection`, which says how directions lie in the picture of a light.
Parameter projection_parameter();
/// The picture of a light in latitude and longitude, whichever way the arguments say that its own
/// file has it. `kept_bytes_per_pixel`: of the result; `gamma`: see PictureWish.
Image picture_around(const Arguments& arguments, PictureReader& pictures,
                     int64_t kept_bytes_per_pixel, double gamma);

}  // namespace kaustik
