#pragma once
#include "kaustik/photon/emission/aim_light.h"
#include "kaustik/photon/emission/direction_cells.h"
#include "kaustik/photon/emission/facing_origins.h"

namespace kaustik {

/// Boxes that photons are wanted in, and how finely a light looks at them.
struct ProjectionInputs {
  const std::vector<Bounds3f>& boxes;  ///< everything that counts lies inside one of them
  Bounds3f scene_bounds;
  int resolution = 64;  ///< cells along each side of a face
  int probes = 8;       ///< origins that estimate what the light emits into a cell
};

/// Jensen's projection map (1996) of a light with a place: cells of directions that know whether
/// any box may be seen through them, from whichever point of the light, drawn in proportion to what
/// the light emits into them. The direction is drawn first, then an origin from which it leaves. A
/// cell has no chance only where bounds prove that the light sends nothing through it to a box.
class ProjectionMap final : public LightEmission {
 public:
  /// `shape`: of area lights, else null. The light and the shape must outlive this.
  ProjectionMap(const Light& light, const Shape* shape, const ProjectionInputs& inputs);

  EmittedRay sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                    const Wavelengths& wavelengths) const override;
  float pdf(const SurfacePoint& origin, const Vec3f& direction) const override;

 private:
  const Light* light_;
  bool on_surface_;
  FacingOrigins origins_;
  DirectionCells cells_;
  bool dark_ = false;
  bool own_ = false;  ///< the light's own distribution serves as well
};

/// The same for a light of one direction: the cells are places on the plane across it, and those
/// that a box may lie behind are drawn alike.
class ProjectionPlane final : public LightEmission {
 public:
  /// The light must outlive this.
  ProjectionPlane(const Light& light, const ProjectionInputs& inputs);

  EmittedRay sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                    const Wavelengths& wavelengths) const override;
  float pdf(const SurfacePoint& origin, const Vec3f& direction) const override;

 private:
  const Light* light_;
  Vec3f direction_;
  Frame frame_;
  float start_ = 0;  ///< along the direction: all of the scene lies ahead
  Vec2f corner_{0, 0}, step_{0, 0};
  int resolution_;
  std::vector<bool> occupied_;
  std::vector<uint32_t> list_;  ///< of the occupied cells
};

}  // namespace kaustik
