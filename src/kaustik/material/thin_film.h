#pragma once
#include "kaustik/base/wavelengths.h"

namespace kaustik {

/// Share of unpolarised light that a film reflects whose two sides interfere: of a clear material
/// between two halves of another, `eta` times as dense at each lane. Airy's sum over all
/// reflections (Born and Wolf, Principles of Optics, 7.6.1), also where light only tunnels through.
/// The rest goes on. `optical_thickness_nm`: the thickness, times the index around the film.
/// In RGB mode the mean over wavelengths, as of a reflectance under D65, of a film with the same
/// index at all of them; where light only tunnels, that at a wavelength of each primary.
Spectrum film_reflectance(float cos_incident, const Spectrum& eta,
                          const Spectrum& optical_thickness_nm, const Wavelengths& wavelengths);

}  // namespace kaustik
