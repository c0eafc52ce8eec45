#pragma once
#include "kaustik/base/parameters.h"
#include "kaustik/image/picture_reader.h"

namespace kaustik {

/// The picture of a texture `bitmap` with these arguments, its colours linear as the texture has
/// them. Throws as PictureReader::read().
Image bitmap_picture(const Arguments& arguments, PictureReader& pictures,
                     int64_t kept_bytes_per_pixel = 0);

}  // namespace kaustik
