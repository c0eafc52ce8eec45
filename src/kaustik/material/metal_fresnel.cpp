#include "kaustik/material/metal_fresnel.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/vec.h"

namespace kaustik {

ComplexIor ior_of_metal(const Spectrum& reflectance, const Spectrum& edge) {
  ComplexIor ior;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const float r = std::clamp(reflectance[lane], 1e-6f, 0.999f), root = std::sqrt(r);
    const float least = (1 - r) / (1 + r), largest = (1 + root) / (1 - root);
    const float n = std::lerp(largest, least, std::clamp(edge[lane], 0.0f, 1.0f));
    ior.eta.set(lane, n);
    ior.k.set(lane, safe_sqrt((r * sqr(n + 1) - sqr(n - 1)) / (1 - r)));
  }
  return ior;
}

}  // namespace kaustik
