#pragma once
#include "kaustik/base/sampler.h"
#include "kaustik/geometry/ray.h"
#include "kaustik/medium/medium.h"
#include "kaustik/transport/work.h"

namespace kaustik {

/// What is known of the light that media scatter.
class VolumeLight {
 public:
  virtual ~VolumeLight() = default;
  /// Radiance that `medium` scatters into the segment of `length` (may be infinite) along `ray`
  /// (unit direction) toward its origin, what is lost on the way there taken off, W/(sr·m²).
  /// Numbers are forked off `sampler`, which stays as it is. Thread-safe.
  virtual Spectrum radiance(const Ray& ray, float length, const Medium& medium,
                            const Wavelengths& wavelengths, const Sampler& sampler,
                            const Work& work) const = 0;
};

}  // namespace kaustik
