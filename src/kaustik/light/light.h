#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kaustik/base/spectrum.h"
#include "kaustik/geometry/shape.h"
#include "kaustik/light/emission_pattern.h"
#include "kaustik/light/light_visibility.h"

namespace kaustik {

class PictureReader;

struct EmissionBall;

/// A point that asks a light for light.
struct LightQuery {
  Vec3f reference{0, 0, 0};
  /// Of the surface there, on the side that receives; zero: none, or light from both sides counts.
  Vec3f normal{0, 0, 0};
  /// Recursion level of the path that asks: the deeper, the more coarsely lights may be sampled.
  int level = 0;

  LightQuery() = default;
  LightQuery(const Vec3f& at, const Vec3f& surface_normal = Vec3f(0, 0, 0), int recursion_level = 0)
      : reference(at), normal(surface_normal), level(recursion_level) {}
};

/// Light that a point may receive, found by sampling a light.
struct LightSample {
  Vec3f direction{0, 0, 0};   ///< unit, from the reference point to the light
  float distance = infinity;  ///< to the light; infinite for directional and environment lights
  SurfacePoint point;         ///< on the light; valid if `on_surface` (of lights that are a point
                              ///< its position is)
  bool on_surface = false;
  bool delta = false;         ///< the light is a point or a single direction
  bool only_sampled = false;  ///< no ray meets the light: nothing to weigh the sample against
  Spectrum radiance;          ///< arriving, W/(sr·m²); for delta lights irradiance on a facing
                              ///< surface, W/m²
  float pdf_solid_angle = 0;  ///< 1 for delta lights; zero: no light can arrive
};

/// A ray that a light emits, by the light's own distribution, in proportion to emitted flux where
/// that is possible.
struct EmissionSample {
  SurfacePoint point;  ///< origin; `error` zero if not on a surface. ng: zero if none
  bool on_surface = false;
  Vec3f direction{0, 0, 0};  ///< unit; zero if there is no ray
  Spectrum flux;            ///< W: emitted radiance × cosine / density (delta lights: intensity or
                            ///< irradiance / density); zero: nothing
  float pdf_position = 0;   ///< per area on the light (or on the disk that directional and
                            ///< environment rays start from); 1 for point lights
  float pdf_direction = 0;  ///< per solid angle; 1 for directional lights
};

/// Bounds on where light goes, for choosing among many lights and for aiming.
struct LightBounds {
  Bounds3f position;    ///< empty for lights at infinity
  Vec3f axis{0, 0, 1};  ///< light leaves only within this angle of the axis
  float cos_angle = -1;
  bool infinite = false;
  /// Cosine of the cone of a surface's normals, about which light falls off by the cosine until it
  /// ends at `cos_angle`; equal to that where nothing is known to fall off.
  float cos_spread = -1;
};

/// A source of light. Immutable. Emission is one-sided on surfaces (the side of the geometric
/// normal), as in Mitsuba.
class Light {
 public:
  virtual ~Light() = default;

  /// Total emitted flux, W. For infinite lights that through the scene's bounding disk.
  virtual Spectrum power() const = 0;
  virtual LightBounds bounds() const = 0;
  /// A single point or direction.
  virtual bool is_delta() const = 0;
  /// Shines from infinity (directional or environment).
  virtual bool is_infinite() const { return false; }
  /// Lights nothing: background() is only for rays that leave the scene straight from the camera or
  /// after delta events.
  virtual bool is_only_seen() const { return false; }
  /// Of area lights: both sides of the surface shine.
  virtual bool is_two_sided() const { return false; }
  /// Index into the scene's shapes if it is an area light, else −1.
  virtual int shape() const { return -1; }

  /// Estimate of the irradiance that the light gives the queried point without shadows, on the
  /// normal's side (facing the light where there is no normal); W/m², sum of the lanes. What
  /// samples are shared out by: zero only where no light can arrive, and rather too high than too
  /// low. This is the thesis's brightness times projection.
  virtual float expected_irradiance(const LightQuery& query) const = 0;
  /// A ball that tells about the same as expected_irradiance(), and is zero no earlier: many are
  /// asked at once. Null where none does, always of infinite lights.
  virtual const EmissionBall* emission_ball() const { return nullptr; }
  /// For classical ray tracing alone: factor on light that arrives at `reference`, which replaces
  /// the inverse square of the distance by the emitter's `attenuation`. 1 where none is given.
  /// Photons, and everything else that is physical, ignore it.
  virtual float classical_attenuation(const Vec3f& reference) const;

  /// Most shadow rays for one sample of the light at recursion level 0: where some arrive and some
  /// don't, up to so many are worth their time. 1: one always does.
  virtual int shadow_samples() const { return 1; }

