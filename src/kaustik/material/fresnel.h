#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/spectral_value.h"

namespace kaustik {

/// What a smooth boundary between two dielectrics does to unpolarised light.
struct DielectricFresnel {
  float reflectance = 1;      ///< 1 under total internal reflection; the rest is transmitted
  float cos_transmitted = 0;  ///< ≥ 0, to the normal on the other side; 0 under total reflection
  float eta = 1;              ///< n_transmitted/n_incident seen from the incident side
};
/// `cos_incident` is signed: positive on the outer side. `interior_over_exterior` is the ratio of
/// the indices. Fresnel's equations as in Born and Wolf, Principles of Optics, 1.5.2.
DielectricFresnel fresnel_dielectric(float cos_incident, float interior_over_exterior);

/// Share of even light that such a boundary reflects to the outer side: 2 ∫ R(μ) μ dμ over cosines
/// from 0 to 1. With the inverse ratio, to the inner side.
float reflectance_of_even_light(float interior_over_exterior);

/// Complex index of refraction of a conductor over that of its surroundings, n − ik, per lane.
struct ComplexIor {
  Spectrum eta, k;
};
/// The same at every wavelength.
struct SpectralIor {
  SpectralValue eta, k;
  ComplexIor at(const Wavelengths& wavelengths) const {
    return {eta.at(wavelengths), k.at(wavelengths)};
  }
};
/// Reflectance of unpolarised light, exact; cos_incident in [0, 1]. With eta = 0 and k > 0 it is 1.
/// Born and Wolf, 14.2, in the real form of Lagarde, "Memo on Fresnel equations" (2013).
Spectrum fresnel_conductor(float cos_incident, const ComplexIor& ior);

/// n and k of a conductor from curves over wavelength. In RGB mode eta of a lane is its mean over
/// the positive part of the colour matching function of that primary under D65; k is then chosen
/// such that the normal reflectance of the lane is that of the spectral reflectance turned into RGB
/// under D65 (at most 0.999, where Rec. 709 cannot show the colour).
SpectralIor conductor_ior(const SpectralCurve& eta, const SpectralCurve& k);
/// Of a measured metal, by its name in any case. Throws std::out_of_range for an unknown one.
SpectralIor conductor_ior(std::string_view metal);
/// "none" (a perfect mirror) and the measured ones, in lower case.
std::vector<std::string> conductor_names();

/// A dielectric's index of refraction over the wavelength. In RGB mode all lanes have that at 589
/// nm, the sodium D line, by which glasses are listed.
SpectralValue dispersive_ior(const SpectralFunctionPointer& function);
/// Of the index `n_d` at the helium d line (587.6 nm), the same in RGB mode, and of the Abbe number
/// (n_d − 1)/(n_F − n_C), above 0: by Cauchy's two terms, n = a + b/λ².
SpectralValue ior_by_abbe_number(float n_d, float abbe);
/// Index of refraction of a material by its name: measured ones over the wavelength
/// (data/sellmeier.csv), others the same everywhere. In RGB mode that at 589 nm, and where Mitsuba
/// has the name its value ("bk7", "water", …). Throws std::out_of_range for an unknown one.
SpectralValue named_ior(std::string_view name);
/// The same in RGB mode.
float dielectric_ior(std::string_view name);
std::vector<std::string> dielectric_names();

}  // namespace kaustik
