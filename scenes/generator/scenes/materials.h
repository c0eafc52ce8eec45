#pragma once
#include "kit/scene_folder.h"

namespace kaustik::scenes {

/// Adds the materials that several scenes use; colours are linear Rec. 709.
class Materials {
 public:
  explicit Materials(SceneFolder& scene) : scene_(scene) {}

  void matt(const std::string& id, const Vec3d& color);
  /// Matt with a highlight: the share `gloss` of the light, Phong exponent `exponent`.
  void glossy(const std::string& id, const Vec3d& color, double gloss, double exponent);
  /// `id`_0 … `id`_(tones - 1): lacquered wood around one color.
  void wood(const std::string& id, const Vec3d& color, int tones, double gloss, double exponent);
  /// Brushed or polished metal of roughness `alpha`.
  void metal(const std::string& id, const std::string& material, double alpha);
  /// Polished marble of two colors.
  void marble(const std::string& id, const Vec3d& ground, const Vec3d& veins, double gloss,
              double exponent);
  /// Cloth that lets through and throws back `color` each.
  void lampshade(const std::string& id, const Vec3d& color);

 private:
  SceneFolder& scene_;
};

}  // namespace kaustik::scenes
