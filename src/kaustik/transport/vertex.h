#pragma once
#include <span>
#include <vector>

#include "kaustik/scene/scene.h"
#include "kaustik/transport/path_state.h"

namespace kaustik {

/// See SurfaceVertex::irradiance_factor.
inline constexpr float largest_irradiance_factor = 10;

/// A path's meeting with a surface: geometry, material, and the direction it came from. All
/// directions point away from the surface, in world space.
class SurfaceVertex {
 public:
  SurfaceVertex() = default;
  /// Of a path in that state.
  SurfaceVertex(const Scene& scene, const Ray& ray, const Hit& hit, const PathState& state) {
    meet(scene, ray, hit, state);
  }
  /// Of a probe in RGB mode, which looks at geometry or importance.
  SurfaceVertex(const Scene& scene, const Ray& ray, const Hit& hit, TransportMode mode) {
    meet(scene, ray, hit, mode);
  }
  /// Makes this the vertex of another hit.
  void meet(const Scene& scene, const Ray& ray, const Hit& hit, const PathState& state) {
    meet(scene, ray, hit, state.mode, state.footprint, state.wavelengths);
  }
  void meet(const Scene& scene, const Ray& ray, const Hit& hit, TransportMode mode) {
    meet(scene, ray, hit, mode, {}, {});
  }
  void meet(const Scene& scene, const Ray& ray, const Hit& hit, TransportMode mode,
            const Footprint& footprint, const Wavelengths& wavelengths);

  /// Makes this a point of a white matt surface that is none of the scene's, seen straight from
  /// above its normal; see Gauge.
  void stand_at(const SurfacePoint& gauge, const Wavelengths& wavelengths);

  /// The same in light of other wavelengths, with the widths of a beam and the relief as they are.
  SurfaceVertex in(const Wavelengths& wavelengths) const;

  /// Lays ideally white paint on the side that is seen, whatever lies below: irradiance E there is
  /// radiance E/π by the diffuse lobe. It is smooth: bump and normal maps don't bend its normal.
  void paint_white();

  /// Whether its bsdf looks up textures.
  bool has_textures() const { return needs(traits_.needs, SurfaceNeeds::texture); }
  /// Looks textures up as whoever sees it from `direction` does, by a beam that is so wide here.
  /// The relief stays.
  void look_up_from(const Scene& scene, const Vec3f& direction, float beam_width);

  const SurfacePoint& point() const { return point_; }
  const Vec3f& position() const { return point_.position; }
  const Bsdf& bsdf() const { return *bsdf_; }
  Lobes lobes() const { return traits_.lobes; }
  /// Of the bsdf.
  bool transmits() const { return traits_.transmits; }
  bool is_lambertian() const { return traits_.is_lambertian; }
  /// Whether paths go straight on, without an event (Bsdf::is_null).
  bool is_null() const { return surface_->traits.is_null; }
  /// Of the light along wo that goes straight on; see Bsdf.
  bool passes_straight() const { return traits_.passes_straight; }
  Spectrum straight() const { return bsdf_->straight(context_, wo_local_); }
  /// What a path goes on through along `direction`, having arrived through `arrived`.
  const Medium* medium_toward(const Vec3f& direction, const Medium* arrived) const {
    return surface_->medium_toward(dot(direction, point_.ng) > 0, arrived);
  }
  const Vec3f& wo() const { return wo_; }
  int light() const { return light_; }
  const BsdfContext& context() const { return context_; }
  const Wavelengths& wavelengths() const { return context_.wavelengths(); }
  /// Of the shading frame.
  const Vec3f& normal() const { return frame_.z; }
  const Frame& frame() const { return frame_; }

  /// f·|cosθ_i| in the direction of transport: the cosine by the shading normal, and for flux the
  /// factor that keeps shading normals adjoint (Veach 1997, eq. 5.19). Zero where the geometric
  /// and the shading normal disagree on the side of wi.
  Spectrum eval_cosine(const Vec3f& wi, Lobes lobes) const;
  /// f alone.
  Spectrum eval(const Vec3f& wi, Lobes lobes) const;
  /// f of the diffuse lobe for all directions on wo's side; where it is not the same for all, what
  /// it is on the mean over even light …
  Spectrum diffuse_value() const {
    const bool is_one_value =
        traits_.is_lambertian || (traits_.transmits && !diffuse_value_through().is_zero());
    return is_one_value ? eval(facing_normal(), Lobes::diffuse) : albedo(Lobes::diffuse) * inv_pi;
  }
  /// … and for all on the other side.
  Spectrum diffuse_value_through() const { return eval(-facing_normal(), Lobes::diffuse); }
  /// Whether a bump or normal map bends the normal (paint or not): photons on such surfaces hold
  /// flux by the geometric normal.
  bool has_relief() const { return has_relief_; }
  /// Whether f is diffuse_value() for all light that merges here: beside the diffuse lobe there may
  /// be a delta one, which merges with nothing.
  bool is_matt() const {
    return (lobes() & (Lobes::diffuse | Lobes::glossy)) == Lobes::diffuse &&
           traits_.is_lambertian && !transmits() && !has_relief();
  }
  /// What turns irradiance from wi, measured by the geometric normal as photons do, into that by
  /// the shading normal; zero where the two disagree on the side of wi. At most
  /// `largest_irradiance_factor`: it grows without bound at grazing incidence, where a single
  /// photon would outshine all others. Of even light a normal bent by β loses less than sin²β / 10
  /// by that.
  float irradiance_factor(const Vec3f& wi) const;
  /// The shading normal on wo's side.
  Vec3f facing_normal() const { return wo_local_.z < 0 ? -frame_.z : frame_.z; }
  float pdf(const Vec3f& wi, Lobes lobes) const;
  /// Density with which a path that comes from wi would be sent to wo.
  float pdf_reverse(const Vec3f& wi, Lobes lobes) const;
  /// eval() of both lobes, pdf() and pdf_reverse() at once.
  BsdfValues values(const Vec3f& wi) const;
  /// The same of many directions, one after the other.
  void values(std::span<const Vec3f> wi, std::vector<BsdfValues>& result) const;
  /// wi of the result is in world space; the weight holds the same factors as eval_cosine.
  BsdfSample sample(float u_lobe, const Vec2f& u, Lobes lobes) const;
  Spectrum albedo(Lobes lobes) const { return bsdf_->albedo(context_, wo_local_, lobes); }
  /// Whether wo lies on the side of the geometric normal.
  bool on_front() const { return dot(wo_, point_.ng) > 0; }

 private:
  bool sides_agree(const Vec3f& wi, const Vec3f& wi_local) const {
    return dot(wi, point_.ng) * wi_local.z * side_sign_ > 0;
  }
  void turn_to(const Vec3f& normal);
  float adjoint_factor(const Vec3f& wi, const Vec3f& wi_local) const;
  TextureCoordinates texture_place(const Scene& scene, const Vec3f& toward_beam, float beam_width,
                                   const UvDerivatives& derivatives) const;
  void bend_normal(const Scene& scene, const Footprint& footprint,
                   const UvDerivatives& derivatives);
  void turn_to_tangent(const Vec3f& dpdu);

  SurfacePoint point_;
  const Surface* surface_ = nullptr;
  const Bsdf* bsdf_ = nullptr;
  BsdfTraits traits_;  ///< of the bsdf
  int light_ = -1;
  BsdfContext context_;
  Frame frame_;
  Vec3f wo_, wo_local_;
  float side_sign_ = 1;
  bool has_relief_ = false;
};

}  // namespace kaustik
