#include "kaustik/material/fresnel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kaustik/base/vec.h"

namespace kaustik {

DielectricFresnel fresnel_dielectric(float cos_incident, float interior_over_exterior) {
  DielectricFresnel result;
  result.eta = cos_incident >= 0 ? interior_over_exterior : 1 / interior_over_exterior;
  const float cos_i = std::fabs(cos_incident);
  const float cos_t_sq = 1 - (1 - cos_i * cos_i) / (result.eta * result.eta);
  if (cos_t_sq <= 0) return result;
  const float cos_t = std::sqrt(cos_t_sq);

  const float s = (cos_i - result.eta * cos_t) / (cos_i + result.eta * cos_t);
  const float p = (result.eta * cos_i - cos_t) / (result.eta * cos_i + cos_t);
  result.cos_transmitted = cos_t;
  result.reflectance = std::min(1.0f, 0.5f * (s * s + p * p));
  return result;
}

float reflectance_of_even_light(float interior_over_exterior) {
  // By the midpoint rule, for the bend where total reflection begins.
  constexpr int steps = 4096;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    sum += cosine * double(fresnel_dielectric(float(cosine), interior_over_exterior).reflectance);
  }
  return float(2 * sum / steps);
}

Spectrum fresnel_conductor(float cos_incident, const ComplexIor& ior) {
  const Spectrum &eta = ior.eta, &k = ior.k;
  const float cos_sq = cos_incident * cos_incident, sin_sq = 1 - cos_sq;
  const Spectrum difference = eta * eta - k * k - Spectrum(sin_sq);
  const Spectrum twice = 2 * eta * k;
  const Spectrum norm = sqrt(difference * difference + twice * twice);  // a² + b²
  // a² = (norm + difference)/2 cancels for good metals; there a = η k / b.
  const Spectrum::Register d = difference.lanes();
  const Spectrum larger = sqrt(0.5f * (norm + Spectrum(d > 0 ? d : -d)));
  const Spectrum a(d > 0 ? larger.lanes() : (eta * k / larger).lanes());
  const Spectrum s_sum = norm + Spectrum(cos_sq), s_term = 2 * cos_incident * a;
  const Spectrum s = (s_sum - s_term) / (s_sum + s_term);
  const Spectrum p_sum = cos_sq * norm + Spectrum(sin_sq * sin_sq), p_term = s_term * sin_sq;
  const Spectrum p = s * (p_sum - p_term) / (p_sum + p_term);
  return 0.5f * (s + p);
}

namespace {

struct NamedIor {
  const char* name;
  float value;
};
// Mitsuba's table (after Hecht, Optics, 4th edition), so that scenes mean the same here.
constexpr NamedIor named_iors[] = {
    {"vacuum", 1.0f},      {"helium", 1.000036f},        {"hydrogen", 1.000132f},
    {"air", 1.000277f},    {"carbon dioxide", 1.00045f}, {"water", 1.3330f},
    {"acetone", 1.36f},    {"ethanol", 1.361f},          {"carbon tetrachloride", 1.461f},
    {"glycerol", 1.4729f}, {"benzene", 1.501f},          {"silicone oil", 1.52045f},
    {"bromine", 1.661f},   {"water ice", 1.31f},         {"fused quartz", 1.458f},
    {"pyrex", 1.470f},     {"acrylic glass", 1.49f},     {"polypropylene", 1.49f},
    {"bk7", 1.5046f},      {"sodium chloride", 1.544f},  {"amber", 1.55f},
    {"pet", 1.5750f},      {"diamond", 2.419f}};

}  // namespace

SpectralValue dispersive_ior(const SpectralFunctionPointer& function) {
  constexpr double sodium_d_nm = 589.3;
  return {Spectrum(float(function->at(sodium_d_nm))), function};
}

float dielectric_ior(std::string_view name) {
  for (const NamedIor& ior : named_iors)
    if (name == ior.name) return ior.value;
  throw std::out_of_range("unknown dielectric");
}

std::vector<std::string> dielectric_names() {
  std::vector<std::string> names;
  for (const NamedIor& ior : named_iors) names.emplace_back(ior.name);
  return names;
}

}  // namespace kaustik
