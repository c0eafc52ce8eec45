#pragma once
#include <algorithm>

#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// The largest lane of `albedo(wo)`, a sum of directional albedos, from the normal to grazing; wo
/// lies in the plane of x and z. Of lobes that are made apart the sum may be over 1: by its inverse
/// they are scaled down.
template <typename Albedo>
float most_reflected(const Albedo& albedo) {
  float most = 0;
  for (const float cosine : {1.0f, 0.6f, 0.3f, 0.15f, 0.08f, 0.04f, 0.02f, 0.01f})
    most = std::max(most, albedo(Vec3f(safe_sqrt(1 - cosine * cosine), 0, cosine)).max_lane());
  return most;
}

}  // namespace kaustik
