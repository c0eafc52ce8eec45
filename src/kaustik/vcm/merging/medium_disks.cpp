#include "kaustik/vcm/merging/medium_disks.h"

#include <algorithm>

#include "kaustik/transport/scatterer.h"

namespace kaustik {
MediumDisks::MediumDisks(const Scene& scene, float widths, float given, float mean_length)
    : camera_(scene.camera().traits().position),
      at_lens_(widths * 2 * scene.camera().traits().pixel_width),
      per_distance_(widths * 2 * scene.camera().traits().pixel_spread),
      given_(given),
      mean_length_(mean_length) {}

MediumDisks MediumDisks::shrunk(float shrinkage) const {
  MediumDisks result = *this;
  result.at_lens_ *= std::sqrt(shrinkage);
  result.per_distance_ *= std::sqrt(shrinkage);
  result.given_ *= std::sqrt(shrinkage);
  result.mean_free_paths_ *= std::sqrt(shrinkage);
  return result;
}

float MediumDisks::radius(const Vec3f& position, const Medium& medium) const {
  if (given_ > 0) return given_;
  return std::min(at_lens_ + per_distance_ * length(position - camera_),
                  mean_free_paths_ / medium.mean_extinction(position));
}

float MediumDisks::merge_volume(const Vec3f& position, const Medium& medium) const {
  const float collision_chance = -std::expm1(-medium.typical_extinction() * mean_length_);
  return pi * sqr(radius(position, medium)) / (medium.mean_extinction(position) * collision_chance);
}

void MediumDisks::write(ByteWriter& writer) const {
  for (const float value : {at_lens_, per_distance_, given_, mean_free_paths_, mean_length_})
    writer.put(value);
}

MediumDisks MediumDisks::read(ByteReader& reader, const Scene& scene) {
  MediumDisks result;
  result.camera_ = scene.camera().traits().position;
  for (float* value : {&result.at_lens_, &result.per_distance_, &result.given_,
                       &result.mean_free_paths_, &result.mean_length_})
    *value = reader.get<float>();
  return result;
}

}  // namespace kaustik
