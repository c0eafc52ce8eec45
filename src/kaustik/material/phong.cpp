#include <fmt/format.h>

#include "kaustik/base/warp.h"
#include "kaustik/material/albedo_table.h"
#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// The modified Phong model of Lafortune and Willems, "Using the Modified Phong Reflectance Model
/// for Physically Based Rendering" (1994): f = k_d/π + k_s (n + 2)/(2π) cosⁿα with α the angle to
/// the mirror direction. Reciprocal, loses light only at the horizon; black from behind.
class Phong final : public Bsdf {
 public:
  /// `scale` goes into both reflectances.
  Phong(std::shared_ptr<const Texture> diffuse, std::shared_ptr<const Texture> specular,
        float exponent, float scale)
      : diffuse_(std::move(diffuse)),
        specular_(std::move(specular)),
        exponent_(exponent),
        scale_(scale),
        lobe_albedo_(true, [this](const Vec3f& wo, const Vec2f& u) {
          const Vec3f wi = sample_lobe(wo, u);
          return Spectrum(wi.z > 0 ? wi.z * (exponent_ + 2) / (exponent_ + 1) : 0.0f);
        }) {}

  Lobes lobes() const override { return Lobes::diffuse | Lobes::glossy; }

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    if (wo.z <= 0 || wi.z <= 0) return Spectrum();
    const Parts f = parts_of(factors(context, lobes), cos_power(wo, wi));
    return f.diffuse + f.glossy;
  }

  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    return pdf_of(factors(context, lobes), wi.z, cos_power(wo, wi));
  }

  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    BsdfSample sample;
    const Factors k = factors(context, lobes);
    if (wo.z <= 0 || !(k.diffuse_chance + k.glossy_chance > 0)) return sample;
    const bool by_diffuse = u_lobe < k.diffuse_chance;
    const Vec3f wi = by_diffuse ? square_to_cosine_hemisphere(u) : sample_lobe(wo, u);
    if (wi.z <= 0) return sample;
    const float power = cos_power(wo, wi);
    const float pdf = pdf_of(k, wi.z, power);
    if (!(pdf > 0)) return sample;
    // What is left of u_lobe is uniform again and tells the event by the shares in f.
    const float rest =
        by_diffuse ? u_lobe / k.diffuse_chance : (u_lobe - k.diffuse_chance) / k.glossy_chance;
    const Parts f = parts_of(k, power);
    const float diffuse_share = f.diffuse.sum() / (f.diffuse.sum() + f.glossy.sum());
    const bool is_diffuse = rest < diffuse_share;
    sample.wi = wi;
    sample.pdf_solid_angle = pdf;
    sample.event = is_diffuse ? Lobes::diffuse : Lobes::glossy;
    sample.weight = is_diffuse ? f.diffuse * (wi.z / (pdf * diffuse_share))
                               : f.glossy * (wi.z / (pdf * (1 - diffuse_share)));
    return sample;
  }

  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (wo.z <= 0) return Spectrum();
    const Factors k = factors(context, lobes);
    return k.diffuse + k.glossy * lobe_albedo_(wo);
  }

 private:
  /// k_d and k_s of the lobes asked for, and the chances with which these are sampled.
  struct Factors {
    Spectrum diffuse, glossy;
    float diffuse_chance = 0, glossy_chance = 0;
  };
  struct Parts {
    Spectrum diffuse, glossy;
  };

  Factors factors(const BsdfContext& context, Lobes lobes) const {
    Factors k;
    if (any(lobes & Lobes::diffuse)) k.diffuse = diffuse_->eval(context.texture) * scale_;
    if (any(lobes & Lobes::glossy)) k.glossy = specular_->eval(context.texture) * scale_;
    const float diffuse = k.diffuse.sum(), glossy = k.glossy.sum();
    if (!(diffuse + glossy > 0)) return k;
    k.diffuse_chance = diffuse / (diffuse + glossy);
    k.glossy_chance = glossy / (diffuse + glossy);
    return k;
  }

  /// cosⁿα from the distance to the mirror direction, which keeps its precision at high exponents.
  float cos_power(const Vec3f& wo, const Vec3f& wi) const {
    const float half_distance_sq = 0.5f * length_sq(wi - Vec3f(-wo.x, -wo.y, wo.z));
    if (half_distance_sq >= 1) return 0;
    return std::exp(exponent_ * std::log1p(-half_distance_sq));
  }

  Parts parts_of(const Factors& k, float power) const {
    return {k.diffuse * inv_pi, k.glossy * ((exponent_ + 2) * 0.5f * inv_pi * power)};
  }

  float pdf_of(const Factors& k, float cos_i, float power) const {
    return k.diffuse_chance * cos_i * inv_pi +
           k.glossy_chance * (exponent_ + 1) * 0.5f * inv_pi * power;
  }

  /// About the mirror direction with density (n + 1)/(2π) cosⁿα; may lie below the horizon.
  Vec3f sample_lobe(const Vec3f& wo, const Vec2f& u) const {
    const float log_cos = std::log(1 - u.x) / (exponent_ + 1);
    const float cos_alpha = std::exp(log_cos), sin_alpha = safe_sqrt(-std::expm1(2 * log_cos));
    const float phi = 2 * pi * u.y;
    return Frame(Vec3f(-wo.x, -wo.y, wo.z))
        .to_world({sin_alpha * std::cos(phi), sin_alpha * std::sin(phi), cos_alpha});
  }

  std::shared_ptr<const Texture> diffuse_, specular_;
  float exponent_;
  float scale_;
  AlbedoTable lobe_albedo_;
};

const TypeInfo& info() {
  static const TypeInfo info{
      "bsdf",
      "phong",
      "Matt surface with a glossy highlight (modified Phong); black seen from behind.",
      {color_parameter("diffuse_reflectance", 0.5, "Share of the light that is scattered evenly.")
           .range(0, 1)
           .textured(),
       color_parameter("specular_reflectance", 0.2, "Share of the light in the highlight.")
           .range(0, 1)
           .textured(),
       number_parameter("exponent", 30, "Sharpness of the highlight.").range(0, 1e5)}};
  return info;
}

std::shared_ptr<const Bsdf> create(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  auto diffuse = inputs.texture("diffuse_reflectance");
  auto specular = inputs.texture("specular_reflectance");
  float scale = 1;
  if (diffuse->is_constant() && specular->is_constant()) {
    const float sum = (diffuse->mean() + specular->mean()).max_lane();
    if (sum > 1 + 1e-5f)
      throw Error(ErrorKind::input,
                  fmt::format("'diffuse_reflectance' and 'specular_reflectance' add up to {:.4g}, "
                              "more light than arrives",
                              sum),
                  "make their sum at most 1 in every channel",
                  arguments.place_of("diffuse_reflectance"));
  } else {
    scale = 1 / std::max(1.0f, diffuse->maximum() + specular->maximum());
  }
  return std::make_shared<Phong>(std::move(diffuse), std::move(specular),
                                 float(arguments.number("exponent")), scale);
}

}  // namespace

BsdfType phong_type() { return {info(), 0, 0, create}; }

}  // namespace kaustik
