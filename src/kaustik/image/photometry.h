#pragma once
#include "kaustik/base/photometric_units.h"
#include "kaustik/base/srgb.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Lumens per watt of white light.
inline constexpr float white_efficacy = float(lumens_per_watt_white);

/// Photopic part of a linear Rec. 709 colour: the Y of CIE XYZ, 1 for white (1, 1, 1).
inline float photopic(const Vec3f& rgb) {
  return 0.2126390f * rgb.x + 0.7151687f * rgb.y + 0.0721923f * rgb.z;
}
/// Luminance in cd/m² of a linear Rec. 709 radiance in W/(sr·m²).
inline float luminance(const Vec3f& rgb) { return white_efficacy * photopic(rgb); }

/// CIE XYZ (2° observer, D65, Y of white is 1) of a linear Rec. 709 colour and back.
Vec3f xyz_from_rgb(const Vec3f& rgb);
Vec3f rgb_from_xyz(const Vec3f& xyz);

}  // namespace kaustik
