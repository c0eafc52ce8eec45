#include "kaustik/material/burley_diffuse.h"

#include <array>

#include "kaustik/material/schlick.h"

namespace kaustik {
namespace {

// 2 ∫ ν^(k+1) dν and 2 ∫ (1 − ν)⁵ ν^(k+1) dν over cosines ν from 0 to 1.
constexpr float plain_moment_1 = 2.0f / 3;
constexpr float grazing_moment_0 = 1.0f / 21, grazing_moment_1 = 1.0f / 84,
                grazing_moment_2 = 1.0f / 252;

/// (1 + cosγ)/2 with γ the angle between both directions; the square of the cosine to the normal of
/// the facet between them.
float facet_cosine_sq(const Vec3f& wo, const Vec3f& wi) {
  return std::clamp(0.5f * (1 + dot(wo, wi)), 0.0f, 1.0f);
}

/// Hanrahan and Krueger's shape with an end at grazing angles of `end`.
float flat_shape(float end, float end_sq, float grazing_o, float grazing_i, float cosines) {
  const float both =
      1 + (grazing_o + grazing_i) * (end - 1) + grazing_o * grazing_i * (end_sq - 2 * end + 1);
  return 1.25f * (both * (1 / cosines - 0.5f) + 0.5f);
}

float flat_albedo(float cosine, float roughness) {
  constexpr int steps = 48;
  const float grazing = schlick_weight(cosine);
  float sum = 0;
  for (int i = 0; i < steps; ++i) {
    const float other = (float(i) + 0.5f) / float(steps);
    // Means over the azimuth.
    const float end = 0.5f * roughness * (1 + cosine * other);
    const float end_sq =
        0.25f * sqr(roughness) *
        (sqr(1 + cosine * other) + 0.5f * (1 - cosine * cosine) * (1 - other * other));
    sum += other * flat_shape(end, end_sq, grazing, schlick_weight(other), cosine + other);
  }
  return 2 * sum / float(steps);
}

constexpr int sheen_nodes = 129;

/// At cosines that are squares, since it bends near the horizon.
std::array<float, sheen_nodes> sheen_albedos() {
  std::array<float, sheen_nodes> nodes{};
  constexpr int steps = 64;
  for (size_t node = 0; node < nodes.size(); ++node) {
    const double cosine = sqr(double(node) / (sheen_nodes - 1));
    const double sine = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double other = (i + 0.5) / steps, phi = (j + 0.5) / steps * double(pi);
        const double facet_sq =
            0.5 * (1 + cosine * other + sine * std::sqrt(1 - other * other) * std::cos(phi));
        sum += other * std::pow(1 - std::sqrt(std::clamp(facet_sq, 0.0, 1.0)), 5);
      }
    nodes[node] = float(2 * double(pi) * sum / (steps * steps));
  }
  return nodes;
}

}  // namespace

float burley_base(const Vec3f& wo, const Vec3f& wi, float roughness, float flatness) {
  const float grazing_o = schlick_weight(wo.z), grazing_i = schlick_weight(wi.z);
  const float back = 2 * roughness * facet_cosine_sq(wo, wi);
  const float base = (1 - 0.5f * grazing_o) * (1 - 0.5f * grazing_i) +
                     back * (grazing_o + grazing_i + grazing_o * grazing_i * (back - 1));
  if (!(flatness > 0)) return base;
  const float end = 0.5f * back;
  const float flat = flat_shape(end, end * end, grazing_o, grazing_i, wo.z + wi.z);
  return base + flatness * (flat - base);
}

float burley_base_albedo(float cosine, float roughness, float flatness) {
  const float grazing = schlick_weight(cosine), sine_sq = 1 - cosine * cosine;
  const float matt = (1 - 0.5f * grazing) * (1 - 0.5f * grazing_moment_0);
  const float single = grazing_moment_0 + cosine * grazing_moment_1;
  const float twice = grazing_moment_0 + 2 * cosine * grazing_moment_1 +
                      cosine * cosine * grazing_moment_2 +
                      0.5f * sine_sq * (grazing_moment_0 - grazing_moment_2);
  const float back = roughness * (grazing * (1 + cosine * plain_moment_1) + single) +
                     grazing * (sqr(roughness) * twice - roughness * single);
  const float base = matt + back;
  return flatness > 0 ? base + flatness * (flat_albedo(cosine, roughness) - base) : base;
}

float burley_sheen(const Vec3f& wo, const Vec3f& wi) {
  return schlick_weight(std::sqrt(facet_cosine_sq(wo, wi)));
}

float burley_sheen_albedo(float cosine) {
  static const std::array<float, sheen_nodes> nodes = sheen_albedos();
  const float at = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * float(sheen_nodes - 1);
  const size_t index = std::min(size_t(at), size_t(sheen_nodes - 2));
  return std::lerp(nodes[index], nodes[index + 1], at - float(index));
}

}  // namespace kaustik
