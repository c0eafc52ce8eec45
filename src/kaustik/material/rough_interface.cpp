#include "kaustik/material/rough_interface.h"

#include <utility>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/material/facet_scattering.h"
#include "kaustik/material/shared_by_key.h"

namespace kaustik {
namespace {

/// Chance with which a facet that transmits this share is made to transmit: by how much of the
/// light goes each way, with its factors.
float transmission_chance(float transmittance, const InterfaceFactors& factors) {
  const float back = (1 - transmittance) * factors.reflectance.max_lane();
  const float through = transmittance * factors.transmittance.max_lane();
  return back + through > 0 ? through / (back + through) : 0.0f;
}
float reflection_chance(float reflectance, const InterfaceFactors& factors) {
  return 1 - transmission_chance(1 - reflectance, factors);
}

/// An estimate of the directional albedo, from a facet that is drawn: lane 0 has what it reflects,
/// lane 1 what it transmits.
Spectrum interface_shares(const MicrofacetDistribution& facets, float ratio, const Vec3f& wo,
                          const Vec2f& u) {
  const Vec3f m = sample_facet(facets, wo, u);
  const float cos_o = dot(wo, m), pdf = facets.pdf(wo, m);
  Spectrum shares;
  if (!(cos_o * wo.z > 0) || !(pdf > 0)) return shares;
  const DielectricFresnel fresnel = fresnel_dielectric(cos_o, ratio);
  const float seen = facets.density(m) * facets.masking(wo) * cos_o / (wo.z * pdf);
  const Vec3f back = reflected_by(m, wo), through = refracted_by(m, wo, fresnel);
  if (back.z * wo.z > 0) shares.set(0, fresnel.reflectance * seen * facets.masking(back));
  if (through.z * wo.z < 0)
    shares.set(1, (1 - fresnel.reflectance) * seen * facets.masking(through));
  return shares;
}

/// Of light that arrives from outside (or inside).
AlbedoTables tables_of_interface(const FacetRange& facets, float ratio, bool outside) {
  return {facets.least_log_alpha, facets.largest_log_alpha, facets.is_isotropic,
          [=](float log_alpha, const Vec3f& up, const Vec2f& u) {
            return interface_shares(facets.at(log_alpha), ratio, outside ? up : -up, u);
          }};
}

}  // namespace

RoughInterface::RoughInterface(RoughFacets facets, const SpectralValue& interior,
                               const SpectralValue& exterior)
    : facets_(std::move(facets)),
      interior_(interior),
      exterior_(exterior),
      is_dispersive_(!interior.is_constant() || !exterior.is_constant()),
      albedos_(InterfaceAlbedos::of(facets_.range(), interior.rgb()[0] / exterior.rgb()[0])) {}

RoughInterface::Ratios RoughInterface::ratios_at(const Wavelengths& wavelengths) const {
  return {interior_.at(wavelengths) / exterior_.at(wavelengths),
          !is_dispersive_ || wavelengths.is_rgb()};
}

BsdfValues RoughInterface::values(const BsdfContext& context, const InterfaceFactors& factors,
                                  const Vec3f& wo, const Vec3f& wi) const {
  if (wo.z * wi.z == 0) return {};
  return wo.z * wi.z > 0 ? reflected(context, factors, wo, wi)
                         : transmitted(context, factors, wo, wi);
}

BsdfValues RoughInterface::reflected(const BsdfContext& context, const InterfaceFactors& factors,
                                     const Vec3f& wo, const Vec3f& wi) const {
  const FacetReflection facet = facet_reflection(facets_.at(context), wo, wi);
  if (facet.cos_facet == 0) return {};
  const Ratios ratios = ratios_at(context.wavelengths());
  const int count = ratios.are_one ? 1 : context.wavelengths().alive_count();
  Spectrum fresnel;
  float chance = 0;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    if (!ratios.are_one && !context.wavelengths().is_alive(lane)) continue;
    const float reflectance = fresnel_dielectric(facet.cos_facet, ratios.lanes[lane]).reflectance;
    chance += reflection_chance(reflectance, factors) / float(count);
    if (ratios.are_one) {
      fresnel = Spectrum(reflectance);
      break;
    }
    fresnel.set(lane, reflectance);
  }
  BsdfValues result;
  result.glossy = factors.reflectance * fresnel * facet.value;
  result.pdf = chance * facet.pdf;
  result.pdf_reverse = chance * facet.pdf_reverse;
  return result;
}

BsdfValues RoughInterface::transmitted(const BsdfContext& context, const InterfaceFactors& factors,
                                       const Vec3f& wo, const Vec3f& wi) const {
  const MicrofacetDistribution facets = facets_.at(context);
  const Ratios ratios = ratios_at(context.wavelengths());
  const int count = ratios.are_one ? 1 : context.wavelengths().alive_count();
  BsdfValues result;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    if (!ratios.are_one && !context.wavelengths().is_alive(lane)) continue;
    const double ratio = ratios.lanes[lane], eta = wo.z > 0 ? ratio : 1 / ratio;
    const FacetRefraction facet = facet_refraction(facets, wo, wi, eta);
    float value = 0;
    if (facet.cos_facet != 0) {
      const float chance = transmission_chance(facet.transmittance, factors) / float(count);
      value = facet.transmittance * facet.value;
      if (context.mode == TransportMode::flux) value *= float(sqr(eta));
      result.pdf += chance * facet.pdf;
      result.pdf_reverse += chance * facet.pdf_reverse;
    }
    if (ratios.are_one) {
      result.glossy = Spectrum(value);
      break;
    }
    result.glossy.set(lane, value);
  }
  result.glossy *= factors.transmittance;
  return result;
}

