#include <array>

#include "kaustik/base/warp.h"
#include "kaustik/material/albedo_table.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/energy_scale.h"
#include "kaustik/material/lobe_event.h"

namespace kaustik {
namespace {

using TexturePointer = std::shared_ptr<const Texture>;

/// Shares of the light that is reflected and transmitted, and by which lobe.
struct PhongTextures {
  TexturePointer diffuse_reflectance, glossy_reflectance;
  TexturePointer diffuse_transmittance, glossy_transmittance;
  TexturePointer exponent;

  std::array<const Texture*, 4> reflecting_and_transmitting() const {
    return {diffuse_reflectance.get(), glossy_reflectance.get(), diffuse_transmittance.get(),
            glossy_transmittance.get()};
  }
  SurfaceNeeds needs() const {
    const auto t = reflecting_and_transmitting();
    return texture_needs({t[0], t[1], t[2], t[3], exponent.get()});
  }
};

constexpr float largest_exponent = 1e5f;

/// cosⁿα from the distance to the lobe's middle, which keeps its precision at high exponents.
float cos_power(const Vec3f& middle, const Vec3f& wi, float exponent) {
  const float half_distance_sq = 0.5f * length_sq(wi - middle);
  // Below e⁻⁹⁰ floats are denormal or 0, for which libm takes its time.
  constexpr float most_exponent = 90;
  if (half_distance_sq >= 1 || exponent * half_distance_sq > most_exponent) return 0;
  return std::exp(exponent * std::log1p(-half_distance_sq));
}

/// About `middle` with density (n + 1)/(2π) cosⁿα; may lie beyond the horizon.
Vec3f sample_lobe(const Vec3f& middle, float exponent, const Vec2f& u) {
  const float log_cos = std::log(1 - u.x) / (exponent + 1);
  const float cos_alpha = std::exp(log_cos), sin_alpha = safe_sqrt(-std::expm1(2 * log_cos));
  const float phi = 2 * pi * u.y;
  return Frame(middle).to_world({sin_alpha * std::cos(phi), sin_alpha * std::sin(phi), cos_alpha});
}

/// The modified Phong model of Lafortune and Willems, "Using the Modified Phong Reflectance Model
/// for Physically Based Rendering" (1994): f = k_d/π + k_s (n + 2)/(2π) cosⁿα with α the angle to
/// the mirror direction. A thin sheet has the corresponding BTDF, the same with factors of its own
/// and α the angle to −wo, the direction in which light goes on through a sheet; both its sides
/// are alike. Reciprocal, loses light only at the horizon. What is no sheet is black from behind.
class Phong final : public Bsdf {
 public:
  /// `scale` goes into all factors.
  Phong(PhongTextures textures, float scale, bool is_sheet)
      : Bsdf({.lobes = lobes_of(textures, is_sheet),
              .transmits = is_sheet,
              .needs = textures.needs()}),
        textures_(std::move(textures)),
        scale_(scale),
        is_sheet_(is_sheet),
        lobe_albedo_(textures_.exponent->is_constant() ? log_exponent(BsdfContext()) : 0,
                     textures_.exponent->is_constant() ? log_exponent(BsdfContext())
                                                       : log_of(textures_.exponent->maximum()),
                     true, [](float log_n, const Vec3f& wo, const Vec2f& u) {
                       const float n = std::exp2(log_n) - 1;
                       const Vec3f wi = sample_lobe(mirrored(wo), n, u);
                       return Spectrum(wi.z > 0 ? wi.z * (n + 2) / (n + 1) : 0.0f);
                     }) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (!is_possible(wo, wi)) return Spectrum();
    const Factors k = factors(context, lobes);
    const Parts f = parts_of(k, wo.z * wi.z < 0, power_of(k, wo, wi));
    return f.diffuse + f.glossy;
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    if (!is_possible(wo, wi)) return 0;
    const Factors k = factors(context, lobes);
    return pdf_of(k, wo.z * wi.z < 0, wi.z, power_of(k, wo, wi));
  }

  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return values_by(factors(context, Lobes::all), wo, wi);
  }

