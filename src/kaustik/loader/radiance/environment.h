#pragma once
// Sources at infinity as the light around the scene.

#include <memory>
#include <string>
#include <vector>

#include "kaustik/loader/radiance/materials.h"

namespace kaustik::radiance {

/// Collects `source`s: skies and grounds with their patterns become a picture of all directions,
/// small ones suns.
class EnvironmentMaker {
 public:
  EnvironmentMaker(PatternReader& patterns, Deviations& deviations)
      : patterns_(patterns), deviations_(deviations) {}

  /// Throws Error(input) for arguments that are missing.
  void add(const Primitive& source, const Transform& placed, const Modifier* modifier);
  /// Describes them.
  void finish(Object& scene);

 private:
  struct Source {
    Vec3d direction;
    double cos_half_angle = -1;
    Rgb radiance;
    std::vector<std::shared_ptr<const Pattern>> patterns;
    Place place;
  };

  void add_sun(Object& scene, const Source& source, double degrees);
  /// In a direction; nothing where no source is.
  std::optional<Rgb> radiance_at(const Vec3d& direction) const;
  bool is_even() const;

  PatternReader& patterns_;
  Deviations& deviations_;
  std::vector<Source> wide_;
  std::vector<std::pair<Source, double>> suns_;  ///< with the whole angle in degrees
};

}  // namespace kaustik::radiance
