#include "kaustik/material/microfacet.h"

namespace kaustik {
namespace {

/// Inverse error function in single precision, |x| < 1 (Giles, "Approximating the erfinv function",
/// GPU Computing Gems 2, 2011).
float inverse_erf(float x) {
  float w = -std::log((1 - x) * (1 + x));
  constexpr float central[] = {2.81022636e-08f,  3.43273939e-07f, -3.5233877e-06f,
                               -4.39150654e-06f, 0.00021858087f,  -0.00125372503f,
                               -0.00417768164f,  0.246640727f,    1.50140941f};
  constexpr float tail[] = {-0.000200214257f, 0.000100950558f, 0.00134934322f,
                            -0.00367342844f,  0.00573950773f,  -0.0076224613f,
                            0.00943887047f,   1.00167406f,     2.83297682f};
  const bool is_central = w < 5;
  w = is_central ? w - 2.5f : std::sqrt(w) - 3;
  const auto& coefficients = is_central ? central : tail;
  float p = 0;
  for (const float c : coefficients) p = p * w + c;
  return p * x;
}

/// Arguments beyond which the error function cannot be inverted in single precision.
constexpr float largest_erf = 0x1.fffffcp-1f;
constexpr float inv_sqrt_pi = 0.56418958f;

/// Slope along the direction of view among the visible ones of a Beckmann surface of roughness 1:
/// density ∝ max(0, cosθ − s sinθ) exp(−s²). Its integral up to s is proportional to
/// cosθ (1 + erf s) + sinθ exp(−s²)/√π, solved for x = erf s.
float visible_beckmann_slope(float cos_theta, float sin_theta, float u) {
  const auto integral = [&](float x, float slope) {
    return cos_theta * (1 + x) + sin_theta * inv_sqrt_pi * std::exp(-slope * slope);
  };
  const float last_slope = cos_theta / std::max(sin_theta, 1e-20f);
  float low = -largest_erf, high = std::min(std::erf(last_slope), largest_erf);
  const float last = std::min(last_slope, inverse_erf(largest_erf));
  const float target = u * integral(high, last);
  float x = low + (high - low) * u;
  for (int i = 0; i < 24; ++i) {
    const float slope = inverse_erf(x);
    const float error = integral(x, slope) - target;
    const float step = error / (cos_theta - slope * sin_theta);
    // Newton's steps shrink quadratically: so near, the rest is less than rounding.
    if (std::fabs(step) < 1e-5f) return inverse_erf(std::clamp(x - step, low, high));
    (error > 0 ? high : low) = x;
    x -= step;
    if (!(x > low && x < high)) x = 0.5f * (low + high);
  }
  return inverse_erf(x);
}

}  // namespace

float MicrofacetDistribution::density(const Vec3f& m) const {
  if (m.z <= 0) return 0;
  const float stretched_sq = sqr(m.x / alpha_x_) + sqr(m.y / alpha_y_);
  const float cos_sq = m.z * m.z, area = pi * alpha_x_ * alpha_y_;
  if (kind_ == Kind::ggx) return 1 / (area * sqr(stretched_sq + cos_sq));
  return std::exp(-stretched_sq / cos_sq) / (area * cos_sq * cos_sq);
}

float MicrofacetDistribution::masking(const Vec3f& w) const {
  const float tan_sq = (sqr(alpha_x_ * w.x) + sqr(alpha_y_ * w.y)) / (w.z * w.z);
  if (kind_ == Kind::ggx) return 2 / (1 + std::sqrt(1 + tan_sq));
  if (tan_sq < 0.04f) return 1;  // a > 5, where Λ < 1e-13
  const float a = 1 / std::sqrt(tan_sq);
  const float lambda = 0.5f * (inv_sqrt_pi * std::exp(-a * a) / a - std::erfc(a));
  return 1 / (1 + lambda);
}

Vec3f MicrofacetDistribution::sample(const Vec3f& w, const Vec2f& u) const {
  return kind_ == Kind::ggx ? sample_ggx(w, u) : sample_beckmann(w, u);
}

Vec3f MicrofacetDistribution::sample_ggx(const Vec3f& w, const Vec2f& u) const {
  const Vec3f v = normalize(Vec3f(alpha_x_ * w.x, alpha_y_ * w.y, w.z));
  const float phi = 2 * pi * u.x;
  const float z = (1 - u.y) * (1 + v.z) - v.z;
  const float r = safe_sqrt((1 - z) * (1 + z));
  const Vec3f h = Vec3f(r * std::cos(phi), r * std::sin(phi), z) + v;
  return normalize(Vec3f(alpha_x_ * h.x, alpha_y_ * h.y, std::max(h.z, 1e-7f)));
}

Vec3f MicrofacetDistribution::sample_beckmann(const Vec3f& w, const Vec2f& u) const {
  const Vec3f v = normalize(Vec3f(alpha_x_ * w.x, alpha_y_ * w.y, w.z));
  const float sin_theta = std::sqrt(v.x * v.x + v.y * v.y);
  const float cos_phi = sin_theta > 0 ? v.x / sin_theta : 1;
  const float sin_phi = sin_theta > 0 ? v.y / sin_theta : 0;
  const float along = visible_beckmann_slope(v.z, sin_theta, u.x);
  const float across = inverse_erf(std::clamp(2 * u.y - 1, -largest_erf, largest_erf));
  return normalize(Vec3f(-alpha_x_ * (cos_phi * along - sin_phi * across),
                         -alpha_y_ * (sin_phi * along + cos_phi * across), 1.0f));
}

}  // namespace kaustik
