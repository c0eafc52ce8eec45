#include "kaustik/material/rough_interface.h"

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/material/facet_scattering.h"

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

}  // namespace

RoughInterface::RoughInterface(RoughFacets facets, const SpectralValue& interior,
                               const SpectralValue& exterior)
    : facets_(std::move(facets)),
      interior_(interior),
      exterior_(exterior),
      is_dispersive_(!interior.is_constant() || !exterior.is_constant()),
      from_outside_(albedo_tables(true)),
      from_inside_(albedo_tables(false)) {}

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
  const AlbedoTables& tables = wo.z > 0 ? from_outside_ : from_inside_;
  const Spectrum shares = tables(facets_.log_alpha(context), wo.z > 0 ? wo : -wo);
  return {shares[0], shares[1]};
}

Spectrum RoughInterface::shares_of(const MicrofacetDistribution& facets, const Vec3f& wo,
                                   const Vec2f& u) const {
  const Vec3f m = sample_facet(facets, wo, u);
  const float cos_o = dot(wo, m), pdf = facets.pdf(wo, m);
  Spectrum shares;
  if (!(cos_o * wo.z > 0) || !(pdf > 0)) return shares;
  const DielectricFresnel fresnel =
      fresnel_dielectric(cos_o, interior_.rgb()[0] / exterior_.rgb()[0]);
  const float seen = facets.density(m) * facets.masking(wo) * cos_o / (wo.z * pdf);
  const Vec3f back = reflected_by(m, wo), through = refracted_by(m, wo, fresnel);
  if (back.z * wo.z > 0) shares.set(0, fresnel.reflectance * seen * facets.masking(back));
  if (through.z * wo.z < 0)
    shares.set(1, (1 - fresnel.reflectance) * seen * facets.masking(through));
  return shares;
}

AlbedoTables RoughInterface::albedo_tables(bool outside) const {
  return {facets_.least_log_alpha(), facets_.largest_log_alpha(), facets_.is_isotropic(),
          [this, outside](float log_alpha, const Vec3f& up, const Vec2f& u) {
            return shares_of(facets_.of_log_alpha(log_alpha), outside ? up : -up, u);
          }};
}

InterfaceAlbedo RoughInterface::of_even_light_inside() const {
  constexpr uint32_t count = 8192;
  const MicrofacetDistribution facets = facets_.of_log_alpha(facets_.largest_log_alpha());
  Spectrum sum;
  for (uint32_t i = 0; i < count; ++i) {
    Sampler sampler = Sampler::of(Quadrature::albedo, i, 0);
    const Vec3f up = square_to_cosine_hemisphere(sampler.next_2d());
    if (up.z > 0) sum += shares_of(facets, -up, sampler.next_2d());
  }
  return {sum[0] / float(count), sum[1] / float(count)};
}

}  // namespace kaustik
