#pragma once
#include <span>

namespace kaustik {

struct MetalSample {
  double wavelength_nm, n, k;
};
/// Complex index of refraction n − ik of a metal, measured; wavelengths ascend and cover 360–830
/// nm.
struct MeasuredMetal {
  const char* name;
  std::span<const MetalSample> samples;
};
/// All that data/metals_nk.csv holds, some of it by two names; data/README.md names the sources.
std::span<const MeasuredMetal> measured_metals();

}  // namespace kaustik
