#pragma once
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// How a place takes up paths: turns their density per solid angle at distance 1, in vacuum, into
/// that of the place.
struct Facing {
  Vec3f normal{0, 0, 0};  ///< geometric, of a surface: density per area, m⁻²
  float extinction = 0;   ///< mean over the lanes, of a medium: density per volume, m⁻³

  /// For paths that arrive along `direction` or its opposite (unit). Zero at a bare point.
  float factor(const Vec3f& direction) const {
    return extinction > 0 ? extinction : abs_dot(direction, normal);
  }
};

/// Where a path is scattered: on a surface, or at a point of a medium, which scatters as a diffuse
/// lobe does that is the phase function and asks for no cosine. Directions are unit, in world
/// space, and point away from it.
class Scatterer {
 public:
  Scatterer() = default;
  /// `vertex` must outlive this.
  Scatterer(const SurfaceVertex& vertex)  // NOLINT: a vertex is one
      : surface_(&vertex) {}
  /// `medium` scatters, and must outlive this.
  Scatterer(const Vec3f& position, const Vec3f& wo, const Medium& medium)
      : medium_(&medium), wo_(wo) {
    in_medium_.position = position;
  }

  bool is_in_medium() const { return medium_ != nullptr; }
  /// Null: in a medium.
  const SurfaceVertex* surface() const { return surface_; }
  const Vec3f& wo() const { return medium_ ? wo_ : surface_->wo(); }
  /// Without normals in a medium.
  const SurfacePoint& point() const { return medium_ ? in_medium_ : surface_->point(); }
  const Vec3f& position() const { return point().position; }
  Facing facing() const {
    return medium_ ? Facing{{0, 0, 0}, medium_->mean_extinction(in_medium_.position)}
                   : Facing{surface_->point().ng, 0};
  }
  /// 1/extinction, m; zero on a surface.
  float mean_free_path() const {
    return medium_ ? 1 / medium_->mean_extinction(in_medium_.position) : 0.0f;
  }
  Lobes lobes() const { return medium_ ? Lobes::diffuse : surface_->lobes(); }
  const Medium* medium_toward(const Vec3f& direction, const Medium* arrived) const {
    return medium_ ? medium_ : surface_->medium_toward(direction, arrived);
  }

  /// See SurfaceVertex; of a medium the phase function: what is absorbed was taken off on the way.
  Spectrum eval_cosine(const Vec3f& wi, Lobes lobes) const {
    if (!medium_) return surface_->eval_cosine(wi, lobes);
    return any(lobes & Lobes::diffuse) ? Spectrum(medium_->phase().eval(wo_, wi)) : Spectrum();
  }
  float pdf(const Vec3f& wi, Lobes lobes) const {
    return medium_ ? medium_->phase().eval(wo_, wi) : surface_->pdf(wi, lobes);
  }
  float pdf_reverse(const Vec3f& wi, Lobes lobes) const {
    return medium_ ? medium_->phase().eval(wi, wo_) : surface_->pdf_reverse(wi, lobes);
  }

 private:
  const SurfaceVertex* surface_ = nullptr;
  const Medium* medium_ = nullptr;  ///< null: on a surface
  SurfacePoint in_medium_;
  Vec3f wo_{0, 0, 0};
};

}  // namespace kaustik
