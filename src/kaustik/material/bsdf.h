#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "kaustik/material/texture.h"

namespace kaustik {

/// Parts of a bsdf, as bits. Photon maps ask for the diffuse and for the specular part apart.
enum class Lobes : uint8_t { none = 0, diffuse = 1, glossy = 2, delta = 4, specular = 6, all = 7 };
constexpr Lobes operator&(Lobes a, Lobes b) { return Lobes(uint8_t(a) & uint8_t(b)); }
constexpr Lobes operator|(Lobes a, Lobes b) { return Lobes(uint8_t(a) | uint8_t(b)); }
constexpr bool any(Lobes lobes) { return lobes != Lobes::none; }

/// What travels along the path: radiance on paths from the camera, flux (importance's adjoint) on
/// paths from lights. Refraction scales radiance by (n_incident/n_transmitted)² but not flux.
enum class TransportMode : uint8_t { radiance, flux };

/// What a bsdf needs to know of the point beside directions.
struct BsdfContext {
  TextureCoordinates texture;
  TransportMode mode = TransportMode::radiance;
};

struct BsdfSample {
  Vec3f wi;         ///< local frame, unit
  Spectrum weight;  ///< f·|cosθ_i| / density; for delta lobes their factor over the chance
  float pdf_solid_angle =
      0;  ///< of wi over all the lobes asked for; of delta lobes the chance alone
  Lobes event = Lobes::none;  ///< exactly one of diffuse, glossy, delta; none: absorbed
  bool transmission = false;
  float eta = 1;  ///< n_transmitted/n_incident across the event; 1 for reflection
};

/// How light scatters at a point of a surface. Local frame: z is the shading normal; wo (known) and
/// wi (asked for) point away from the surface. Immutable, thread-safe. `lobes` restricts every
/// answer to those parts; delta lobes are sampled, never evaluated (eval and pdf give zero).
class Bsdf {
 public:
  virtual ~Bsdf() = default;
  /// The parts that it has.
  virtual Lobes lobes() const = 0;
  /// Whether light can pass through.
  virtual bool transmits() const { return false; }
  /// f, 1/sr, without the cosine.
  virtual Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                        Lobes lobes) const = 0;
  /// Density per solid angle with which sample() finds wi.
  virtual float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                    Lobes lobes) const = 0;
  /// `u_lobe` chooses the lobe, `u` the direction. A weight of zero means absorbed.
  virtual BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe,
                            const Vec2f& u, Lobes lobes) const = 0;
  /// Share of the light from wo that the lobes scatter (directional albedo), exact for diffuse and
  /// delta lobes, an estimate within a few percent for glossy ones. At most 1.
  virtual Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const = 0;
};

/// The null bsdf of open boundaries is none of these: a shape without a bsdf is diffuse 0.5, as in
/// Mitsuba.

/// What create() of a bsdf gets beside its arguments: its nested bsdfs and textures, built already.
struct BsdfInputs {
  const Arguments& arguments;
  /// In the order of the file.
  std::vector<std::shared_ptr<const Bsdf>> nested;
  /// The texture for a `textured()` color parameter: the nested one if there is one, else a
  /// constant one from the argument.
  std::function<std::shared_ptr<const Texture>(std::string_view)> texture;
};

struct BsdfType {
  const TypeInfo& info;
  int minimum_nested = 0, maximum_nested = 0;
  /// Throws Error where arguments contradict one another.
  std::shared_ptr<const Bsdf> (*create)(const BsdfInputs&);
};
/// "diffuse", "phong", "dielectric", "conductor", "roughconductor", "twosided".
const std::vector<BsdfType>& bsdf_types();

}  // namespace kaustik
