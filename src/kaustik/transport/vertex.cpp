#include "kaustik/transport/vertex.h"

#include "kaustik/transport/visible_normal.h"

namespace kaustik {
namespace {

/// The shading normal; seen from a side that it denies (silhouettes of smooth meshes) the geometric
/// normal takes its place, or the point would be black.
const Vec3f& normal_toward(const Vec3f& wo, const SurfacePoint& point) {
  return dot(wo, point.ng) * dot(wo, point.ns) <= 0 ? point.ng : point.ns;
}

}  // namespace

void SurfaceVertex::meet(const Scene& scene, const Ray& ray, const Hit& hit, TransportMode mode,
                         const Footprint& footprint, const Wavelengths& wavelengths) {
  point_ = scene.tracer().surface_point(ray, hit);
  wo_ = -ray.direction;
  const Surface& surface = scene.surface(point_.shape);
  surface_ = &surface;
  bsdf_ = surface.bsdf.get();
  traits_ = surface.traits;
  light_ = surface.light;
  context_.mode = mode;
  turn_to(normal_toward(wo_, point_));
  has_relief_ = false;
  const SurfaceNeeds asked = traits_.needs;
  if (asked == SurfaceNeeds::none) {
    TextureCoordinates at;
    at.uv = point_.uv;
    context_.move_to(at, wavelengths);
  } else {
    const UvDerivatives derivatives = scene.tracer().uv_derivatives(point_);
    context_.move_to(texture_place(scene, wo_, footprint.width, derivatives), wavelengths);
    if (needs(asked, SurfaceNeeds::relief)) bend_normal(scene, footprint, derivatives);
    if (needs(asked, SurfaceNeeds::tangent)) turn_to_tangent(derivatives.dpdu);
  }
  side_sign_ = dot(frame_.z, point_.ng) < 0 ? -1.0f : 1.0f;
}

void SurfaceVertex::stand_at(const SurfacePoint& gauge, const Wavelengths& wavelengths) {
  static const Surface nothing{};
  point_ = gauge;
  wo_ = gauge.ng;
  surface_ = &nothing;
  bsdf_ = &white_diffuse();
  traits_ = bsdf_->traits();
  light_ = -1;
  context_.mode = TransportMode::radiance;
  context_.move_to({}, wavelengths);
  turn_to(gauge.ns);
  has_relief_ = false;
  side_sign_ = 1;
}

void SurfaceVertex::paint_white() {
  bsdf_ = &white_diffuse();
  traits_ = bsdf_->traits();
  const Vec3f normal = normal_toward(wo_, point_);
  turn_to(dot(wo_, normal) < 0 ? -normal : normal);
  side_sign_ = dot(frame_.z, point_.ng) < 0 ? -1.0f : 1.0f;
}

void SurfaceVertex::turn_to(const Vec3f& normal) {
  frame_ = Frame(normal);
  wo_local_ = frame_.to_local(wo_);
}

SurfaceVertex SurfaceVertex::in(const Wavelengths& wavelengths) const {
  SurfaceVertex result = *this;
  if (!(wavelengths == result.wavelengths()))
    result.context_.move_to(result.context_.texture(), wavelengths);
  return result;
}

void SurfaceVertex::look_up_from(const Scene& scene, const Vec3f& direction, float beam_width) {
  context_.move_to(
      texture_place(scene, direction, beam_width, scene.tracer().uv_derivatives(point_)),
      context_.wavelengths());
}

TextureCoordinates SurfaceVertex::texture_place(const Scene& scene, const Vec3f& toward_beam,
                                                float beam_width,
                                                const UvDerivatives& derivatives) const {
  TextureCoordinates at;
  at.uv = point_.uv;
  at.position = point_.position;
  at.normal = point_.ng;
  at.primitive = point_.primitive;
  // The ellipse that the beam cuts out of the surface, as a disk of the same area.
  at.width = beam_width / std::sqrt(std::max(abs_dot(toward_beam, point_.ng), 0.01f));
  // At the poles of a sphere u goes all round in no way at all.
  constexpr float largest_width = 16;
  const auto in_uv = [&](const Vec3f& derivative) {
    const float metres = length(derivative);
    return metres > 0 ? std::min(at.width / metres, largest_width) : 0.0f;
  };
  at.uv_width = {in_uv(derivatives.dpdu), in_uv(derivatives.dpdv)};
  if (point_.instance != no_instance) {
    const Transform shape_from_world =
        scene.tracer().geometry().instances[point_.instance].world_from_group.inverse();
    at.position = shape_from_world.point(at.position);
    at.normal = normalize(shape_from_world.normal(at.normal));
    at.width *= float(std::cbrt(std::fabs(shape_from_world.determinant3())));
  }
  return at;
}

void SurfaceVertex::bend_normal(const Scene& scene, const Footprint& footprint,
                                const UvDerivatives& derivatives) {
  const Relief* relief = bsdf_->relief(on_front());
  if (!relief) return;
  ReliefPoint at{context_.texture(), point_.ns, derivatives.dpdu, derivatives.dpdv};
  if (footprint.scattered) {
    at.texture.width = 0;
    at.texture.uv_width = {0, 0};
  }
  if (point_.instance != no_instance)
    at.world_from_shape = &scene.tracer().geometry().instances[point_.instance].world_from_group;
  has_relief_ = true;
  frame_ = Frame(
      visible_normal(relief->normal(at), point_.ng, wo_, any(traits_.lobes & Lobes::specular)));
  wo_local_ = frame_.to_local(wo_);
}

void SurfaceVertex::turn_to_tangent(const Vec3f& dpdu) {
  const Vec3f along_u = dpdu - frame_.z * dot(frame_.z, dpdu);
  const float along_u_length = length(along_u);
  if (!(along_u_length > 0)) return;
  frame_.x = along_u * (1 / along_u_length);
  frame_.y = cross(frame_.z, frame_.x);
  wo_local_ = frame_.to_local(wo_);
}

float SurfaceVertex::irradiance_factor(const Vec3f& wi) const {
  const float cosine = dot(wi, frame_.z), geometric = dot(wi, point_.ng);
  if (!(cosine * geometric * side_sign_ > 0)) return 0;
  return std::min(cosine / geometric * side_sign_, largest_irradiance_factor);
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

float SurfaceVertex::pdf_reverse(const Vec3f& wi, Lobes lobes) const {
  const Vec3f wi_local = frame_.to_local(wi);
  if (!sides_agree(wi, wi_local)) return 0;
  return bsdf_->pdf(context_, wi_local, wo_local_, lobes);
}

BsdfValues SurfaceVertex::values(const Vec3f& wi) const {
  const Vec3f wi_local = frame_.to_local(wi);
  if (!sides_agree(wi, wi_local)) return {};
  return bsdf_->values(context_, wo_local_, wi_local);
}

void SurfaceVertex::values(std::span<const Vec3f> wi, std::vector<BsdfValues>& result) const {
  // A few at a time, which need no memory.
  constexpr size_t some = 64;
  std::array<Vec3f, some> local;
  result.resize(wi.size());
  for (size_t begin = 0; begin < wi.size(); begin += some) {
    const size_t count = std::min(some, wi.size() - begin);
    for (size_t i = 0; i < count; ++i) local[i] = frame_.to_local(wi[begin + i]);
    std::array<bool, some> agrees;
    for (size_t i = 0; i < count; ++i) agrees[i] = sides_agree(wi[begin + i], local[i]);
    bsdf_->all_values(context_, wo_local_, std::span(local).first(count),
                      std::span(result).subspan(begin, count));
    for (size_t i = 0; i < count; ++i)
      if (!agrees[i]) result[begin + i] = {};
  }
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
