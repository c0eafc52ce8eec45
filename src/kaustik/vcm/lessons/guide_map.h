#pragma once
#include <memory>

#include "kaustik/photon/emission/aim_light.h"
#include "kaustik/photon/emission/facing_origins.h"
#include "kaustik/vcm/lessons/guide_square.h"

namespace kaustik {

/// What of a light's rays is learned, laid out on the unit square with the same area everywhere: of
/// lights with a place the direction, of lights with a single direction the place on the plane
/// across it. Everything else about a ray is drawn as ever, with a density that is known.
class GuideMap {
 public:
  /// `shape`: of area lights, else null. Both must outlive this.
  GuideMap(const Light& light, const Shape* shape, const Bounds3f& scene_bounds);

  /// Where a ray lies on the square; a density there times `scale` is the joint one of the ray. Of
  /// environment lights and beams, of which nothing is learned, `scale` is zero.
  struct Place {
    Vec2f u{0, 0};
    float scale = 0;
  };
  Place place_of(const SurfacePoint& origin, const Vec3f& direction) const;
  /// A ray at `u` of the square, whose density there is `pdf`.
  EmittedRay ray_at(const Vec2f& u, float pdf, const Vec2f& u_rest,
                    const Wavelengths& wavelengths) const;

 private:
  enum class Kind { none, direction, plane };
  EmittedRay ray_from_plane(const Vec2f& u, const Wavelengths& wavelengths) const;

  const Light* light_;
  Kind kind_ = Kind::none;
  FacingOrigins origins_;
  Frame frame_;  ///< about the axis of the light
  // Of the plane, in the frame:
  Vec3f middle_{0, 0, 0};
  float radius_ = 0;
};

/// Emission of one light as it was learned.
class GuidedLight final : public LightEmission {
 public:
  GuidedLight(std::shared_ptr<const GuideMap> map, GuideSquare square)
      : map_(std::move(map)), square_(std::move(square)) {}

  EmittedRay sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                    const Wavelengths& wavelengths) const override;
  float pdf(const SurfacePoint& origin, const Vec3f& direction) const override {
    return pdf(map_->place_of(origin, direction));
  }
  float pdf(const GuideMap::Place& place) const {
    return place.scale > 0 ? place.scale * square_.pdf(place.u) : 0.0f;
  }

  const GuideSquare& square() const { return square_; }

 private:
  std::shared_ptr<const GuideMap> map_;
  GuideSquare square_;
};

}  // namespace kaustik
