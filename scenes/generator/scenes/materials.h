#pragma once
#include "kit/scene_folder.h"

namespace kaustik::scenes {

// What fills a parameter for a color: one color, or a texture. Colors are linear Rec. 709.
Xml plain(const Vec3d& color);
/// Marble with veins about `distance` m apart.
Xml marble(const Vec3d& ground, const Vec3d& veins, double distance, int seed);
/// Masonry of `size` (length, height) m with joints, on the planes of the axes, its rows shifted by
/// `offset` of a stone.
Xml masonry(const Vec3d& stone, const Vec3d& joints, const Vec2d& size, double joint, double offset,
            double variation);

/// Wood for the boards of a floor made by `herringbone_floor` or `board_floor`.
struct BoardWood {
  Vec3d early, late;  ///< colors of a year ring
  double board_width;
  Vec3d edge;            ///< a point on the edge of a board
  int along_x, along_y;  ///< how many meshes of boards along x come first, how many along y then
};

/// Adds the materials that several scenes use.
class Materials {
 public:
  explicit Materials(SceneFolder& scene) : scene_(scene) {}

  void matt(const std::string& id, Xml color);
  void matt(const std::string& id, const Vec3d& color) { matt(id, plain(color)); }
  /// Matt with a highlight: the share `gloss` of the light, Phong exponent `exponent`.
  void glossy(const std::string& id, Xml color, double gloss, double exponent);
  void glossy(const std::string& id, const Vec3d& color, double gloss, double exponent) {
    glossy(id, plain(color), gloss, exponent);
  }
  /// `id`_0, `id`_1, …: one lacquered wood for each mesh of a floor's boards, some lighter than
  /// others.
  void boards(const std::string& id, const BoardWood& wood, double gloss, double exponent);
  /// Brushed or polished metal of roughness `alpha`.
  void metal(const std::string& id, const std::string& material, double alpha);
  /// Thin cloth that throws back and lets through these shares of the light.
  void cloth(const std::string& id, const Vec3d& reflectance, const Vec3d& transmittance);

 private:
  SceneFolder& scene_;
};

}  // namespace kaustik::scenes
