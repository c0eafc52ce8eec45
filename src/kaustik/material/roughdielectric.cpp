#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/rough_interface.h"

namespace kaustik {
namespace {

/// The rough boundary of two transparent materials, such as ground glass.
class RoughDielectric final : public Bsdf {
 public:
  RoughDielectric(RoughFacets facets, const SpectralValue& interior, const SpectralValue& exterior,
                  std::shared_ptr<const Texture> reflectance,
                  std::shared_ptr<const Texture> transmittance)
      : Bsdf({.lobes = Lobes::glossy,
              .transmits = true,
              .needs = facets.needs() | texture_needs({reflectance.get(), transmittance.get()})}),
        boundary_(std::move(facets), interior, exterior),
        reflectance_(std::move(reflectance)),
        transmittance_(std::move(transmittance)) {}

  Spectrum eval(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
                Lobes lobes) const override {
    return any(lobes & Lobes::glossy) ? values(context, wo, wi).glossy : Spectrum();
  }
  float pdf(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi,
            Lobes lobes) const override {
    return any(lobes & Lobes::glossy) ? values(context, wo, wi).pdf : 0.0f;
  }
  BsdfValues values(const BsdfContext& context, const Vec3f& wo, const Vec3f& wi) const override {
    return boundary_.values(context, factors(context), wo, wi);
  }
  BsdfSample sample(const BsdfContext& context, const Vec3f& wo, float u_lobe, const Vec2f& u,
                    Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy)) return {};
    return boundary_.sample(context, factors(context), wo, u_lobe, u);
  }
  Spectrum albedo(const BsdfContext& context, const Vec3f& wo, Lobes lobes) const override {
    if (!any(lobes & Lobes::glossy) || wo.z == 0) return Spectrum();
    const InterfaceFactors factor = factors(context);
    const InterfaceAlbedo shares = boundary_.albedo(context, wo);
    return factor.reflectance * shares.reflected + factor.transmittance * shares.transmitted;
  }

 private:
  InterfaceFactors factors(const BsdfContext& context) const {
    return {context.value_of(*reflectance_), context.value_of(*transmittance_)};
  }

  RoughInterface boundary_;
  std::shared_ptr<const Texture> reflectance_, transmittance_;
};

TypeInfo make_roughdielectric_info() {
  TypeInfo info{"bsdf", "roughdielectric", "Rough transparent surface such as ground glass.",
                dielectric_ior_parameters()};
  info.parameters.push_back(abbe_number_parameter());
  for (Parameter& parameter : rough_facets_parameters())
    info.parameters.push_back(std::move(parameter));
  info.parameters.push_back(specular_reflectance_parameter());
  info.parameters.push_back(specular_transmittance_parameter());
  info.parameters.push_back(priority_parameter());
  return info;
}

const TypeInfo& roughdielectric_info() {
  static const TypeInfo info = make_roughdielectric_info();
  return info;
}

std::shared_ptr<const Bsdf> create_roughdielectric(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const SpectralValue interior = dielectric_ior_of(arguments, "int_ior"),
                      exterior = dielectric_ior_of(arguments, "ext_ior");
  if (interior.rgb()[0] == exterior.rgb()[0])
    throw Error(ErrorKind::input, "a rough boundary has the same index of refraction on both sides",
                "give 'int_ior' and 'ext_ior' two values, or use type 'null' where light goes on "
                "as if nothing were there",
                arguments.place_of("int_ior"));
  return std::make_shared<RoughDielectric>(rough_facets_of(inputs), interior, exterior,
                                           inputs.texture("specular_reflectance"),
                                           inputs.texture("specular_transmittance"));
}

}  // namespace

BsdfType roughdielectric_type() { return {roughdielectric_info(), 0, 0, create_roughdielectric}; }

}  // namespace kaustik