  virtual LightSample sample_toward(const LightQuery& query, const Vec2f& u) const = 0;
  /// Density of sample_toward, for a point on the light (area lights) …
  virtual float pdf_toward(const LightQuery& query, const SurfacePoint& point) const;
  /// … or for a direction from the reference (environment lights).
  virtual float pdf_toward_direction(const LightQuery& query, const Vec3f& direction) const;

  /// Of the surface that the density of a point on the light is over. Lights with a place.
  virtual Vec3f emitting_normal(const SurfacePoint& point) const { return point.ng; }

  /// Radiance from a point of the light's surface along `direction` (away from it). Area lights.
  virtual Spectrum emitted(const SurfacePoint& point, const Vec3f& direction) const;
  /// Radiance of rays that leave the scene along `direction`. Environment lights.
  virtual Spectrum background(const Vec3f& direction) const;

  virtual EmissionSample sample_emission(const Vec2f& u_position,
                                         const Vec2f& u_direction) const = 0;
  /// Density of sample_emission's position, per area (see EmissionSample::pdf_position).
  virtual float emission_pdf_position(const SurfacePoint& point) const = 0;
  /// Density of sample_emission's direction at `point`, per solid angle.
  virtual float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const = 0;

  // What aimed emission needs. Lights with a place: a position, then any direction whose density
  // the aim knows.
  /// Uniform by area on the light; `ng` zero and pdf 1 for points. Not for infinite lights. The
  /// direction, its density and the flux stay zero.
  virtual EmissionSample sample_origin(const Vec2f& u) const;
  /// Radiance (area lights; with the cosine applied by the caller), or intensity W/sr (point
  /// lights), leaving `point` along `direction`. Infinite lights: what travels along `direction`,
  /// radiance (environment) or irradiance across it (directional, whose only direction it must be).
  virtual Spectrum emitted_from(const SurfacePoint& point, const Vec3f& direction) const;
  // Infinite lights: a direction, then any origin on the plane across it.
  /// A direction of travel (away from the light) with its density (1 for directional).
  virtual Vec3f sample_travel_direction(const Vec2f& u, float& pdf) const;
};

/// What create() gets: the shape for area lights, the scene's bounds for infinite ones.
struct LightInputs {
  const Arguments& arguments;
  const Transform& to_world;           ///< of the emitter, where `arguments` give none
  std::shared_ptr<const Shape> shape;  ///< of area lights, else null
  int shape_index = -1;
  Bounds3f scene_bounds;  ///< of everything that can be hit
  /// Stands for a color argument that takes a texture; null: the argument counts.
  std::shared_ptr<const EmissionPattern> pattern = nullptr;
  PictureReader* pictures = nullptr;  ///< null: one with the default budget
};

struct LightType {
  const TypeInfo& info;
  bool needs_shape = false;
  /// Throws Error where arguments contradict one another, or the shape cannot be a light.
  std::unique_ptr<Light> (*create)(const LightInputs&);
};
/// One row per type of emitter.
const std::vector<LightType>& light_types();

/// Chooses one of many lights for a reference point by the irradiance that they may give: those
/// with a place by a light tree (Conty Estevez and Kulla 2018), infinite ones beside it; neither of
/// these two groups gets less than a fifth. Once it has learned which lights are seen from where,
/// up to 64 of any kind are chosen by the irradiance that they may give and its share that arrived
/// at probes nearby. Every light that can reach the point has a chance above zero; lights without
/// power have none. Immutable once it has learned.
class LightSelector {
 public:
  /// `lights` must outlive this.
  explicit LightSelector(const std::vector<std::unique_ptr<Light>>& lights);
  ~LightSelector();

  static constexpr size_t maximum_learned = 64;
  /// Whether there are some lights to choose from, and few enough for learn().
  bool can_learn() const;
  /// `visibility` knows all lights, by their indices. Before anything is chosen.
  void learn(LightVisibility visibility);

  struct Choice {
    int light = -1;  ///< −1: no light has power
    float probability = 0;
  };
  /// What choose() answers everywhere, where at most one light has power; else null.
  const Choice* only_choice() const { return only_choice_ ? &*only_choice_ : nullptr; }
  /// `normal` as of a LightQuery. `u` in [0, 1) is replaced by a fresh uniform number.
  Choice choose(const Vec3f& reference, const Vec3f& normal, float& u) const {
    Choice choice;
    choose(reference, normal, {&u, 1}, &choice);
    return choice;
  }
  /// The same for every number in `u`, into as many `choices`; the lights are weighed once.
  void choose(const Vec3f& reference, const Vec3f& normal, std::span<float> u,
              Choice* choices) const;
  /// Exactly what choose() reports for this light.
  float probability(const Vec3f& reference, const Vec3f& normal, int light) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::optional<Choice> only_choice_;
};

}  // namespace kaustik
