#pragma once
#include <array>
#include <span>

namespace kaustik {

/// A transparent material whose index of refraction n was measured over the wavelength λ:
/// n² = constant + Σ strength λ²/(λ² − resonance), λ in µm (Sellmeier's equation).
struct MeasuredGlass {
  struct Term {
    double strength;       ///< 1
    double resonance_um2;  ///< µm²
  };
  const char* name;
  double constant;
  std::array<Term, 4> terms;
};
/// All that data/sellmeier.csv holds; data/README.md names the sources.
std::span<const MeasuredGlass> measured_glasses();

}  // namespace kaustik
