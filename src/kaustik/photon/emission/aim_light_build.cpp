// How the aim of a light is made: what each sphere's chance is and whether aiming pays.

#include <algorithm>
#include <numeric>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/photon/emission/aim_light.h"

namespace kaustik {
namespace {

constexpr int directions_per_probe = 4;

/// Whether bounds leave it open that light comes from `light` to the sphere.
bool can_reach(const LightBounds& light, const AimSphere& sphere) {
  if (light.infinite) return true;
  if (light.position.isEmpty()) return false;
  const Vec3f to = sphere.center - center(light.position);
  const float distance = length(to);
  // All directions from all points of the light lie in the cone toward the sphere as seen from the
  // middle, after the sphere has grown by the light.
  const float radius =
      1.001f * (sphere.radius + bounding_radius(light.position)) + 1e-4f * distance;
  if (radius >= distance) return true;
  const float cos_to_axis = std::clamp(dot(light.axis, to) / distance, -1.0f, 1.0f);
  const float sin_sphere = radius / distance;
  const float cos_sphere = safe_sqrt(1.0f - sqr(sin_sphere));
  if (cos_to_axis >= cos_sphere) return true;
  const float cos_nearest =
      cos_to_axis * cos_sphere + safe_sqrt(1.0f - sqr(cos_to_axis)) * sin_sphere;
  return cos_nearest >= light.cos_angle - 1e-4f;
}

}  // namespace

AimedLight::AimedLight(const Light& light, const Shape* shape, const AimInputs& inputs)
    : light_(&light), shape_(shape), on_surface_(shape != nullptr) {
  if (!inputs.scene_bounds.isEmpty()) {
    scene_center_ = center(inputs.scene_bounds);
    scene_radius_ = 1.001f * bounding_radius(inputs.scene_bounds);
  }
  if (light.traits().is_beam()) {
    // Its rays begin on its shape, all along one direction: there is nothing to aim.
    kind_ = inputs.spheres.empty() ? Kind::dark : Kind::own;
    return;
  }
  if (light.is_infinite()) {
    kind_ = Kind::infinite;
  } else {
    kind_ = Kind::place;
    // Of a light with two sides no side of a ball is all of it.
    if (shape && !light.traits().is_two_sided) ball_ = find_ball(*shape);
    if (ball_.radius > 0) kind_ = Kind::ball;
    set_own_limit();
  }
  add_spheres(inputs);
  if (table_.x.empty()) {
    kind_ = Kind::dark;
    return;
  }
  const auto aimed_pdf = [this](const SurfacePoint& origin, const Vec3f& direction) {
    return pdf(origin, direction);
  };
  if (own_serves_as_well(light, aimed_pdf, inputs.probes * 16)) kind_ = Kind::own;
}

/// Where cones are wider than what the light emits into, the light knows better.
void AimedLight::set_own_limit() {
  const float cos_angle = light_->traits().bounds.cos_angle;
  if (on_surface_) {
    own_solid_angle_ = pi;  // cosine-weighted
    own_limit_ = 0.75f;     // sin² of 60°: the cone of that solid angle
  } else {
    own_solid_angle_ = 2.0f * pi * (1.0f - cos_angle);
    own_limit_ = cos_angle > 0 ? std::max(1.0f - sqr(cos_angle), 1e-6f) : 1.0f;
  }
  // Probes may miss all that a pattern has of light: the mean is known.
  const float origins =
      light_->emission_pdf_position(light_->placed().sample_origin({0.5f, 0.5f}).point);
  peak_ = light_->traits().power.max_lane() * origins / (on_surface_ ? pi : 4 * pi);
  for (uint32_t k = 0; k < 16; ++k) {
    Sampler sampler = Sampler::of(Quadrature::aim_peak, k);
    const Vec2f u = sampler.next_2d();
    const EmissionSample s = light_->sample_emission(u, sampler.next_2d(), {});
    if (s.pdf_direction > 0)
      peak_ = std::max(peak_, light_->emitted(s.point, s.direction, {}).max_lane());
  }
}

/// Dot product with the ball's normal from which on a point of the ball belongs to the cap from
/// which a sphere may be seen: where some of it lies above the tangent plane.
float AimedLight::cap_threshold(const AimSphere& sphere) const {
  const float distance = length(sphere.center - ball_.center);
  const float threshold = ball_.radius - 1.001f * sphere.radius - 1e-4f * (distance + ball_.radius);
  return threshold <= -0.9999f * distance ? -infinity : threshold;
}

/// What the light emits into a cone at `origin`, W per area of the light (for points W), by a few
/// probes; with a floor, since probes prove nothing.
double AimedLight::flux_into_cone(const SurfacePoint& origin, const AimCone& cone,
                                  uint32_t probe) const {
  const float solid_angle =
      cone.own ? own_solid_angle_ : std::min(2.0f * pi * cone.one_minus_cos, own_solid_angle_);
  double sum = 0;
  for (uint32_t k = 0; k < directions_per_probe; ++k) {
    Sampler sampler = Sampler::of(Quadrature::aim_cone, directions_per_probe * probe + k);
    const Vec2f u = sampler.next_2d();
    const Vec3f direction = cone.own
                                ? own_direction(origin, sampler.next_2d(), u)
                                : Frame(cone.axis).to_world(square_to_cone(u, cone.one_minus_cos));
    const float pdf =
        cone.own ? own_direction_pdf(origin, direction) : cone_pdf(cone.one_minus_cos);
    const float cosine = on_surface_ ? std::max(dot(origin.ng, direction), 0.0f) : 1.0f;
    if (pdf > 0) sum += double(light_->emitted(origin, direction, {}).max_lane() * (cosine / pdf));
  }
  return std::max(sum / directions_per_probe, 0.05 * double(peak_ * solid_angle));
}

/// What the light sends to a sphere, in a unit of its own.
double AimedLight::flux_toward(const AimSphere& sphere, int probes) const {
  double sum = 0;
  const float threshold = kind_ == Kind::ball ? cap_threshold(sphere) : 0.0f;
  for (uint32_t k = 0; k < uint32_t(probes); ++k) {
    const Vec2f u = Sampler::of(Quadrature::aim_sphere, k).next_2d();
    SurfacePoint origin;
    if (kind_ == Kind::ball) {
      origin.ng = origin.ns = cap_direction(sphere.center, threshold, u);
      origin.position = ball_.center + origin.ng * ball_.radius;
    } else {
      origin = light_->placed().sample_origin(u).point;
    }
    const AimCone cone =
        cone_toward(sphere.center, sqr(sphere.radius), origin.position, own_limit_);
    sum += flux_into_cone(origin, cone, k);
  }
  const double share = kind_ == Kind::ball ? double(cap_height(sphere.center, threshold)) : 1.0;
  return share * sum;
}

void AimedLight::add_spheres(const AimInputs& inputs) {
  const LightBounds bounds = light_->traits().bounds;
  std::vector<double> chances;
  for (const AimSphere& sphere : inputs.spheres) {
    if (!can_reach(bounds, sphere)) continue;
    const float threshold = kind_ == Kind::ball ? cap_threshold(sphere) : -infinity;
    if (threshold >= length(sphere.center - ball_.center)) continue;  // inside of the ball
    const double received =
        kind_ == Kind::infinite ? double(sqr(sphere.radius)) : flux_toward(sphere, inputs.probes);
    if (!(received > 0)) continue;
    chances.push_back(double(sphere.weight) * received);
    table_.add(sphere.center, sphere.radius, 0, threshold);
  }
  if (!chances.empty()) set_chances(std::move(chances));
  table_.pad();
}

void AimedLight::set_chances(std::vector<double> chances) {
  const double total = std::accumulate(chances.begin(), chances.end(), 0.0);
  // None too small for the steps of the random numbers.
  for (double& chance : chances) chance = std::max(chance, 1e-5 * total);
  const double raised = std::accumulate(chances.begin(), chances.end(), 0.0);
  double sum = 0;
  for (const double chance : chances) cumulative_.push_back(float((sum += chance) / raised));
  cumulative_.back() = 1;
  // The weights follow the rounded sums, which are what is sampled.
  for (size_t i = 0; i < chances.size(); ++i) {
    float area = 1;
    if (kind_ == Kind::infinite) area = pi * table_.radius_sq[i];
    if (kind_ == Kind::ball)
      area = 2.0f * pi * sqr(ball_.radius) * cap_height(table_.center(i), table_.cap_threshold[i]);
    table_.weight[i] = (cumulative_[i] - (i > 0 ? cumulative_[i - 1] : 0.0f)) / area;
  }
}

bool own_serves_as_well(const Light& light,
                        const std::function<float(const SurfacePoint&, const Vec3f&)>& aimed_pdf,
                        int probes) {
  double own_squares = 0, aimed_squares = 0;
  int useful = 0;
  for (uint32_t k = 0; k < uint32_t(probes); ++k) {
    Sampler sampler = Sampler::of(Quadrature::aim_or_own, k);
    const Vec2f u = sampler.next_2d();
    const EmissionSample s = light.sample_emission(u, sampler.next_2d(), {});
    const float aimed = aimed_pdf(s.point, s.direction);
    if (!(aimed > 0)) continue;
    ++useful;
    const double flux_sq = double(sqr(s.flux.max_lane()));
    own_squares += flux_sq;
    aimed_squares += flux_sq * double(s.pdf_position * s.pdf_direction) / double(aimed);
  }
  // Aiming costs time as well; and few useful rays are a reason to aim, not a measurement.
  return useful >= 8 && aimed_squares > 0.9 * own_squares;
}

}  // namespace kaustik
