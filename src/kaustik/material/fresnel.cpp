#include "kaustik/material/fresnel.h"

#include <algorithm>
#include <cmath>

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

}  // namespace kaustik
