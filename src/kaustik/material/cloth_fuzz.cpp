#include "kaustik/material/cloth_fuzz.h"

#include <vector>

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

constexpr int fuzz_cosines = 65, fuzz_alphas = 17;
constexpr float least_fuzz_alpha = 0.07f;

/// The width of the distribution; fibres that stand all upright would have no width at all.
float fuzz_alpha_of(float roughness) {
  return std::max(least_fuzz_alpha, std::min(roughness, 1.0f));
}

/// f before it is scaled, by the cosine to the normal between both directions.
float raw_fuzz(float cos_o, float cos_i, float cos_half, float alpha) {
  const float sine = safe_sqrt(1 - cos_half * cos_half), inverse = 1 / alpha;
  const float density = (2 + inverse) * std::pow(sine, inverse) * 0.5f * inv_pi;
  return density / (4 * (cos_o + cos_i - cos_o * cos_i));
}

float raw_fuzz_albedo(float cosine, float alpha) {
  constexpr int steps = 32;
  const float sine = safe_sqrt(1 - cosine * cosine);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const float root = (float(i) + 0.5f) / float(steps), other = root * root;
    const float other_sine = safe_sqrt(1 - other * other);
    double around = 0;
    for (int j = 0; j < steps; ++j) {
      const float phi = pi * (float(j) + 0.5f) / float(steps);
      const float between = sine * other_sine * std::cos(phi) + cosine * other;
      const float half = (cosine + other) / std::sqrt(std::max(1e-12f, 2 + 2 * between));
      around += double(raw_fuzz(cosine, other, std::min(half, 1.0f), alpha));
    }
    sum += around * double(other * root);
  }
  return float(sum * 4 * double(pi) / (steps * steps));
}

/// Albedos at cosines that are squares and at widths that lie denser where they are small.
class FuzzTable {
 public:
  FuzzTable() {
    for (int j = 0; j < fuzz_alphas; ++j) {
      const float root = float(j) / float(fuzz_alphas - 1);
      const float alpha = least_fuzz_alpha + (1 - least_fuzz_alpha) * root * root;
      for (int i = 0; i < fuzz_cosines; ++i) {
        const float at = float(i) / float(fuzz_cosines - 1);
        nodes_.push_back(raw_fuzz_albedo(std::max(1e-4f, at * at), alpha));
      }
    }
  }
  float operator()(float cosine, float alpha) const {
    const float row =
        std::sqrt((alpha - least_fuzz_alpha) / (1 - least_fuzz_alpha)) * float(fuzz_alphas - 1);
    const int j = to_integer(row, 0, fuzz_alphas - 2);
    return std::lerp(along(j, cosine), along(j + 1, cosine), std::min(row - float(j), 1.0f));
  }

 private:
  float along(int row, float cosine) const {
    const float at = safe_sqrt(cosine) * float(fuzz_cosines - 1);
    const int i = to_integer(at, 0, fuzz_cosines - 2);
    const size_t node = size_t(row * fuzz_cosines + i);
    return std::lerp(nodes_[node], nodes_[node + 1], std::min(at - float(i), 1.0f));
  }

  std::vector<float> nodes_;
};

const FuzzTable& fuzz_table() {
  static const FuzzTable table;
  return table;
}

/// Along the surface most is reflected.
float fuzz_scale(float alpha) { return 1 / std::max(1.0f, fuzz_table()(0, alpha)); }

}  // namespace

float cloth_fuzz(const Vec3f& wo, const Vec3f& wi, float roughness) {
  const float alpha = fuzz_alpha_of(roughness), between = dot(wo, wi);
  const float half = (wo.z + wi.z) / std::sqrt(std::max(1e-12f, 2 + 2 * between));
  return fuzz_scale(alpha) * raw_fuzz(wo.z, wi.z, std::min(half, 1.0f), alpha);
}

float cloth_fuzz_albedo(float cosine, float roughness) {
  const float alpha = fuzz_alpha_of(roughness);
  return fuzz_scale(alpha) * fuzz_table()(cosine, alpha);
}

}  // namespace kaustik
