#pragma once
#include "kaustik/transport/volume_light.h"
#include "kaustik/vcm/camera_path/vertices.h"

namespace kaustik {

/// Light of light paths whose vertices in media lie beside the segment that a camera path is on.
class MediumMerging final : public VolumeLight {
 public:
  /// Both must outlive this.
  MediumMerging(const CameraPathInputs& inputs, const CameraVertices& vertices)
      : in_(inputs), vertices_(vertices) {}

  Spectrum radiance(const Ray& ray, float length, const Medium& medium,
                    const Wavelengths& wavelengths, const Sampler& sampler,
                    const Work& work) const override;

 private:
  /// How far from the last vertex segments merge, m.
  float merging_length() const;

  const CameraPathInputs& in_;
  const CameraVertices& vertices_;
};

}  // namespace kaustik
