#pragma once
#include "kaustik/image/image.h"

namespace kaustik {

/// A picture of all directions by longitude and latitude, twice as wide as high, for a square one
/// of equal areas as pbrt-v4 has it (Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using
/// SIMD", JGT 2008): the square's middle looks along +y, its corners along −y, +x is on the right
/// of the middle, and what is below it, −z. Of the first as PictureSphere places it. Each pixel is
/// the mean of a few points of its part of the sphere.
Image latlong_of_equal_area(const Image& square);

}  // namespace kaustik
