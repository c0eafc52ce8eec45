#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "kaustik/material/relief.h"
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

/// What a bsdf asks of the surface at a point, as bits; finding it costs time.
enum class SurfaceNeeds : uint8_t {
  none = 0,
  texture = 1,  ///< BsdfContext::texture() with its footprint
  tangent = 2,  ///< a frame whose x axis lies along u
  relief = 4    ///< the normal of Bsdf::relief
};
constexpr SurfaceNeeds operator|(SurfaceNeeds a, SurfaceNeeds b) {
  return SurfaceNeeds(uint8_t(a) | uint8_t(b));
}
constexpr bool needs(SurfaceNeeds all, SurfaceNeeds one) {
  return (uint8_t(all) & uint8_t(one)) != 0;
}
/// Of a bsdf that looks up these textures.
inline SurfaceNeeds texture_needs(std::initializer_list<const Texture*> textures) {
  for (const Texture* texture : textures)
    if (!texture->is_constant()) return SurfaceNeeds::texture;
  return SurfaceNeeds::none;
}

/// What is the same for a bsdf wherever it is asked; so whoever holds one need not ask it.
struct BsdfTraits {
  Lobes lobes = Lobes::none;  ///< the parts that it has
  bool transmits = false;     ///< whether light can pass through
  /// Whether it is the boundary that light does not notice: paths and shadow rays go straight on,
  /// without an event. Such a bsdf has no lobes.
  bool is_null = false;
  /// Whether Bsdf::straight() may be more than nothing.
  bool passes_straight = false;
  /// Whether the diffuse lobe has one value for all pairs of directions on each side (Lambert).
  bool is_lambertian = true;
  SurfaceNeeds needs = SurfaceNeeds::none;  ///< of the surface, beside directions
  /// How many bsdfs an answer of eval() asks at most, itself included; one that is nested in
  /// several places counts for each of them.
  int size = 1;
};

/// What a bsdf needs to know of the point beside directions. Remembers what textures gave there,
/// since one point is asked for its albedo, for directions and for values; so it belongs to one
/// thread.
class BsdfContext {
 public:
  BsdfContext() = default;
  BsdfContext(const TextureCoordinates& texture, TransportMode transport_mode,
              const Wavelengths& wavelengths)
      : mode(transport_mode), texture_(texture), wavelengths_(wavelengths) {}

  const TextureCoordinates& texture() const { return texture_; }
  /// Of the light that is asked about.
  const Wavelengths& wavelengths() const { return wavelengths_; }
  void move_to(const TextureCoordinates& texture, const Wavelengths& wavelengths) {
    texture_ = texture;
    wavelengths_ = wavelengths;
    known_ = 0;
    known_numbers_ = 0;
  }
  /// What the texture gives there as a colour …
  Spectrum value_of(const Texture& texture) const {
    return remembered(&texture, 0, [&] { return texture.eval(texture_, wavelengths_); });
  }
  /// … and as one number.
  float scalar_of(const Texture& texture) const {
    return remembered(&texture, 1, [&] { return Spectrum(texture.scalar(texture_)); })[0];
  }
  /// A number that a bsdf finds for the point, with much work, whatever the directions; `key` is
  /// the address of something of its own. Textures, however many, don't crowd it out.
  template <typename Ask>
  float number_of(const void* key, const Ask& ask) const {
    for (size_t i = 0; i < known_numbers_; ++i)
      if (number_keys_[i] == key) return numbers_[i];
    const float number = ask();
    if (known_numbers_ < numbers_.size()) {
      number_keys_[known_numbers_] = key;
      numbers_[known_numbers_++] = number;
    }
    return number;
  }

  TransportMode mode = TransportMode::radiance;

 private:
  /// `question` tells apart what one object is asked.
  template <typename Ask>
  Spectrum remembered(const void* object, uintptr_t question, const Ask& ask) const {
    const uintptr_t key = reinterpret_cast<uintptr_t>(object) | question;
    for (size_t i = 0; i < known_; ++i)
      if (keys_[i] == key) return values_[i];
    const Spectrum value = ask();
    if (known_ < values_.size()) {
      keys_[known_] = key;
      values_[known_++] = value;
    }
    return value;
  }

  TextureCoordinates texture_;
  Wavelengths wavelengths_;
  mutable size_t known_ = 0;
  mutable std::array<uintptr_t, 8> keys_{};
  mutable std::array<Spectrum, 8> values_{};
  mutable size_t known_numbers_ = 0;
  mutable std::array<const void*, 4> number_keys_{};
  mutable std::array<float, 4> numbers_{};
};

/// A direction that a bsdf has chosen. The event is drawn by the shares of the lobes in f at wi,
/// not by which lobe proposed it, so contributions can be told apart by it: over all samples the
/// mean of `weight` where `event` is e is the integral of f_e·|cosθ_i|, and the mean of all is that
/// of f. With one lobe asked for, `weight` is f·|cosθ_i|/pdf exactly.
struct BsdfSample {
  Vec3f wi;         ///< local frame, unit
  Spectrum weight;  ///< f·|cosθ_i| of the event / density; for delta lobes factor over chance
  float pdf_solid_angle =
      0;  ///< of wi over all the lobes asked for; of delta lobes the chance alone
  Lobes event = Lobes::none;  ///< exactly one of diffuse, glossy, delta; none: absorbed
  bool transmission = false;
  float eta = 1;  ///< n_transmitted/n_incident across the event; 1 for reflection
  /// The only lane that goes on, since each has a direction of its own (Wavelengths::only); the
  /// weight of the others is zero, and that of this one makes up for them. −1: all go on.
  int only_lane = -1;
};