  void all_values(const BsdfContext& context, const Vec3f& wo, std::span<Vec3f> wi,
                  std::span<BsdfValues> result) const override {
    const Factors k = factors(context, Lobes::all);
    for (size_t i = 0; i < wi.size(); ++i) result[i] = values_by(k, wo, wi[i]);
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    const Factors k = factors(context, lobes);
    if (wo.z == 0 || (!is_sheet_ && wo.z < 0)) return {};
    int proposal = -1;
    for (int i = 0; i < 4; ++i) {
      if (!(k.chance[size_t(i)] > 0)) continue;
      proposal = i;
      if (u_lobe < k.chance[size_t(i)]) break;
      u_lobe -= k.chance[size_t(i)];
    }
    if (proposal < 0) return {};
    const Vec3f wi = propose(proposal, wo, k.exponent, u);
    const bool transmission = wi.z * wo.z < 0;
    if (wi.z == 0 || transmission != (proposal >= 2)) return {};
    const float power = power_of(k, wo, wi);
    const float pdf = pdf_of(k, transmission, wi.z, power);
    // What is left of u_lobe is uniform again and tells the event.
    const float rest = std::min(u_lobe / k.chance[size_t(proposal)], one_minus_epsilon);
    const Parts f = parts_of(k, transmission, power);
    return sample_with_event(wi, f.diffuse, f.glossy, pdf, transmission, rest);
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z == 0 || (!is_sheet_ && wo.z < 0)) return Spectrum();
    const Factors k = factors(context, lobes);
    const Spectrum lobe = lobe_albedo_(log_of(k.exponent), {wo.x, wo.y, std::fabs(wo.z)});
    return k.factor[0] + k.factor[2] + (k.factor[1] + k.factor[3]) * lobe;
  }

 private:
  /// The factors of the lobes asked for, in the order of PhongTextures, and the chances with which
  /// these are sampled.
  struct Factors {
    std::array<Spectrum, 4> factor;
    std::array<float, 4> chance{};
    float exponent = 0;
  };
  struct Parts {
    Spectrum diffuse, glossy;
  };

  /// A lobe of pure white noughts is none: a matt sheet needs no light samples for gloss.
  static Lobes lobes_of(const PhongTextures& textures, bool is_sheet) {
    if (!is_sheet) return Lobes::diffuse | Lobes::glossy;
    Lobes lobes = Lobes::none;
    for (int i = 0; i < 4; ++i)
      if (textures.reflecting_and_transmitting()[size_t(i)]->maximum() > 0)
        lobes = lobes | (i % 2 ? Lobes::glossy : Lobes::diffuse);
    return lobes;
  }

  static Vec3f mirrored(const Vec3f& w) { return {-w.x, -w.y, w.z}; }
  static float log_of(float exponent) { return std::log2(1 + exponent); }
  float log_exponent(const BsdfContext& context) const { return log_of(exponent_at(context)); }
  float exponent_at(const BsdfContext& context) const {
    return std::clamp(context.scalar_of(*textures_.exponent), 0.0f, largest_exponent);
  }

  bool is_possible(const Vec3f& wo, const Vec3f& wi) const {
    return is_sheet_ ? wo.z * wi.z != 0 : wo.z > 0 && wi.z > 0;
  }

  Factors factors(const BsdfContext& context, Lobes lobes) const {
    Factors k;
    k.exponent = exponent_at(context);
    float total = 0;
    const auto textures = textures_.reflecting_and_transmitting();
    for (size_t i = 0; i < 4; ++i) {
      if (!any(lobes & (i % 2 ? Lobes::glossy : Lobes::diffuse))) continue;
      k.factor[i] = context.value_of(*textures[i]) * scale_;
      total += k.chance[i] = k.factor[i].sum();
    }
    if (total > 0)
      for (float& chance : k.chance) chance /= total;
    return k;
  }

  BsdfValues values_by(const Factors& k, const Vec3f& wo, const Vec3f& wi) const {
    if (!is_possible(wo, wi)) return {};
    const bool through = wo.z * wi.z < 0;
    const float power = power_of(k, wo, wi);  // the same both ways
    const Parts f = parts_of(k, through, power);
    return {f.diffuse, f.glossy, pdf_of(k, through, wi.z, power), pdf_of(k, through, wo.z, power)};
  }

  static Vec3f propose(int proposal, const Vec3f& wo, float exponent, const Vec2f& u) {
    if (proposal == 1) return sample_lobe(mirrored(wo), exponent, u);
    if (proposal == 3) return sample_lobe(-wo, exponent, u);
    const Vec3f wi = square_to_cosine_hemisphere(u);
    return (wo.z > 0) == (proposal == 0) ? wi : Vec3f(wi.x, wi.y, -wi.z);
  }

  /// cosⁿα; 0 where there is no glossy lobe.
  static float power_of(const Factors& k, const Vec3f& wo, const Vec3f& wi) {
    const bool through = wo.z * wi.z < 0;
    if (!(k.chance[through ? 3 : 1] > 0)) return 0;
    return cos_power(through ? -wo : mirrored(wo), wi, k.exponent);
  }

  static Parts parts_of(const Factors& k, bool through, float power) {
    return {k.factor[through ? 2 : 0] * inv_pi,
            k.factor[through ? 3 : 1] * ((k.exponent + 2) * 0.5f * inv_pi * power)};
  }

  /// Density of a direction with that cosine to the normal.
  static float pdf_of(const Factors& k, bool through, float cosine, float power) {
    return k.chance[through ? 2 : 0] * std::fabs(cosine) * inv_pi +
           k.chance[through ? 3 : 1] * (k.exponent + 1) * 0.5f * inv_pi * power;
  }

  PhongTextures textures_;
  float scale_;
  bool is_sheet_;
  AlbedoTables lobe_albedo_;
};

