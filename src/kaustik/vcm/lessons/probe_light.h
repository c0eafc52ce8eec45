#pragma once
#include "kaustik/base/lane_sum.h"
#include "kaustik/photon/coverage/pixel_probes.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// What vertices of light paths that merge at a probe send to the camera, in the wanted components.
class ProbeLight {
 public:
  /// `wavelengths`: of the vertices' flux.
  ProbeLight(const PixelProbe& probe, ComponentSet wanted, const Wavelengths& wavelengths);

  /// Radiance of a vertex that merges with a kernel of height 1 and is the only one of its pass:
  /// lane_sum().
  float sent(const LightVertexData& photon) const {
    const Spectrum value =
        is_matt_ ? matt_[photon.specular ? 1 : 0] : value_of(photon.direction.unpack(), photon);
    return (value * photon.flux.spectrum()).sum() * lane_sum_scale_;
  }

 private:
  bool is_wanted(Lobes lobe, bool specular) const;
  /// Of the bsdf.
  Spectrum value_of(const Vec3f& direction, const LightVertexData& photon) const;

  SurfaceVertex vertex_;  ///< of the probe, in those wavelengths
  CameraPathClass path_;
  ComponentSet wanted_;
  float lane_sum_scale_;
  bool is_matt_;      ///< the bsdf has one value for all directions
  Spectrum matt_[2];  ///< that, of light by diffuse events and by specular ones alone
};

}  // namespace kaustik
