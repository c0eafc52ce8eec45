#pragma once
#include "kaustik/base/vec.h"

namespace kaustik {

/// A moment by the clock of a place.
struct PlaceAndTime {
  double latitude = 0;   ///< degrees, north positive
  double longitude = 0;  ///< degrees, east positive
  double timezone = 0;   ///< hours ahead of universal time
  int year = 2000, month = 1, day = 1;
  double hour = 0;  ///< with fractions
};

/// The direction to the sun where +x is south, +y west, +z the zenith (Mitsuba's axes); below the
/// horizon z is negative. Within half a minute of arc from 1999 to 2015 and little worse in decades
/// around that; without the refraction of the air (Blanco-Muriel et al., "Computing the Solar
/// Vector", Solar Energy 70, 2001).
Vec3d sun_direction_at(const PlaceAndTime& at);

/// A direction as it is told on the ground, in degrees.
struct Horizontal {
  double altitude = 0;  ///< above the horizon
  double azimuth = 0;   ///< 0 … 360: 0 is north, 90 east, 180 south
};
/// Of a unit vector on the axes of sun_direction_at().
Horizontal horizontal(const Vec3d& direction);

/// Whether there is such a day.
bool is_date(int year, int month, int day);

}  // namespace kaustik
