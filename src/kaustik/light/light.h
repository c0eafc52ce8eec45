#pragma once
#include <cassert>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kaustik/base/wavelengths.h"
#include "kaustik/geometry/shape.h"
#include "kaustik/light/attenuation.h"
#include "kaustik/light/emission_ball.h"
#include "kaustik/light/emission_pattern.h"
#include "kaustik/light/light_visibility.h"

namespace kaustik {

class PictureReader;

/// A point that asks a light for light.
struct LightQuery {
  Vec3f reference{0, 0, 0};
  /// Of the surface there, on the side that receives; zero: none, or light from both sides counts.
  Vec3f normal{0, 0, 0};
  /// Recursion level of the path that asks: the deeper, the more coarsely lights may be sampled.
  int level = 0;
  /// Of the light that is asked for. Where samples go does not depend on it.
  Wavelengths wavelengths;

  LightQuery() = default;
  LightQuery(const Vec3f& at, const Vec3f& surface_normal = Vec3f(0, 0, 0), int recursion_level = 0,
             const Wavelengths& at_wavelengths = {})
      : reference(at),
        normal(surface_normal),
        level(recursion_level),
        wavelengths(at_wavelengths) {}
};

/// What a ray from the reference point meets of a light.
struct LightTarget {
  LightTarget(const SurfacePoint& on_light) : point(&on_light) {}  // NOLINT: a point is one
  LightTarget(const Vec3f& toward) : direction(toward) {}          // NOLINT: a direction is one

  const SurfacePoint* point = nullptr;  ///< of placed lights; must outlive this
  Vec3f direction{0, 0, 0};             ///< unit, toward distant lights; else zero
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

/// What is the same for a light whoever asks.
struct LightTraits {
  bool is_delta = false;  ///< a single point or direction
  /// Lights nothing: DistantLight::background() is only for rays that leave the scene straight from
  /// the camera or after delta events.
  bool is_only_seen = false;
  bool is_two_sided = false;  ///< both sides of its surface shine
  int shape = -1;             ///< index into the scene's shapes if it is an area light, else −1
  int beam_shape = -1;        ///< the same of a distant light that begins at a shape, see below
  /// Most shadow rays for one sample of the light at recursion level 0: where some arrive and some
  /// don't, up to so many are worth their time. 1: one always does.
  int shadow_samples = 1;
  /// Total emitted flux in RGB mode, W. Of distant lights that through the scene's bounding disk.
  Spectrum power;
  LightBounds bounds;
  /// A ball that tells about the same as Light::expected_irradiance(), and is zero no earlier: many
  /// are asked at once. Distant lights have none.
  std::optional<EmissionBall> ball;
  /// In classical ray tracing. Photons, and everything else that is physical, ignore it.
  ClassicalAttenuation attenuation;

  /// Whether it is a beam: emitted rays begin on a shape, and points outside of the beam get none.
  bool is_beam() const { return beam_shape >= 0; }
  /// The shape that it shines from; −1: none.
  int surface() const { return shape >= 0 ? shape : beam_shape; }
};

class PlacedLight;
class DistantLight;

/// A source of light, of one of two families: it has a place (PlacedLight), or it shines from
/// infinity, or as if it did (DistantLight). Immutable. Emission is one-sided on surfaces (the side
/// of the geometric normal), as in Mitsuba.
class Light {
 public:
  virtual ~Light() = default;

  const LightTraits& traits() const { return traits_; }
  bool is_infinite() const { return family_ == Family::distant; }
  /// Only if is_infinite() says so.
  const DistantLight& distant() const;
  /// Only if it does not.
  const PlacedLight& placed() const;

  /// Estimate of the irradiance that the light gives the queried point without shadows, on the
  /// normal's side (facing the light where there is no normal); W/m², sum of the lanes in RGB mode.
  /// What samples are shared out by: zero only where no light can arrive, and rather too high than
  /// too low. This is the thesis's brightness times projection.
  virtual float expected_irradiance(const LightQuery& query) const = 0;
  virtual LightSample sample_toward(const LightQuery& query, const Vec2f& u) const = 0;
  /// Density of sample_toward, per solid angle. Zero of lights that no ray meets.
  virtual float pdf_toward(const LightQuery& query, const LightTarget& target) const = 0;

