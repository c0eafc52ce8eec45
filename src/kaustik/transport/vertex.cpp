#include "kaustik/transport/vertex.h"

namespace kaustik {

void SurfaceVertex::meet(const Scene& scene, const Ray& ray, const Hit& hit, TransportMode mode,
                         float footprint) {
  point_ = scene.tracer().surface_point(ray, hit);
  wo_ = -ray.direction;
  const Surface& surface = scene.surface(point_.shape);
  surface_ = &surface;
  bsdf_ = surface.bsdf.get();
  lobes_ = bsdf_->lobes();
  light_ = surface.light;
  context_.texture.uv = point_.uv;
  context_.texture.footprint = footprint;
  context_.mode = mode;
  frame_ = Frame(point_.ns);
  wo_local_ = frame_.to_local(wo_);
  // Seen from a side that the shading normal denies (silhouettes of smooth meshes): the geometric
  // normal takes its place, or the point would be black.
  if (dot(wo_, point_.ng) * wo_local_.z <= 0) {
    frame_ = Frame(point_.ng);
    wo_local_ = frame_.to_local(wo_);
  }
  side_sign_ = dot(frame_.z, point_.ng) < 0 ? -1.0f : 1.0f;
}

float SurfaceVertex::adjoint_factor(const Vec3f& wi, const Vec3f& wi_local) const {
  if (context_.mode == TransportMode::radiance) return 1;
  const float denominator = abs_dot(wo_, point_.ng) * std::fabs(wi_local.z);
  if (!(denominator > 0)) return 0;
  return std::fabs(wo_local_.z) * abs_dot(wi, point_.ng) / denominator;
}

Spectrum SurfaceVertex::eval(const Vec3f& wi, Lobes lobes) const {
  const Vec3f wi_local = frame_.to_local(wi);
  if (!sides_agree(wi, wi_local)) return {};
  return bsdf_->eval(context_, wo_local_, wi_local, lobes);
}

Spectrum SurfaceVertex::eval_cosine(const Vec3f& wi, Lobes lobes) const {
  const Vec3f wi_local = frame_.to_local(wi);
  if (!sides_agree(wi, wi_local)) return {};
  return bsdf_->eval(context_, wo_local_, wi_local, lobes) *
         (std::fabs(wi_local.z) * adjoint_factor(wi, wi_local));
}

float SurfaceVertex::pdf(const Vec3f& wi, Lobes lobes) const {
  const Vec3f wi_local = frame_.to_local(wi);
  if (!sides_agree(wi, wi_local)) return 0;
  return bsdf_->pdf(context_, wo_local_, wi_local, lobes);
}

BsdfSample SurfaceVertex::sample(float u_lobe, const Vec2f& u, Lobes lobes) const {
  BsdfSample result = bsdf_->sample(context_, wo_local_, u_lobe, u, lobes);
  if (result.event == Lobes::none) return result;
  const Vec3f wi = frame_.to_world(result.wi);
  if (!sides_agree(wi, result.wi)) {
    result.weight = Spectrum();
    result.event = Lobes::none;
    return result;
  }
  result.weight *= adjoint_factor(wi, result.wi);
  result.wi = wi;
  return result;
}

}  // namespace kaustik
