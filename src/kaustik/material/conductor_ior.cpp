#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "kaustik/base/color.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/metal_data.h"

namespace kaustik {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

double normal_reflectance(double eta, double k) {
  return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

std::array<double, 3> lanes(const Rgb& c) { return {c.r, c.g, c.b}; }

}  // namespace

SpectralIor conductor_ior(const SpectralCurve& eta_curve, const SpectralCurve& k_curve) {
  const SpectralFunctionPointer eta = tabulated(eta_curve), k = tabulated(k_curve);
  SpectralCurve reflectance;
  std::array<double, 3> eta_sum{}, weight_sum{};
  for (int nm = 360; nm <= 830; ++nm) {
    const double n = eta->at(nm);
    reflectance.samples.emplace_back(nm, normal_reflectance(n, k->at(nm)));
    const auto primaries = lanes(rgb_from_xyz(cie_xyz_at(nm)));
    for (size_t lane = 0; lane < 3; ++lane) {
      const double weight = std::max(0.0, primaries[lane]) * d65_at(nm);
      eta_sum[lane] += weight * n;
      weight_sum[lane] += weight;
    }
  }
  const auto targets = lanes(rgb_from_reflectance(reflectance));
  // The unused lane is that of a perfect mirror, which is finite.
  ComplexIor ior{Spectrum(0), Spectrum(1)};
  for (size_t lane = 0; lane < 3; ++lane) {
    const double target = std::min(targets[lane], 0.999), root = std::sqrt(target);
    // Outside this range no k gives the wanted reflectance (Gulbrandsen, JCGT 2014, section 3).
    const double n = std::clamp(eta_sum[lane] / weight_sum[lane], (1 - root) / (1 + root),
                                (1 + root) / (1 - root));
    const double k_sq = (target * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - target);
    ior.eta.set(int(lane), float(n));
    ior.k.set(int(lane), float(std::sqrt(std::max(0.0, k_sq))));
  }
  return {{ior.eta, eta}, {ior.k, k}};
}

SpectralIor conductor_ior(std::string_view name) {
  if (lower(name) == "none") return {SpectralValue(0.0f), SpectralValue(1.0f)};
  for (const MeasuredMetal& metal : measured_metals()) {
    if (lower(metal.name) != lower(name)) continue;
    SpectralCurve eta, k;
    for (const MetalSample& sample : metal.samples) {
      eta.samples.emplace_back(sample.wavelength_nm, sample.n);
      k.samples.emplace_back(sample.wavelength_nm, sample.k);
    }
    return conductor_ior(eta, k);
  }
  throw std::out_of_range("unknown metal");
}

std::vector<std::string> conductor_names() {
  std::vector<std::string> names = {"none"};
  for (const MeasuredMetal& metal : measured_metals()) names.push_back(lower(metal.name));
  return names;
}

}  // namespace kaustik