  /// What leaves `point` along unit `direction`. Surfaces: radiance, zero on a side that does not
  /// shine (balls without one: with the cosine applied). Points: intensity, W/sr. Distant lights,
  /// whatever the point: what travels along `direction`, radiance (environment) or irradiance
  /// across it (directional, whose only direction it must be).
  virtual Spectrum emitted(const SurfacePoint& point, const Vec3f& direction,
                           const Wavelengths& wavelengths) const = 0;
  virtual EmissionSample sample_emission(const Vec2f& u_position, const Vec2f& u_direction,
                                         const Wavelengths& wavelengths) const = 0;
  /// Density of sample_emission's position, per area (see EmissionSample::pdf_position).
  virtual float emission_pdf_position(const SurfacePoint& point) const = 0;
  /// Density of sample_emission's direction at `point`, per solid angle.
  virtual float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const = 0;

 protected:
  enum class Family : uint8_t { placed, distant };
  explicit Light(Family family) : family_(family) {}

  LightTraits traits_;  ///< complete once the constructors are done

 private:
  Family family_;
};

/// A light with a place: a point, a surface, a ball. Emission is a position on it, then a
/// direction; aimed emission draws the direction by itself.
class PlacedLight : public Light {
 public:
  /// Uniform by area on the light; `ng` zero and pdf 1 for points. The direction, its density and
  /// the flux stay zero.
  virtual EmissionSample sample_origin(const Vec2f& u) const = 0;
  /// Of the surface that the density of a point on the light is over.
  virtual Vec3f emitting_normal(const SurfacePoint& point) const { return point.ng; }

 protected:
  PlacedLight() : Light(Family::placed) {}
};

/// A direction in which light travels, with its density per solid angle (1 where there is only one;
/// 0: none).
struct TravelDirection {
  Vec3f direction{0, 0, 1};
  float pdf = 0;
};

/// A light at infinity: a direction or an environment. Emission is a direction of travel, then an
/// origin on the plane across it. A beam from a flat shape is one, too: light that comes from a
/// single direction falls off with no distance, wherever it begins.
class DistantLight : public Light {
 public:
  /// Radiance of rays that leave the scene along `direction`; zero where none meets the light.
  virtual Spectrum background(const Vec3f& direction, const Wavelengths& wavelengths) const = 0;
  virtual TravelDirection sample_travel_direction(const Vec2f& u) const = 0;

 protected:
  DistantLight() : Light(Family::distant) {}
};

inline const DistantLight& Light::distant() const {
  assert(is_infinite());
  return static_cast<const DistantLight&>(*this);
}
inline const PlacedLight& Light::placed() const {
  assert(!is_infinite());
  return static_cast<const PlacedLight&>(*this);
}

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
  /// Where a light finds the tables that an equal emitter has made of its arguments alone, and
  /// leaves its own for others: see shared_tables(). Null: nobody shares.
  std::shared_ptr<const void>* tables = nullptr;
};

/// The tables that were left for this light; those that `make` makes where there are none.
template <typename Tables, typename Make>
std::shared_ptr<const Tables> shared_tables(const LightInputs& inputs, const Make& make) {
  if (inputs.tables && *inputs.tables)
    return std::static_pointer_cast<const Tables>(*inputs.tables);
  std::shared_ptr<const Tables> made = make();
  if (inputs.tables) *inputs.tables = made;
  return made;
}

struct LightType {
  const TypeInfo& info;
  bool needs_shape = false;
  /// Throws Error where arguments contradict one another, or the shape cannot be a light.
  std::unique_ptr<Light> (*create)(const LightInputs&);
  /// A texture in it is a factor on its light: white changes no colour, whatever is rendered.
  bool pattern_is_factor = false;
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
  /// `lights`, of whatever pointers, must outlive this.
  template <typename Pointer>
  explicit LightSelector(const std::vector<Pointer>& lights) : LightSelector() {
    std::vector<const Light*> plain;
    for (const auto& light : lights) plain.push_back(&*light);
    build(plain);
  }
  ~LightSelector();
  /// The same tables for the same lights, without what has been learned.
  std::unique_ptr<LightSelector> unlearned_copy() const;

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
  LightSelector();
  void build(const std::vector<const Light*>& lights);

  std::unique_ptr<Impl> impl_;
  std::optional<Choice> only_choice_;
};

}  // namespace kaustik