/// What paths ask that are completed at a point: f of both lobes without the cosine, 1/sr, and the
/// densities per solid angle with which sample() finds wi, given wo, and wo, given wi.
struct BsdfValues {
  Spectrum diffuse, glossy;
  float pdf = 0, pdf_reverse = 0;

  friend bool operator==(const BsdfValues&, const BsdfValues&) = default;
  /// Of f, the sum over the lanes; 0 where f is black.
  float glossy_share() const {
    const float of_glossy = glossy.sum(), of_both = of_glossy + diffuse.sum();
    return of_both > 0 ? of_glossy / of_both : 0.0f;
  }
  /// Of one of the two lobes.
  const Spectrum& of(Lobes lobe) const { return lobe == Lobes::diffuse ? diffuse : glossy; }
};

/// How light scatters at a point of a surface. Local frame: z is the shading normal; wo (known) and
/// wi (asked for) point away from the surface. Immutable, thread-safe. `lobes` restricts every
/// answer to those parts; delta lobes are sampled, never evaluated (eval and pdf give zero).
class Bsdf {
 public:
  explicit Bsdf(const BsdfTraits& traits) : traits_(traits) {}
  virtual ~Bsdf() = default;
  const BsdfTraits& traits() const { return traits_; }
  /// f, 1/sr, without the cosine.
  virtual Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                        Lobes lobes) const = 0;
  /// Share of the light along wo that goes straight on, as if there were no surface: through holes
  /// and thin panes. It is no event, so shadow rays see it, and all other answers leave it out.
  virtual Spectrum straight(const BsdfContext& context, const Vec3f& wo) const {
    (void)context, (void)wo;
    return Spectrum();
  }
  /// What bends the normal of the side that is seen (`front`: the one that the geometric normal
  /// points to); null: nothing.
  virtual const Relief* relief(bool front) const {
    (void)front;
    return nullptr;
  }
  /// Density per solid angle with which sample() finds wi.
  virtual float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                    Lobes lobes) const = 0;
  /// What eval() and pdf() tell of all lobes, both ways, at once: merging asks for it millions of
  /// times. Worth its own code where the parts have much in common.
  virtual BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const {
    return {eval(context, wo, wi, Lobes::diffuse), eval(context, wo, wi, Lobes::glossy),
            pdf(context, wo, wi, Lobes::all), pdf(context, wi, wo, Lobes::all)};
  }
  /// The same of many directions, one after the other; `wi` may be written over. Worth its own code
  /// where something is the same for all.
  virtual void all_values(const BsdfContext& context, const Vec3f& wo, std::span<Vec3f> wi,
                          std::span<BsdfValues> result) const {
    for (size_t i = 0; i < wi.size(); ++i) result[i] = values(context, wo, wi[i]);
  }
  /// `u_lobe` chooses the lobe, `u` the direction. A weight of zero means absorbed.
  virtual BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe,
                            const Vec2f& u, Lobes lobes) const = 0;
  /// Share of the light from wo that the lobes scatter (directional albedo), exact for diffuse and
  /// delta lobes, an estimate within a few percent for glossy ones; ten of textured layers. At most
  /// 1 unless a texture is over 1; an energy, so the transport mode makes no difference.
  virtual Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const = 0;

 private:
  BsdfTraits traits_;
};

/// The largest size that a scene may use. Bsdfs that share nested ones double it at each level,
/// so a few lines of a scene file could ask for more than ever ends.
inline constexpr int maximum_bsdf_size = 256;

/// Ideally matt on its outer side and white: f = 1/π.
const Bsdf& white_diffuse();

/// The smooth boundary of two transparent materials by their indices of refraction; +z is the
/// exterior. The textures are factors on what is reflected and transmitted.
std::shared_ptr<const Bsdf> make_dielectric(const SpectralValue& interior,
                                            const SpectralValue& exterior,
                                            std::shared_ptr<const Texture> reflectance,
                                            std::shared_ptr<const Texture> transmittance);

/// What create() of a bsdf gets beside its arguments: its nested bsdfs and textures, built already.
struct BsdfInputs {
  const Arguments& arguments;
  /// In the order of the file.
  std::vector<std::shared_ptr<const Bsdf>> nested;
  TextureOfParameter texture;
  /// Tells the user, once per message, what is not quite as the scene asks for.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
  bool is_strict = false;  ///< what could do with a warning is an error
};

struct BsdfType {
  const TypeInfo& info;
  int minimum_nested = 0, maximum_nested = 0;
  /// Throws Error(input) where arguments contradict one another.
  std::shared_ptr<const Bsdf> (*create)(const BsdfInputs&);
};
/// What a `textured()` parameter gives where no texture stands instead; null where it has no value.
std::shared_ptr<const Texture> constant_texture_of(const Arguments& arguments,
                                                   std::string_view name);

/// "diffuse", "roughdiffuse", "phong", "thinphong", "ward", "difftrans", "dielectric",
/// "roughdielectric", "thindielectric", "conductor", "roughconductor", "plastic", "roughplastic",
/// "pplastic", "principled", "principledthin", "openpbr", "twosided", "mask", "blendbsdf",
/// "mixturebsdf", "coating", "roughcoating", "bumpmap", "normalmap", "null".
const std::vector<BsdfType>& bsdf_types();

/// What to do about a type of Mitsuba's that is still to be built; empty if it is no such type.
std::string_view remedy_for_bsdf_to_come(std::string_view type);

}  // namespace kaustik