BsdfSample RoughInterface::sample(const BsdfContext& context, const InterfaceFactors& factors,
                                  const Vec3f& wo, float u_lobe, const Vec2f& u) const {
  if (wo.z == 0) return {};
  const Vec3f m = sample_facet(facets_.at(context), wo, u);
  const float cos_o = dot(wo, m);
  if (!(cos_o * wo.z > 0)) return {};
  const Ratios ratios = ratios_at(context.wavelengths());
  const int count = ratios.are_one ? 1 : context.wavelengths().alive_count();
  // u_lobe runs over what the lanes reflect, and then over what each transmits.
  std::array<DielectricFresnel, Spectrum::lane_count> lanes;
  std::array<float, Spectrum::lane_count> through{};
  float back = 0;
  for (size_t lane = 0; lane < lanes.size(); ++lane) {
    if (!ratios.are_one && !context.wavelengths().is_alive(int(lane))) continue;
    lanes[lane] = fresnel_dielectric(cos_o, ratios.lanes[int(lane)]);
    const float chance = reflection_chance(lanes[lane].reflectance, factors);
    back += chance / float(count);
    through[lane] = (1 - chance) / float(count);
    if (ratios.are_one) break;
  }
  BsdfSample sample;
  if (u_lobe < back) {
    sample.wi = reflected_by(m, wo);
  } else {
    size_t chosen = 0;
    float left = u_lobe - back;
    for (size_t lane = 0; lane < lanes.size(); ++lane) {
      if (!(through[lane] > 0)) continue;
      chosen = lane;
      if (left < through[lane]) break;
      left -= through[lane];
    }
    if (!(through[chosen] > 0)) return {};
    sample.wi = refracted_by(m, wo, lanes[chosen]);
    sample.eta = lanes[chosen].eta;
    sample.transmission = true;
  }
  if (sample.transmission != (sample.wi.z * wo.z < 0)) return {};
  const BsdfValues values = this->values(context, factors, wo, sample.wi);
  if (!(values.pdf > 0)) return {};
  sample.weight = values.glossy * (std::fabs(sample.wi.z) / values.pdf);
  sample.pdf_solid_angle = values.pdf;
  sample.event = Lobes::glossy;
  return sample;
}

InterfaceAlbedo RoughInterface::albedo(const BsdfContext& context, const Vec3f& wo) const {
  return albedos_->at(facets_.log_alpha(context), wo);
}

InterfaceAlbedos::InterfaceAlbedos(const FacetRange& facets, float ratio)
    : facets_(facets),
      ratio_(ratio),
      from_outside_(tables_of_interface(facets, ratio, true)),
      from_inside_(tables_of_interface(facets, ratio, false)) {}

std::shared_ptr<const InterfaceAlbedos> InterfaceAlbedos::of(const FacetRange& facets,
                                                             float ratio) {
  static SharedByKey<std::pair<FacetRange, float>, InterfaceAlbedos> all;
  return all.get({facets, ratio},
                 [&] { return std::make_shared<const InterfaceAlbedos>(facets, ratio); });
}

InterfaceAlbedo InterfaceAlbedos::at(float log_alpha, const Vec3f& wo) const {
  const AlbedoTables& tables = wo.z > 0 ? from_outside_ : from_inside_;
  const Spectrum shares = tables(log_alpha, wo.z > 0 ? wo : -wo);
  return {shares[0], shares[1]};
}

const EvenLightShares& InterfaceAlbedos::of_even_light() const {
  std::call_once(once_, [this] { even_light_ = find_even_light(); });
  return even_light_;
}

EvenLightShares InterfaceAlbedos::find_even_light() const {
  // What enters by the same tables as light from one direction, so that white is white.
  constexpr int steps = 512;
  double enters = 0;
  for (int i = 0; i < steps; ++i) {
    const float cosine = (float(i) + 0.5f) / float(steps);
    const Vec3f wo(safe_sqrt(1 - cosine * cosine), 0, cosine);
    enters += double(cosine * at(facets_.largest_log_alpha, wo).transmitted);
  }
  constexpr uint32_t count = 8192;
  const MicrofacetDistribution facets = facets_.at(facets_.largest_log_alpha);
  Spectrum sum;
  for (uint32_t i = 0; i < count; ++i) {
    Sampler sampler = Sampler::of(Quadrature::albedo, i, 0);
    const Vec3f up = square_to_cosine_hemisphere(sampler.next_2d());
    if (up.z > 0) sum += interface_shares(facets, ratio_, -up, sampler.next_2d());
  }
  return {.enters = float(2 * enters / steps), .reflected_inside = sum[0] / float(count)};
}

}  // namespace kaustik
