#pragma once
#include "kaustik/scene/film_settings.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// The wavelengths of the picture's pass number `index`, or of a region's: red, green and blue, or
/// in spectral mode as many sets as a pixel has samples, if the integrator takes so many.
inline WavelengthSets wavelengths_of_pass(const FilmSettings& film, const IntegratorTraits& traits,
                                          uint64_t seed, uint32_t index,
                                          uint32_t samples_per_pass) {
  if (!film.is_spectral) return {};
  const size_t sets = std::min(size_t(samples_per_pass), traits.most_wavelength_sets);
  return WavelengthSets::of_pass(seed, index, sets);
}

}  // namespace kaustik