Parameter exponent_parameter() {
  return number_parameter("exponent", 30, "Sharpness of the highlight.")
      .range(0, double(largest_exponent))
      .clamped()
      .textured();
}

const TypeInfo& phong_info() {
  static const TypeInfo info{
      "bsdf",
      "phong",
      "Matt surface with a glossy highlight (modified Phong); black seen from behind.",
      {color_parameter("diffuse_reflectance", 0.5, "Fraction of light that is reflected diffusely.")
           .range(0, 1)
           .textured(),
       color_parameter("specular_reflectance", 0.2, "Fraction of light in the highlight.")
           .range(0, 1)
           .textured(),
       exponent_parameter()}};
  return info;
}

const TypeInfo& thinphong_info() {
  static const TypeInfo info{
      "bsdf",
      "thinphong",
      "Thin sheet with two equal sides, such as paper, cloth or frosted glass. It reflects and "
      "transmits by the modified Phong model.",
      {color_parameter("diffuse_reflectance", 0.4, "Fraction of light that is reflected diffusely.")
           .range(0, 1)
           .textured(),
       color_parameter("specular_reflectance", 0,
                       "Fraction of light that is reflected around the mirror direction.")
           .range(0, 1)
           .textured(),
       color_parameter("diffuse_transmittance", 0.4,
                       "Fraction of light that is transmitted diffusely.")
           .range(0, 1)
           .textured(),
       color_parameter("specular_transmittance", 0,
                       "Fraction of light that is transmitted around the straight direction.")
           .range(0, 1)
           .textured(),
       exponent_parameter()}};
  return info;
}

const TypeInfo& difftrans_info() {
  static const TypeInfo info{
      "bsdf",
      "difftrans",
      "Thin sheet that transmits light diffusely and reflects nothing.",
      {color_parameter("transmittance", 0.5, "Fraction of light that is transmitted.")
           .range(0, 1)
           .textured()}};
  return info;
}

std::shared_ptr<const Bsdf> make(PhongTextures textures, const Arguments& arguments,
                                 bool is_sheet) {
  const auto factors = textures.reflecting_and_transmitting();
  const float scale = energy_scale({factors.begin(), factors.end()}, arguments);
  return std::make_shared<Phong>(std::move(textures), scale, is_sheet);
}

TexturePointer black() { return make_constant_texture(SpectralValue()); }

std::shared_ptr<const Bsdf> create_phong(const BsdfInputs& inputs) {
  return make({inputs.texture("diffuse_reflectance"), inputs.texture("specular_reflectance"),
               black(), black(), inputs.texture("exponent")},
              inputs.arguments, false);
}

std::shared_ptr<const Bsdf> create_thinphong(const BsdfInputs& inputs) {
  return make({inputs.texture("diffuse_reflectance"), inputs.texture("specular_reflectance"),
               inputs.texture("diffuse_transmittance"), inputs.texture("specular_transmittance"),
               inputs.texture("exponent")},
              inputs.arguments, true);
}

std::shared_ptr<const Bsdf> create_difftrans(const BsdfInputs& inputs) {
  return make({black(), black(), inputs.texture("transmittance"), black(),
               make_constant_texture(SpectralValue(1.0f))},
              inputs.arguments, true);
}

}  // namespace

BsdfType phong_type() { return {phong_info(), 0, 0, create_phong}; }
BsdfType thinphong_type() { return {thinphong_info(), 0, 0, create_thinphong}; }
BsdfType difftrans_type() { return {difftrans_info(), 0, 0, create_difftrans}; }

}  // namespace kaustik
