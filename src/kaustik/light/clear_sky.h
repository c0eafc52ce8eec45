#pragma once
#include <array>

#include "kaustik/base/vec.h"

namespace kaustik {

/// Sunlight after its way through the air, and what the air sends on, per turbidity and elevation.
struct Daylight {
  Vec3d sun_rgb;  ///< on a surface that faces the sun, linear Rec. 709, W/m² (179 lm/W)
  double sky_illuminance = 0;  ///< on the ground, lx, before light that the ground sends back
  /// Share of the light that leaves the ground upward which the air sends back.
  double sky_albedo = 0;
};

/// Light of a cloudless day. The sun: its spectrum outside of the air weakened by the air's
/// molecules, ozone and aerosols, as Preetham, Shirley and Smits ("A Practical Analytic Model for
/// Daylight", SIGGRAPH 1999, appendix A.1, after Iqbal 1983) list them; the mass of air by Kasten
/// and Young (1989). The sky: what the same transmittances leave over, by the clear sky model of
/// Bird and Hulstrom (SERI/TR-642-761, 1981). `turbidity` of at least 1, where the air holds no
/// aerosols; `sun_height`, the sine of the sun's elevation, above 0.
Daylight daylight(double turbidity, double sun_height);

/// How the light of a cloudless sky is spread over it, with its colours, by Preetham, Shirley and
/// Smits 1999, appendix A.2 (the luminance function is that of Perez, Seals and Michalsky 1993).
/// The scale is free: their zenith luminances give illuminances twice those measured. Frame: +z is
/// the zenith.
class ClearSky {
 public:
  /// `to_sun` is a unit vector above the horizon; `turbidity` 2 to 10: the functions were fitted to
  /// these.
  ClearSky(double turbidity, const Vec3d& to_sun);

  /// XYZ toward a unit direction, relative; zero below the horizon.
  Vec3d xyz(const Vec3d& direction) const;

 private:
  /// Of F(θ, γ) = (1 + A exp(B/cosθ)) (1 + C exp(Dγ) + E cos²γ).
  using Perez = std::array<double, 5>;
  static double value(const Perez& p, double cos_theta, double gamma);

  Vec3d to_sun_;
  std::array<Perez, 3> perez_;    ///< of Y, x, y
  std::array<double, 3> zenith_;  ///< Y, x, y over the function's value at the zenith
};

}  // namespace kaustik
